#include "app/data/open.h"
#include "app/queries/statistics_query.h"
#include "app/tools/profile_line.h"
#include "app/views/curves/profile_data.h"
#include "app/views/shadow_cube/wall_projection.h"
#include "app/views/tesseract/tesseract_turn.h"
#include "codec/pack/pack.h"
#include "vis/shapes/projection4.h"
#include "volume/base/error.h"
#include "volume/bricks/sample_position.h"
#include "volume/reconstruct/probe.h"
#include "volume/sources/time_axis.h"
#include "volume/synthetic/models.h"
#include "volume/synthetic/planted.h"

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <unistd.h>

/// Tasks done by hand in the window on the planted fuel cell and saved with their history (tests/sessions): every step
/// replays, and what the researcher found is what was planted.
namespace tessera::app {
namespace {

namespace planted = volume::planted;

struct Recorded {
    SessionDocument document;
    std::shared_ptr<const volume::BrickSource> source;
    std::vector<Session> steps; ///< as opened, then after each edit
    const Session& last() const { return steps.back(); }
    const volume::DatasetInfo& info() const { return source->info(); }
    int channel(const std::string& name) const { return info().findChannel(name).value(); }
    Range range(const std::string& name) const { return info().channelRange(info().channel(channel(name))); }
};

std::string pathOf(const std::string& name) {
    return TESSERA_SOURCE_DIR "/tests/sessions/" + name + ".tessera.json";
}

Recorded recorded(const std::string& name) {
    Recorded out;
    out.document = loadSession(pathOf(name));
    EXPECT_TRUE(out.document.messages.empty()) << out.document.messages.front();
    EXPECT_TRUE(out.document.unknown.empty());
    static std::map<std::string, std::shared_ptr<const volume::BrickSource>> sources; // of equal data
    auto& source = sources[toJson(out.document.session.data).dump()];
    std::vector<std::string> messages;
    DataRef data = out.document.session.data;
    std::string archive;
    if (!source && !data.files.empty()) { // made on another machine, of a small cell
        archive = (std::filesystem::temp_directory_path() / ("tessera-cell-" + std::to_string(getpid()) + ".tsr"));
        volume::Dataset cell = volume::makeModel("planted", {{"nx", 9}, {"ny", 9}, {"nz", 21}, {"times", 2}});
        codec::pack(cell, {}, archive);
        data.files[0].absolutePath = archive;
    }
    if (!source) source = openSource(data, messages);
    if (!archive.empty()) std::filesystem::remove(archive);
    EXPECT_TRUE(messages.empty());
    out.source = source;
    History history = out.document.history;
    for (std::size_t i = 0; i <= history.steps().size(); ++i) out.steps.push_back(history.seek(i));
    return out;
}

/// Every present sample of some channels at a time, with its position; NaN where absent.
template <class Visit>
void forEach(const volume::BrickSource& source, const std::vector<int>& channels, int time, const Visit& visit) {
    const glm::ivec3 count = source.grid().count();
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) {
                std::vector<volume::BrickSamples> read;
                for (const int channel : channels) read.push_back(source.read({channel, time, 0, {x, y, z}}));
                volume::SamplePositions position(source.grid(), {x, y, z}, 0);
                std::vector<double> values(channels.size());
                for (std::size_t i = 0; i < read[0].values.size(); ++i, position.next()) {
                    for (std::size_t c = 0; c < channels.size(); ++c) {
                        const bool present = read[c].present.empty() || read[c].present[i] != 0;
                        values[c] = present ? double(read[c].values[i]) : std::nan("");
                    }
                    visit(position.at(), values);
                }
            }
}

volume::Summary selected(const Recorded& of, const Session& session, const std::string& parameter) {
    BrushedQuery query = brushedQuery(session, of.info(), {of.channel(parameter)}, {of.range(parameter)}, 8, false);
    return readStatistics(of.source, query, 0).channels.front().inside;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
    double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (std::isnan(a[i]) || std::isnan(b[i])) continue;
        ++n, sa += a[i], sb += b[i], saa += a[i] * a[i], sbb += b[i] * b[i], sab += a[i] * b[i];
    }
    return (n * sab - sa * sb) / std::sqrt((n * saa - sa * sa) * (n * sbb - sb * sb));
}

