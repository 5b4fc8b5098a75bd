#include "app/described/describe_json.h"
#include "app/queries/async_query.h"
#include "app/queries/geometry_query.h"
#include "app/queries/readout.h"
#include "app/queries/statistics_query.h"
#include "app/queries/visibility_query.h"
#include "app/views/compare/compare_pictures.h"
#include "app/views/tesseract/tesseract_query.h"
#include "app/workbench/pane_host.h"
#include "codec/pack/pack.h"
#include "tests/app/views_fixture.h"
#include "volume/reconstruct/probe.h"
#include "volume/sources/memory_source.h"
#include "volume/sources/plane_source.h"

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <thread>
#include <unistd.h>

namespace tessera::app {
namespace {

/// Queries of views in frames without pictures.
struct AsyncQueries : ViewsTest {
    AsyncQueries() {
        show(fuelCell(volume::LatticeKind::CC));
        headless = false;
    }
    ViewContext context() {
        return {.session = session, .source = source, .renderer = renderer, .jobs = jobs, .caches = caches};
    }
    /// Frames in which `get` asks and every job whose key has this in it is cancelled, until it asks no more; returns
    /// how many there were.
    template <class Get> int cancelAll(Get&& get, const std::string& key = "") {
        int started = 0, asked = 1;
        for (int turn = 0; turn < 20 && asked > 0; ++turn) {
            ViewContext now = context();
            get(now);
            busy = now.answers.unfinished();
            asked = 0;
            for (const Jobs::Status& job : jobs.list()) {
                if (job.key.find(key) == std::string::npos) continue;
                jobs.cancel(job.key);
                ++asked;
            }
            started += asked;
            jobs.wait();
            for (const std::string& text : jobs.collect()) messages.push_back(text);
        }
        return started;
    }
    /// As many frames as it takes; a driver that is compiling may need long beside other work.
    template <class Get> void finish(Get&& get) {
        busy = true;
        const auto begin = std::chrono::steady_clock::now();
        while (busy && std::chrono::steady_clock::now() - begin < std::chrono::minutes(1)) {
            ViewContext now = context();
            get(now);
            busy = now.answers.unfinished();
            jobs.wait();
            for (const std::string& text : jobs.collect()) messages.push_back(text);
        }
        EXPECT_FALSE(busy);
    }
};

// Pictures on one lattice, numbers from another: what is counted and read is of the latter.
TEST_F(AsyncQueries, ReadTheSamplesThatNumbersComeFrom) {
    const auto numbers = source;
    show(fuelCell(volume::LatticeKind::BCC));
    const auto both = [&] {
        ViewContext now = context();
        now.numbers = numbers;
        now.headless = true;
        return now;
    };
    ASSERT_NE(source->grid().lattice.count(), numbers->grid().lattice.count());
    ViewContext now = both();
    EXPECT_EQ(context().numbers, source) << "where nothing else is said";
    const int t = numbers->info().findChannel("T").value();
    AsyncStatistics statistics;
    const auto counted =
        statistics.get(now, "statistics", brushedQuery(session, numbers->info(), {t}, {{0, 1000}}, 8, false));
    ASSERT_TRUE(counted);
    EXPECT_EQ(counted->statistics.channels[0].all.samples, double(numbers->grid().lattice.count()));
    AsyncQuery<int, std::size_t> latest;
    const auto samples = latest.get(
        now, numbers, {.key = "latest", .title = "Samples"}, 1,
        [](const auto& of, int, int, const Progress&) { return of->grid().lattice.count(); }, std::equal_to<>());
    ASSERT_TRUE(samples);
    EXPECT_EQ(*samples, numbers->grid().lattice.count());
    Readout readout;
    session.cursor = numbers->info().bounds.lo + numbers->info().bounds.size() * glm::dvec3(0.37, 0.61, 0.43);
    updateReadout(now, readout);
    const auto time = volume::timesAround(numbers->info().times, session.time);
    EXPECT_EQ(readout.value("T"), volume::probe(*numbers, session.cursor, time)[std::size_t(t)].interpolated);
    EXPECT_NE(readout.value("T"), volume::probe(*source, session.cursor, time)[std::size_t(t)].interpolated);
}

/// The views that show values at the cross-hair ask for them in one job, whose answer is that of all.
TEST_F(AsyncQueries, ViewsShareWhatIsReadAtTheCrossHair) {
    const std::size_t t = std::size_t(source->info().findChannel("T").value());
    const volume::TimePair time = volume::timesAround(source->info().times, session.time);
    for (const double share : {0.3, 0.6}) {
        session.cursor = source->info().bounds.lo + source->info().bounds.size() * share;
        std::size_t asked = 0;
        bool behind = true;
        for (int turn = 0; turn < 20 && behind; ++turn) {
            frame([&] {
                busy = behind = false;
                ImGui::Begin("views");
                for (const char* pane : {"slices", "other"}) {
                    ViewContext now = context();
                    SlicesView view = slicesView;
                    drawSlicesView(now, pane, view);
                    behind = behind || !sharedReadout(now).value("T");
                }
                ViewContext now = context();
                drawTransferView(now, "transfer", transferView);
                ImGui::End();
                for (const Jobs::Status& job : jobs.list()) asked += job.title == "Values at the cross-hair" ? 1 : 0;
            });
            jobs.wait();
            jobs.collect();
        }
        EXPECT_EQ(asked, 1u);
        ViewContext now = context();
        EXPECT_EQ(sharedReadout(now).value("T"), volume::probe(*source, session.cursor, time)[t].interpolated);
    }
}

/// What views wait for is no reason to draw the next frame at once.
TEST_F(AsyncQueries, AViewThatWaitsDoesNotHurry) {
    PaneHost host;
    session.views = {{"statistics", StatisticsView{}}};
    session.dock = {};
    session.dock.root.id = 1;
    session.dock.root.tabs = {"statistics"};
    bool waited = false;
    for (int turn = 0; turn < 100 && (turn < 3 || host.busy()); ++turn) {
        frame([&] { host.draw(context(), {{0, 0}, {600, 400}, {}, {}}); });
        EXPECT_FALSE(host.hurries());
        waited = waited || host.busy();
        jobs.wait();
    }
    EXPECT_TRUE(waited);
    EXPECT_FALSE(host.busy());
}

/// Caches of closed panes are dropped, but not what views share.
TEST_F(AsyncQueries, WhatViewsShareOutlivesPanes) {
    struct Some : ViewCache {
        explicit Some(bool ofAll) : all(ofAll) {}
        bool shared() const override { return all; }
        bool all;
    };
    PaneHost host;
    host.caches()["of all"] = std::make_unique<Some>(true);
    host.caches()["of a closed pane"] = std::make_unique<Some>(false);
    session.views.clear();
    session.dock = {};
    frame([&] { host.draw(context(), {{0, 0}, {600, 400}, {}, {}}); });
    EXPECT_TRUE(host.cache("of all"));
    EXPECT_FALSE(host.cache("of a closed pane"));
    host.forget();
    EXPECT_FALSE(host.cache("of all"));
}

// An answer that takes longer than a frame comes although the last one is of no use meanwhile.
TEST_F(AsyncQueries, AnAnswerOnItsWayIsNotAskedForAgain) {
    AsyncQuery<int, int> answers;
    std::atomic<int> asked = 0;
    const auto get = [&](int query) {
        ViewContext now = context();
        return answers.get(
            now, source, {.key = "slow", .title = "Slow"}, query,
            [&](const auto&, int of, int, const Progress& progress) {
                ++asked;
                for (int i = 0; i < 30; ++i) {
                    std::this_thread::sleep_for(std::chrono::milliseconds(2));
                    progress.advance(i / 30.0);
                }
                return of;
            },
            std::equal_to<>());
    };
    for (const int query : {1, 2}) {
        std::shared_ptr<const int> answer;
        for (int i = 0; i < 20000 && !answer; ++i) {
            answer = get(query);
            jobs.collect();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        ASSERT_TRUE(answer) << query;
        EXPECT_EQ(*answer, query);
        EXPECT_EQ(asked, query);
    }
}

// Places that ask the same share answers, also former ones; what stands in meanwhile is of the own place.
TEST_F(AsyncQueries, PlacesShareAnswersThatAreKept) {
    AsyncQuery<int, int> answers({.answers = 3});
    std::atomic<int> computed = 0;
    const auto get = [&](const char* place, int query) {
        ViewContext now = context();
        const auto answer = answers.answer(
            now, source, {.key = place, .title = "Twice"}, query,
            [&](const auto&, int of, int, const Progress&) { return ++computed, 2 * of; },
            [](int, int) { return true; });
        jobs.wait();
        jobs.collect();
        return answer ? answer->result : -1;
    };
    EXPECT_EQ(get("a", 1), -1);
    EXPECT_EQ(get("a", 1), 2);
    EXPECT_EQ(get("b", 3), -1) << "not that of another place";
    EXPECT_EQ(get("b", 3), 6);
    EXPECT_EQ(get("b", 1), 2);
    EXPECT_EQ(get("a", 3), 6);
    EXPECT_EQ(computed, 2);
    for (const int query : {4, 5}) get("a", query);
    EXPECT_EQ(get("b", 1), 2) << "what a place shows is not forgotten";
    EXPECT_EQ(computed, 4);
    EXPECT_EQ(get("a", 1), 6) << "dropped as the oldest: what the place showed last stands in";
    EXPECT_EQ(get("a", 1), 2);
    EXPECT_EQ(computed, 5);
}

// Coarse first, then finer until exact; a query that follows begins anew with the coarsest.
TEST_F(AsyncQueries, LevelsComeFromCoarseToExact) {
    AsyncQuery<int, int> answers;
    std::vector<std::array<int, 2>> computed; // query, level
    int query = 7;
    bool dragging = false;
    const auto get = [&](ViewContext& now) {
        now.interacting = dragging;
        const auto answer = answers.answer(
            now, source,
            {.key = "levels",
             .title = "Levels",
             .duringEdits = true,
             .firstLevel = 4,
             .nextLevel = [](int level) { return level / 2; }},
            query,
            [&](const auto&, int of, int level, const Progress&) {
                computed.push_back({of, level});
                return of;
            },
            [](int, int) { return true; });
        return answer;
    };
    finish(get);
    EXPECT_EQ(computed, (std::vector<std::array<int, 2>>{{7, 4}, {7, 2}, {7, 1}, {7, 0}}));
    computed.clear();
    dragging = true;
    query = 8;
    for (int i = 0; i < 4; ++i) {
        ViewContext now = context();
        EXPECT_EQ(get(now)->query, i == 0 ? 7 : 8);
        EXPECT_EQ(now.answers.behind, i == 0);
        jobs.wait();
        jobs.collect();
    }
    EXPECT_EQ(computed, (std::vector<std::array<int, 2>>{{8, 4}})) << "finer ones when the drag has ended";
    ViewContext whole = context();
    whole.headless = true;
    EXPECT_EQ(get(whole)->level, 0);
    EXPECT_EQ(computed.back(), (std::array<int, 2>{8, 0}));
}

// While the samples of another time are read those of the former time stand in; their histogram must not be taken for
// that of the new time.
TEST_F(AsyncQueries, VisibilityIsOfTheTimeThatIsShown) {
    const int t = source->info().findChannel("T").value();
    const Range range = source->info().channelRange(source->info().channel(t));
    session.layers = {{"t", true, vis::VolumeLayer{.channel = "T"}}};
    AsyncVisibility answers, fresh;
    const auto get = [&](ViewContext& now) { return answers.get(now, "visibility", t, range, 16); };
    session.time = source->info().times.front();
    finish(get);
    session.time = source->info().times.back();
    finish(get);
    ViewContext now = context();
    const auto shown = get(now);
    now.headless = true;
    const auto wanted = fresh.get(now, "fresh", t, range, 16);
    ASSERT_TRUE(shown && wanted);
    EXPECT_EQ(*shown, *wanted);
}

// What the user cancels is not started again in the next frame, but when something else is wanted.
TEST_F(AsyncQueries, CancelledStatisticsWaitForAnotherQuery) {
    AsyncStatistics answers;
    int bins = 32;
    const auto get = [&](ViewContext& now) {
        return answers.get(now, "feed", brushedQuery(session, source->info(), {0}, {{0, 1000}}, bins, false));
    };
    EXPECT_EQ(cancelAll(get), 1);
    EXPECT_FALSE(busy);
    EXPECT_EQ(answers.failure(), "cancelled");
    EXPECT_TRUE(messages.empty());
    bins = 16;
    finish(get);
    EXPECT_EQ(answers.failure(), "");
    bins = 32;
    finish(get);
    ViewContext now = context();
    EXPECT_EQ(get(now)->statistics.level, 0) << "wanted again, it is tried again";
}

TEST_F(AsyncQueries, CancelledLatestAnswerWaitsForAnotherQuery) {
    AsyncQuery<int, int> answers;
    int query = 1;
    bool memory = true;
    const auto get = [&](ViewContext& now) {
        return answers.get(
            now, source, {.key = "feed", .title = "Twice"}, query,
            [memory](const auto&, int of, int, const Progress& progress) {
                progress.advance(0);
                if (!memory) throw std::bad_alloc();
                return 2 * of;
            },
            [](int, int) { return true; });
    };
    EXPECT_EQ(cancelAll(get), 1);
    EXPECT_FALSE(busy);
    EXPECT_EQ(answers.failure(), "cancelled");
    query = 2;
    finish(get);
    ViewContext now = context();
    EXPECT_EQ(*get(now), 4);
    EXPECT_EQ(answers.failure(), "");

    memory = false;
    query = 3;
    finish(get);
    EXPECT_EQ(answers.failure(), "not enough memory");
    EXPECT_THAT(messages, testing::ElementsAre("not enough memory"));
    EXPECT_EQ(*get(now), 4) << "what was there stays";
}

TEST_F(AsyncQueries, TheNewestAnswerOfTheSamePlotsIsShownMeanwhile) {
    AsyncStatistics answers;
    const int t = source->info().findChannel("T").value();
    const auto query = [&](double most, int bins) {
        return brushedQuery(session, source->info(), {t}, {{0, most}}, bins, false);
    };
    ViewContext now = context();
    now.headless = true;
    const auto other = answers.get(now, "statistics", query(500, 16));
    const auto older = answers.get(now, "statistics", query(500, 8)),
               newer = answers.get(now, "statistics", query(600, 8));
    ASSERT_NE(older, newer);
    now.headless = false;
    EXPECT_EQ(answers.get(now, "statistics", query(700, 8)), newer);
    EXPECT_EQ(answers.get(now, "statistics", query(700, 16)), other);
    EXPECT_EQ(answers.get(now, "statistics", query(700, 32)), nullptr);
    jobs.wait();
    jobs.collect();
}

TEST_F(AsyncQueries, ASurfaceInTwoPartsTellsItsProgressInOne) {
    for (const char* colorBy : {"", "H2"}) {
        const Range range =
            source->info().channelRange(source->info().channel(source->info().findChannel("T").value()));
        const vis::IsoLayer layer{.channel = "T", .value = 0.5 * (range.lo + range.hi), .colorBy = colorBy};
        std::vector<double> told;
        Progress progress;
        progress.report = [&](double fraction, const std::string&) { told.push_back(fraction); };
        ASSERT_TRUE(extractLayer(source, layer, volume::timesAround(source->info().times, session.time), 0, progress));
        ASSERT_FALSE(told.empty());
        EXPECT_TRUE(std::is_sorted(told.begin(), told.end())) << colorBy;
        EXPECT_LE(told.back(), 1);
    }
}

TEST_F(AsyncQueries, CancelledSurfaceWaitsForAnotherQuery) {
    AsyncGeometry answers;
    vis::IsoLayer layer{.channel = "T"};
    const Range range = source->info().channelRange(source->info().channel(*source->info().findChannel("T")));
    layer.value = 0.5 * (range.lo + range.hi);
    layer.method = vis::SurfaceMethod::Polygons;
    session.layers = {{"surface", true, layer}};
    const auto get = [&](ViewContext& now) { return answers.get(now, "pane", false); };
    EXPECT_EQ(cancelAll(get), 1);
    EXPECT_FALSE(busy);
    std::get<vis::IsoLayer>(session.layers[0].technique).value = 0.4 * range.lo + 0.6 * range.hi;
    finish(get);
    ViewContext now = context();
    EXPECT_EQ(get(now).size(), 1u);
}

/// A ball in four dimensions of radius 0.8, f = 0, as a cube of 32 samples at 32 times, with a vector U.
std::shared_ptr<const volume::BrickSource> hypersphere() {
    volume::Dataset data;
    data.info.name = "hypersphere";
    data.info.lattice.size = glm::ivec3(32);
    data.info.lattice.spacing = glm::dvec3(2.0 / 31);
    data.info.lattice.origin = glm::dvec3(-1);
    data.info.bounds = {glm::dvec3(-1), glm::dvec3(1)};
    data.info.times.clear();
    for (int i = 0; i < 32; ++i) data.info.times.push_back(-1 + i * (2.0 / 31));
    data.info.parameters.resize(2);
    data.info.parameters[0].name = "f";
    data.info.parameters[0].ranges = {{-1.2, 0.8}};
    data.info.parameters[1].name = "U";
    data.info.parameters[1].components = 3;
    data.info.parameters[1].ranges = {{0, 1}, {0, 0}, {0, 0}, {0, 1}};
    data.read = [info = data.info](int parameter, int component, int time) {
        volume::Field field = volume::makeField(info.lattice, volume::ScalarType::F32);
        const double t = info.times[std::size_t(time)];
        std::size_t index = 0;
        for (int k = 0; k < 32; ++k)
            for (int j = 0; j < 32; ++j)
                for (int i = 0; i < 32; ++i) {
                    const glm::dvec3 p = info.lattice.position({i, j, k});
                    const double value = parameter == 0 ? 0.8 - std::sqrt(glm::dot(p, p) + t * t) : component == 0;
                    field.as<float>()[index++] = float(value);
                }
        return field;
    };
    return volume::makeMemorySource(std::move(data), {});
}

double volumeWithin(const volume::SurfaceMesh& mesh) {
    double volume = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        const auto at = [&](int i) { return mesh.origin + glm::dvec3(mesh.positions[t[i]]); };
        volume += glm::dot(at(0), glm::cross(at(1), at(2))) / 6;
    }
    return volume;
}

struct SpaceTimeLayers : AsyncQueries {
    AsyncGeometry answers;
    vis::IsoLayer layer{.channel = "f", .value = 0, .method = vis::SurfaceMethod::SpaceTime};
    double timeShift = 0;
    /// The geometry of the layer, made to the end.
    std::vector<vis::GeometryLayer> drawn(std::shared_ptr<const volume::BrickSource> space = {}) {
        session.layers = {{"surface", true, layer}};
        session.layers[0].timeShift = timeShift;
        ViewContext now = context();
        now.headless = true;
        now.origin.spaceOfPlane = std::move(space);
        return answers.get(now, "pane", false);
    }
};

TEST_F(SpaceTimeLayers, AreCutsOfTheSurfaceInSpaceAndTime) {
    show(hypersphere());
    for (const double time : {-0.5, -0.21, 0.013, 0.35, 0.6}) {
        session.time = time;
        const auto surfaces = drawn();
        ASSERT_EQ(surfaces.size(), 1u);
        const double radius = std::sqrt(0.64 - time * time), ball = 4 * M_PI / 3 * std::pow(radius, 3);
        EXPECT_NEAR(volumeWithin(surfaces[0].geometry->mesh), ball, 0.02 * ball) << time;
        EXPECT_TRUE(surfaces[0].geometry->notes.empty());
        const auto written = extractLayer(source, layer, volume::timesAround(source->info().times, time), 0, {});
        EXPECT_EQ(written->mesh, surfaces[0].geometry->mesh) << "what is exported";
    }
    layer.colorBy = "f";
    const auto coloured = drawn();
    ASSERT_EQ(coloured.size(), 1u);
    EXPECT_EQ(coloured[0].channel, "f");
    ASSERT_EQ(coloured[0].geometry->mesh.scalars.size(), coloured[0].geometry->mesh.positions.size());
    for (const float value : coloured[0].geometry->mesh.scalars) EXPECT_NEAR(value, 0, 0.02);
}

// A plane in space and time is cut from the surface of the data, whose samples the plane's are not.
TEST_F(SpaceTimeLayers, InAPlaneAreCutsOfTheDataThatItIsOf) {
    const auto space = hypersphere();
    for (const double degrees : {30.0, 90.0}) {
        show(volume::makePlaneSource(space, {.degrees = degrees}));
        const volume::SpaceTimePlane plane = source->info().plane.value();
        const auto surfaces = drawn(space);
        ASSERT_EQ(surfaces.size(), 1u);
        const volume::SurfaceMesh& mesh = surfaces[0].geometry->mesh;
        ASSERT_GT(mesh.positions.size(), 1000u);
        for (const glm::vec3& position : mesh.positions) {
            const glm::dvec4 point = plane.pointAt(mesh.origin + glm::dvec3(position));
            EXPECT_NEAR(glm::length(point), 0.8, 0.01);
        }
        // Through the middle: a ball in its three dimensions, x and y as they are.
        double most = 0;
        for (const glm::vec3& position : mesh.positions) most = std::max(most, double(position.x));
        EXPECT_NEAR(most, 0.8, 0.01);
        const auto time = volume::timesAround(source->info().times, session.time);
        const auto written = extractLayer(source, layer, time, 0, {}, space);
        EXPECT_EQ(written->mesh.triangles, mesh.triangles) << "what is exported";
        for (const glm::vec3& position : written->mesh.positions)
            EXPECT_NEAR(glm::length(plane.pointAt(written->mesh.origin + glm::dvec3(position))), 0.8, 0.01);
        layer.method = vis::SurfaceMethod::Polygons;
        EXPECT_NE(drawn(space).at(0).geometry->mesh, mesh);
        layer.method = vis::SurfaceMethod::SpaceTime;
        EXPECT_FALSE(drawn().empty()) << "without the data: of the samples of the plane";
    }
}

// A layer with a time offset is of the time that its legend states, however it is made.
TEST_F(SpaceTimeLayers, AreOfTheTimeOfTheirLayer) {
    show(hypersphere());
    for (const vis::SurfaceMethod method : {vis::SurfaceMethod::Polygons, vis::SurfaceMethod::SpaceTime}) {
        layer.method = method;
        session.time = 0.35;
        timeShift = 0;
        const volume::SurfaceMesh later = drawn().at(0).geometry->mesh;
        session.time = 0.1;
        EXPECT_NE(drawn().at(0).geometry->mesh, later);
        timeShift = 0.25;
        EXPECT_NEAR(volumeWithin(drawn().at(0).geometry->mesh), volumeWithin(later), 1e-3);
    }
}

// Where strokes have no meaning a surface keeps its colours.
TEST_F(SpaceTimeLayers, AlongATimeAxisSurfacesHaveNeitherStrokesNorGrey) {
    const auto space = hypersphere();
    layer.strokes = {.vector = "U", .width = 0.03f, .grey = true};
    layer.colorBy = "f";
    show(volume::makePlaneSource(space, {.degrees = 90}));
    const auto surfaces = drawn(space);
    ASSERT_EQ(surfaces.size(), 1u);
    EXPECT_TRUE(surfaces[0].geometry->strokes.empty());
    EXPECT_EQ(surfaces[0].channel, "f");
    EXPECT_EQ(surfaces[0].style.color, layer.color);
}

TEST_F(SpaceTimeLayers, SurfacesWithStrokesAreMeshes) {
    show(hypersphere());
    session.time = 0.013;
    layer.method = vis::SurfaceMethod::Rays;
    EXPECT_TRUE(drawn().empty());
    layer.strokes = {.vector = "U", .width = 0.03f, .strength = 0.4f};
    const auto surfaces = drawn();
    ASSERT_EQ(surfaces.size(), 1u);
    const vis::Geometry& geometry = *surfaces[0].geometry;
    EXPECT_EQ(geometry.strokes.size(), geometry.mesh.positions.size());
    EXPECT_EQ(surfaces[0].style.strokes, 0.4f);
    layer.strokes.strength = 0.9f;
    EXPECT_EQ(drawn()[0].geometry, surfaces[0].geometry) << "drawn otherwise, not made again";
    layer.method = vis::SurfaceMethod::SpaceTime;
    EXPECT_FALSE(drawn()[0].geometry->strokes.empty());
}

// Streamlines of a plane that is tilted less than 45 degrees mix times: the picture says so.
TEST_F(SpaceTimeLayers, FlowOfATiltedPlaneSaysThatItsVectorsAreOfSeveralTimes) {
    const auto notesAt = [&](double degrees) {
        show(volume::makePlaneSource(hypersphere(), {.degrees = degrees}));
        session.layers = {{"flow", true, vis::FlowLayer{.vector = "U", .channel = "f"}}};
        ViewContext now = context();
        now.headless = true;
        const auto flow = answers.get(now, "pane", false);
        return flow.empty() ? std::vector<std::string>{"none"} : flow[0].geometry->notes;
    };
    ASSERT_EQ(notesAt(30).size(), 1u);
    EXPECT_EQ(notesAt(30)[0], "flow of U: vectors of several times, since t differs over the plane");
    EXPECT_TRUE(notesAt(0).empty());
}

// Vectors are lengths per time: along an axis that is time they have no direction.
TEST_F(AsyncQueries, FlowIsNotDrawnWhereAnAxisIsTime) {
    AsyncGeometry answers;
    session.layers = {{"flow", true, vis::FlowLayer{.vector = "U", .channel = "T"}}};
    const auto get = [&](ViewContext& now) { return answers.get(now, "pane", false); };
    const auto drawn = [&] {
        finish(get);
        ViewContext now = context();
        return get(now).size();
    };
    const auto space = source;
    EXPECT_EQ(drawn(), 1u);
    show(volume::makePlaneSource(space, {.degrees = 0}));
    session.layers = {{"flow", true, vis::FlowLayer{.vector = "U", .channel = "T"}}};
    EXPECT_EQ(drawn(), 1u) << "all of space at one time";
    show(volume::makePlaneSource(space, {volume::SpaceAxis::Z, 0.5}));
    session.layers = {{"flow", true, vis::FlowLayer{.vector = "U", .channel = "T"}}};
    EXPECT_EQ(drawn(), 0u);
}

TEST_F(AsyncQueries, CancelledSamplesOfTheTesseractWaitForAnotherQuery) {
    AsyncSamples answers;
    volume::SamplesQuery query;
    query.channels = {0};
    query.times = {0, 1};
    const auto get = [&](ViewContext& now) { return answers.get(now, "tesseract", {query, {}}); };
    EXPECT_EQ(cancelAll(get), 1);
    EXPECT_FALSE(busy);
    EXPECT_EQ(answers.failure(), "cancelled");
    query.channels = {1};
    finish(get);
    ViewContext now = context();
    EXPECT_TRUE(get(now));
}

TEST_F(AsyncQueries, CancelledDataToCompareAreNotOpenedAgain) {
    ComparePictures answers;
    std::vector<CompareVariant> variants{{"unchanged", {}}, {"other", {{"/data/model", "\"marschner-lobb\""}}}};
    session.data.model = "fuel-cell";
    const auto get = [&](ViewContext& now) {
        answers.prepare(now, variants);
        answers.draw(now, "pane", 0, {32, 24}, false);
    };
    EXPECT_EQ(cancelAll(get, ":data"), 1);
    finish(get);
    ASSERT_EQ(answers.cells().size(), 2u);
    EXPECT_EQ(answers.cells()[1]->failure, "cancelled");
    EXPECT_EQ(answers.cells()[0]->failure, "");
    session.camera.distance *= 1.1f; // another picture of the same data
    EXPECT_EQ(cancelAll(get, ":data"), 0);
    variants[1].changes = {{"/data/model", "\"marschner-lobb\""},
                           {"/data/settings", "{\"nx\": 8, \"ny\": 8, \"nz\": 8}"}};
    finish(get);
    EXPECT_EQ(answers.cells()[1]->failure, "");
    EXPECT_TRUE(answers.cells()[1]->finished());
}

// Renderers of other data share the limits with the window's, and what they have to say reaches the log.
TEST_F(AsyncQueries, RenderersOfVariantsShareTheLimitsAndSpeak) {
    const std::string path = testing::TempDir() + "variant_" + std::to_string(::getpid()) + ".tsr";
    volume::Dataset made = volume::makeModel("marschner-lobb", {{"nx", 40}, {"ny", 40}, {"nz", 40}});
    codec::pack(made, {}, path);
    const auto bytes = std::filesystem::file_size(path);
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    for (std::uintmax_t at = bytes / 4; at < bytes / 2; at += 7) { // within the bricks
        file.seekp(std::streamoff(at));
        file.put('\x5a');
    }
    file.close();
    ComparePictures answers;
    session.data.model = "fuel-cell";
    const Json files = Json::array({{{"path", path}, {"absolutePath", path}}});
    const std::vector<CompareVariant> variants{
        {"unchanged", {}}, {"damaged", {{"/data/files", files.dump()}, {"/layers/0/technique/channel", "rho"}}}};
    std::vector<std::string> said;
    const auto get = [&](ViewContext& now) {
        now.renderers = 1 + answers.renderers();
        answers.prepare(now, variants);
        answers.draw(now, "pane", 0, {32, 24}, false);
        said.insert(said.end(), now.answers.messages.begin(), now.answers.messages.end());
    };
    finish(get);
    std::filesystem::remove(path);
    ASSERT_EQ(answers.cells()[1]->failure, "");
    EXPECT_EQ(answers.renderers(), 1);
    const auto half = std::size_t(session.render.limits.textureMemory) / 2 << 20;
    EXPECT_EQ(renderer.residency().textureBudget, half);
    EXPECT_EQ(answers.cells()[1]->data->renderer->residency().textureBudget, half);
    EXPECT_EQ(answers.cells()[1]->data->renderer->residency().memoryBudget,
              std::size_t(session.render.limits.brickMemory) / 2 << 20);
    EXPECT_THAT(said, testing::Contains(testing::StartsWith("damaged: ")));
}

} // namespace
} // namespace tessera::app