TEST(Scenarios, EveryRecordedTaskReplaysAndUndoes) {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(TESSERA_SOURCE_DIR "/tests/sessions")) {
        std::string name = entry.path().filename().string();
        name = name.substr(0, name.find('.'));
        SCOPED_TRACE(name);
        Recorded task = recorded(name);
        ++files;
        EXPECT_GE(task.steps.size(), 3u);
        EXPECT_EQ(task.steps[task.document.history.position()], task.document.session);
        for (Session step : task.steps) {
            const Session before = step;
            std::vector<std::string> messages;
            fitSession(step, task.info(), messages);
            EXPECT_TRUE(messages.empty()) << messages.front();
            EXPECT_EQ(step, before);
        }
        History history = task.document.history;
        history.seek(history.steps().size());
        while (history.canUndo()) history.undo();
        EXPECT_EQ(history.seek(0), task.steps.front());
        Session end;
        while (history.canRedo()) end = history.redo();
        EXPECT_EQ(end, task.last());
    }
    EXPECT_GE(files, 9);
}

// A first look: the hot spot found in the volume, taken hold of in the slices, at the last time.
TEST(Scenarios, AFirstLookEndsAtTheHotSpot) {
    const Recorded task = recorded("first_look");
    const Session& session = task.last();
    EXPECT_EQ(session.time, task.info().times.back());
    EXPECT_NE(task.steps.front().camera, session.camera);
    const glm::dvec3 away = (session.cursor - planted::kHotSpot) / planted::kHotSpotSigma;
    EXPECT_LT(glm::length(away), 0.5);
    const volume::ProbeValue here =
        volume::probeChannel(*task.source, task.channel("T"), session.cursor, task.info().nearestTime(session.time));
    EXPECT_GT(here.interpolated.value(), 365);
    const glm::dvec3 first = (task.steps[1].cursor - planted::kHotSpot) / planted::kHotSpotSigma;
    EXPECT_LT(std::abs(first.z), 3) << "the double click in the volume met the rim of the glow";
}

// Little oxygen in much water: brushed in a plot, inverted, cleared.
TEST(Scenarios, TheStarvedAndFloodedSamplesAreThePlantedBox) {
    const Recorded task = recorded("starvation");
    const auto brushed = std::find_if(task.steps.begin(), task.steps.end(),
                                      [](const Session& step) { return !step.selection.brushes.empty(); });
    ASSERT_NE(brushed, task.steps.end());
    const auto& region = std::get<vis::RangeRegion>(brushed->selection.brushes.front().region);
    ASSERT_EQ(region.intervals.size(), 2u);
    std::vector<int> channels;
    for (const vis::BrushInterval& interval : region.intervals) channels.push_back(task.channel(interval.channel));
    const glm::dvec3 cell = task.info().lattice.spacing;
    volume::Box box = planted::kFlooded;
    box.lo -= cell, box.hi += cell; // resampling carries its edge by up to a cell
    double surely = 0, perhaps = 0, all = 0;
    glm::dvec3 middle{0};
    forEach(*task.source, channels, task.info().nearestTime(brushed->time),
            [&](glm::dvec3 at, const std::vector<double>& values) {
                bool in = true, near = true, present = true;
                for (std::size_t i = 0; i < values.size(); ++i) {
                    const vis::BrushInterval& of = region.intervals[i];
                    present = present && !std::isnan(values[i]);
                    in = in && values[i] >= of.lo + of.soft && values[i] <= of.hi - of.soft;
                    near = near && values[i] >= of.lo - of.soft && values[i] <= of.hi + of.soft;
                }
                all += present;
                surely += in;
                perhaps += near;
                if (!near) return;
                middle += at;
                EXPECT_TRUE(planted::inside(box, at)) << at.x << ' ' << at.y << ' ' << at.z;
            });
    EXPECT_GT(surely, 3);
    EXPECT_TRUE(planted::inside(planted::kFlooded, middle / perhaps));
    const double counted = selected(task, *brushed, "O2").samples;
    EXPECT_GE(counted, surely);
    EXPECT_LE(counted, perhaps);

    const auto inverted = std::find_if(brushed, task.steps.end(), [](const Session& step) {
        return !step.selection.brushes.empty() && step.selection.brushes.front().inverted;
    });
    ASSERT_NE(inverted, task.steps.end());
    EXPECT_NEAR(selected(task, *inverted, "O2").samples, all - counted, 1e-3 * all);
    EXPECT_TRUE(task.last().selection.brushes.empty()) << "Esc over the volume clears every view's selection";
}

// Along the channel oxygen falls while water rises; the cursor is read at three places, further and further down.
TEST(Scenarios, OxygenFallsAlongTheChannelWhileWaterRises) {
    const Recorded task = recorded("along_channel");
    for (std::size_t i = 2; i < task.steps.size(); ++i)
        EXPECT_GT(task.steps[i].cursor.z, task.steps[i - 1].cursor.z + 1e-3);
    const Session& session = task.last();
    const auto view = std::find_if(session.views.begin(), session.views.end(),
                                   [](const auto& entry) { return std::holds_alternative<ProfileView>(entry.second); });
    ASSERT_NE(view, session.views.end());
    ProfileQuery query{.over = ProfileOver::Line,
                       .channels = {task.channel("O2"), task.channel("H2O"), task.channel("T")},
                       .corners = profileCorners(std::get<ProfileView>(view->second), session, task.info().bounds),
                       .samples = 200,
                       .times = {volume::timesAround(task.info().times, session.time)}};
    const Profile profile = readProfile(*task.source, query);
    EXPECT_LT(correlation(profile.values[0], profile.values[1]), -0.8);
    EXPECT_LT(correlation(profile.distance, profile.values[0]), -0.3);
    EXPECT_GT(correlation(profile.distance, profile.values[1]), 0.1);
    EXPECT_LT(profile.values[0].back(), 0.8 * profile.values[0].front());

    // As a table, with units; the row at the cursor holds what the read-out says.
    const std::string csv = csvOf(profileTable(task.info(), session, profile));
    EXPECT_EQ(csv.substr(0, csv.find('\n')), "distance [m],x [m],y [m],z [m],O2 [mol/m3],H2O [mol/m3],T [K]");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 201);
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < profile.positions.size(); ++i)
        if (glm::distance(profile.positions[i], session.cursor) <
            glm::distance(profile.positions[nearest], session.cursor))
            nearest = i;
    const auto read = volume::probe(*task.source, profile.positions[nearest], query.times[0]);
    for (std::size_t c = 0; c < query.channels.size(); ++c)
        EXPECT_EQ(profile.values[c][nearest], read[std::size_t(query.channels[c])].interpolated.value());
}

// A lens is dragged and enlarged; its statistics are those of the samples within.
TEST(Scenarios, ALensCountsWhatItHolds) {
    const Recorded task = recorded("lens");
    const vis::Lens &before = task.steps.front().lenses.front(), &after = task.last().lenses.front();
    EXPECT_GT(glm::distance(before.center, after.center), 1e-3);
    EXPECT_GT(after.size.x, before.size.x);
    const vis::WorldFrame world = vis::worldFrame(task.info(), task.last().stretch);
    const glm::dvec3 middle = world.toWorld(after.center);
    double surely = 0, perhaps = 0, least = 1e9, most = -1e9, sum = 0;
    forEach(*task.source, {task.channel("T")}, task.info().nearestTime(task.last().time),
            [&](glm::dvec3 at, const std::vector<double>& values) {
                const double radius = glm::length((world.toWorld(at) - middle) / glm::dvec3(after.size));
                if (std::isnan(values[0]) || radius >= 1) return;
                perhaps += 1;
                if (radius > 1 - double(after.rim)) return;
                surely += 1;
                sum += values[0];
                least = std::min(least, values[0]);
                most = std::max(most, values[0]);
            });
    ASSERT_GT(surely, 50);
    BrushedQuery query;
    query.channels = {task.channel("T")};
    query.ranges = {task.range("T")};
    query.time = volume::timesAround(task.info().times, task.last().time);
    query.bins = 1;
    query.selection.brushes = {{.name = "", .color = {}, .region = vis::LensRegion{after.name}}};
    query.lenses = lensSpace(task.last(), task.info());
    const volume::Summary inside = readStatistics(task.source, query, 0).channels.front().inside;
    EXPECT_GT(inside.samples, surely);
    EXPECT_LT(inside.samples, perhaps);
    EXPECT_LE(inside.min, least);
    EXPECT_GE(inside.max, most);
    EXPECT_NEAR(inside.mean, sum / surely, 1);
}

// Walls read what a search along the axis finds; the prism brushed on a wall reaches through the whole cell.
TEST(Scenarios, WallsReadTheMaximumAndTheMeanBehindThem) {
    const Recorded task = recorded("shadow_cube");
    const Session& session = task.last();
    const volume::Box bounds = task.info().bounds;
    const int time = task.info().nearestTime(session.time), heat = task.channel("T");
    const CubeFace& bottom = kCubeFaces[2];
    const auto highest = [&](glm::dvec3 at) {
        double most = -1e9;
        for (int i = 0; i <= 600; ++i) {
            at.y = bounds.lo.y + bounds.size().y * i / 600;
            if (const auto value = volume::probeChannel(*task.source, heat, at, time).interpolated)
                most = std::max(most, *value);
        }
        return most;
    };
    for (const double z : {0.004, 0.0115, 0.012, 0.022, 0.03}) {
        const glm::dvec3 at{1.1e-3, 0, z};
        const auto read = readWall(*task.source, session, heat, {.kind = WallKind::Maximum}, bottom, at, time);
        // It looks at quarters of cells: of the peak of the hot spot it may miss a part.
        EXPECT_LE(read.value(), highest(at) + 1e-3) << z;
        EXPECT_GE(read.value(), highest(at) - 0.05 - 0.15 * (highest(at) - task.range("T").lo)) << z;
    }
    const auto wall = [&](double z) {
        return readWall(*task.source, session, heat, {.kind = WallKind::Maximum}, bottom, {1.1e-3, 0, z}, time).value();
    };
    EXPECT_GT(wall(planted::kHotSpot.z), wall(0.03) + 6) << "the hot spot shows on the wall";
    const auto oxygen = [&](double z) {
        return readWall(*task.source, session, task.channel("O2"), {.kind = WallKind::Mean}, kCubeFaces[0],
                        {0, 1e-3, z}, time)
            .value();
    };
    EXPECT_LT(oxygen(0.026), 0.8 * oxygen(0.02)) << "the flooded box shows on the wall";
    const vis::Brush& brush = session.selection.brushes.back();
    const auto& box = std::get<vis::BoxRegion>(brush.region);
    EXPECT_LE(box.center.x - box.radius.x, bounds.lo.x);
    EXPECT_GE(box.center.x + box.radius.x, bounds.hi.x);
    EXPECT_TRUE(planted::inside(planted::kFlooded, box.center));
    EXPECT_TRUE(planted::inside(planted::kFlooded, session.cursor)) << "a double click on the wall took it there";
}

// With time in place of x the pulse is a ridge in a picture of z and time that slants by its speed.
TEST(Scenarios, ThePulseIsARidgeWhereTimeIsAnAxis) {
    const Recorded task = recorded("pulse");
    DataRef data = task.last().data;
    const volume::Box& box = task.info().bounds;
    data.timeAxis = {volume::SpaceAxis::X, (task.last().cursor.x - box.lo.x) / box.size().x};
    std::vector<std::string> messages;
    const auto source = openSource(data, messages);
    ASSERT_TRUE(messages.empty());
    const double perLength = source->info().plane->timePerLength;
    const int hydrogen = source->info().findChannel("H2").value();
    const auto at = [&](double time, std::vector<glm::dvec3> line) {
        for (glm::dvec3& place : line) place.x = time / perLength;
        std::vector<double> values;
        for (const volume::ProbeValue& value : volume::probeAlong(*source, hydrogen, line, 0))
            values.push_back(value.interpolated.value_or(std::nan("")));
        return values;
    };
    const std::vector<glm::dvec3> corners{{0, task.last().cursor.y, box.lo.z}, {0, task.last().cursor.y, box.hi.z}};
    const std::vector<glm::dvec3> line = volume::alongPolyline(corners, 200);
    const auto ridge = [&](double time) {
        const std::vector<double> now = at(time, line), then = at(planted::kPulseOnset - 0.03, line);
        double most = 0, place = 0;
        for (std::size_t i = 0; i < line.size(); ++i)
            if (now[i] - then[i] > most) most = now[i] - then[i], place = line[i].z;
        return place;
    };
    const double early = planted::kPulseOnset + 0.03, late = task.info().times.back();
    EXPECT_NEAR(ridge(early), planted::kPulseStart - 0.03 * planted::kPulseSpeed, 1.5e-3);
    EXPECT_NEAR((ridge(late) - ridge(early)) / (late - early), -planted::kPulseSpeed, 0.3 * planted::kPulseSpeed);
}

// The pulse of hydrogen: found on the curves over time at the cursor, and as a slanted ridge over place and time.
TEST(Scenarios, ThePulseBeginsAtItsPlantedTime) {
    const Recorded task = recorded("pulse");
    const Session& session = task.last();
    EXPECT_EQ(task.info().times[std::size_t(task.info().nearestTime(session.time))], session.time);
    EXPECT_NEAR(session.time, planted::kPulseOnset, 1e-9) << "the time the researcher stopped at";
    const int hydrogen = task.channel("H2");
    const std::vector<double>& times = task.info().times;
    const auto view = std::find_if(session.views.begin(), session.views.end(), [](const auto& entry) {
        const auto* profile = std::get_if<ProfileView>(&entry.second);
        return profile && profile->over != ProfileOver::Line;
    });
    ASSERT_NE(view, session.views.end());
    const Profile over = readProfile(
        *task.source, {.over = ProfileOver::LineAndTime,
                       .channels = {hydrogen},
                       .corners = profileCorners(std::get<ProfileView>(view->second), session, task.info().bounds),
                       .samples = 150});
    const std::size_t places = over.positions.size();
    const auto value = [&](std::size_t t, std::size_t i) { return over.values[0][t * places + i]; };
    ASSERT_FALSE(std::isnan(value(0, places / 2))) << "the line lies where there is hydrogen";
    // How far each time stands out against the first; where the ridge is.
    int onset = -1;
    std::vector<double> ridge;
    for (std::size_t t = 0; t < times.size(); ++t) {
        double most = 0, at = 0;
        for (std::size_t i = 0; i < places; ++i)
            if (const double rise = value(t, i) - value(0, i); rise > most) most = rise, at = over.positions[i].z;
        if (most < 2) continue;
        if (onset < 0) onset = int(t);
        ridge.push_back(at);
    }
    ASSERT_GE(onset, 0);
    EXPECT_EQ(times[std::size_t(onset)], session.time);
    ASSERT_GE(ridge.size(), 3u);
    const double interval = times[std::size_t(onset) + 1] - times[std::size_t(onset)];
    EXPECT_NEAR((ridge[2] - ridge[0]) / (2 * interval), -planted::kPulseSpeed, 0.25 * planted::kPulseSpeed);
}

// Turned in planes of space and of time by hand, then turned back.
TEST(Scenarios, TheTesseractTurnsAndTurnsBack) {
    const Recorded task = recorded("tesseract");
    const auto angles = [](const Session& session) {
        for (const auto& [pane, view] : session.views)
            if (const auto* tesseract = std::get_if<TesseractView>(&view)) return anglesOf(*tesseract, 4);
        return std::vector<double>(6);
    };
    std::vector<double> farthest(6);
    for (const Session& step : task.steps) {
        const std::vector<double> now = angles(step), start = angles(task.steps.front());
        for (std::size_t i = 0; i < 6; ++i) farthest[i] = std::max(farthest[i], std::abs(now[i] - start[i]));
        const vis::RotationN rotation = vis::rotationOf(now);
        const vis::RotationN product = rotation * rotation.inverse();
        for (int i = 0; i < 64; ++i) EXPECT_NEAR(product.at(i / 8, i % 8), i / 8 == i % 8 ? 1 : 0, 1e-12);
        for (int corner = 0; corner < 16; ++corner) {
            const vis::PointN at = rotation * vis::cornerOf(corner, {1, 1, 1, 1}, 4);
            EXPECT_LE(glm::length(vis::project({}, 2, vis::firstFour(at)).at), 1.0 + 1e-9) << "no blow-up at any angle";
        }
    }
    for (std::size_t i = 0; i < 6; ++i) EXPECT_GT(farthest[i], 1) << "plane " << i;
    EXPECT_EQ(angles(task.last()), angles(task.steps.front()));
}

} // namespace
} // namespace tessera::app
