#include "app/described/describe_json.h"
#include "app/queries/latest_feed.h"
#include "app/queries/readout.h"
#include "app/queries/statistics_feed.h"
#include "app/queries/surface_feed.h"
#include "app/views/compare/compare_feed.h"
#include "app/views/tesseract/tesseract_feed.h"
#include "codec/pack/pack.h"
#include "tests/app/views_fixture.h"
#include "volume/reconstruct/probe.h"

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <thread>
#include <unistd.h>

namespace tessera::app {
namespace {

/// Feeds of views in frames without pictures.
struct Feeds : ViewsTest {
    Feeds() {
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
            busy = now.busy;
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
    /// As many frames as it takes.
    template <class Get> void finish(Get&& get) {
        busy = true;
        for (int turn = 0; turn < 500 && busy; ++turn) {
            ViewContext now = context();
            get(now);
            busy = now.busy;
            jobs.wait();
            for (const std::string& text : jobs.collect()) messages.push_back(text);
        }
        EXPECT_FALSE(busy);
    }
};

// Pictures on one lattice, numbers from another: what is counted and read is of the latter.
TEST_F(Feeds, ReadTheSamplesThatNumbersComeFrom) {
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
    StatisticsFeed statistics;
    const auto counted =
        statistics.get(now, "statistics", makeWish(session, numbers->info(), {t}, {{0, 1000}}, 8, false));
    ASSERT_TRUE(counted);
    EXPECT_EQ(counted->statistics.channels[0].all.samples, double(numbers->grid().lattice.count()));
    LatestFeed<int, std::size_t> latest;
    const auto samples = latest.get(
        now, "latest", "Samples", 1, [](const auto& of, int, const Progress&) { return of->grid().lattice.count(); },
        [](int) { return true; });
    ASSERT_TRUE(samples);
    EXPECT_EQ(*samples, numbers->grid().lattice.count());
    Readout readout;
    session.cursor = numbers->info().bounds.lo + numbers->info().bounds.size() * glm::dvec3(0.37, 0.61, 0.43);
    updateReadout(now, readout);
    const auto time = volume::timesAround(numbers->info().times, session.time);
    EXPECT_EQ(readout.value("T"), volume::probe(*numbers, session.cursor, time)[std::size_t(t)].interpolated);
    EXPECT_NE(readout.value("T"), volume::probe(*source, session.cursor, time)[std::size_t(t)].interpolated);
}

// An answer that takes longer than a frame comes although the last one is of no use meanwhile.
TEST_F(Feeds, AnAnswerOnItsWayIsNotAskedForAgain) {
    LatestFeed<int, int> feed;
    std::atomic<int> asked = 0;
    const auto get = [&](int wish) {
        ViewContext now = context();
        return feed.get(
            now, "slow", "Slow", wish,
            [&](const auto&, int of, const Progress& progress) {
                ++asked;
                for (int i = 0; i < 30; ++i) {
                    std::this_thread::sleep_for(std::chrono::milliseconds(2));
                    progress.advance(i / 30.0);
                }
                return of;
            },
            [&](int answered) { return answered == wish; });
    };
    for (const int wish : {1, 2}) {
        std::shared_ptr<const int> answer;
        for (int i = 0; i < 20000 && !answer; ++i) {
            answer = get(wish);
            jobs.collect();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        ASSERT_TRUE(answer) << wish;
        EXPECT_EQ(*answer, wish);
        EXPECT_EQ(asked, wish);
    }
}

// What the user cancels is not started again in the next frame, but when something else is wanted.
TEST_F(Feeds, CancelledStatisticsWaitForAnotherWish) {
    StatisticsFeed feed;
    int bins = 32;
    const auto get = [&](ViewContext& now) {
        return feed.get(now, "feed", makeWish(session, source->info(), {0}, {{0, 1000}}, bins, false));
    };
    EXPECT_EQ(cancelAll(get), 1);
    EXPECT_FALSE(busy);
    EXPECT_EQ(feed.failure(), "cancelled");
    EXPECT_TRUE(messages.empty());
    bins = 16;
    finish(get);
    EXPECT_EQ(feed.failure(), "");
    bins = 32;
    finish(get);
    ViewContext now = context();
    EXPECT_EQ(get(now)->statistics.level, 0) << "wanted again, it is tried again";
}

TEST_F(Feeds, CancelledLatestAnswerWaitsForAnotherWish) {
    LatestFeed<int, int> feed;
    int wish = 1;
    bool memory = true;
    const auto get = [&](ViewContext& now) {
        return feed.get(
            now, "feed", "Twice", wish,
            [memory](const auto&, int of, const Progress& progress) {
                progress.advance(0);
                if (!memory) throw std::bad_alloc();
                return 2 * of;
            },
            [](int) { return true; });
    };
    EXPECT_EQ(cancelAll(get), 1);
    EXPECT_FALSE(busy);
    EXPECT_EQ(feed.failure(), "cancelled");
    wish = 2;
    finish(get);
    ViewContext now = context();
    EXPECT_EQ(*get(now), 4);
    EXPECT_EQ(feed.failure(), "");

    memory = false;
    wish = 3;
    finish(get);
    EXPECT_EQ(feed.failure(), "not enough memory");
    EXPECT_THAT(messages, testing::ElementsAre("not enough memory"));
    EXPECT_EQ(*get(now), 4) << "what was there stays";
}

TEST_F(Feeds, TheNewestAnswerOfTheSamePlotsIsShownMeanwhile) {
    StatisticsFeed feed;
    const int t = source->info().findChannel("T").value();
    const auto wish = [&](double most, int bins) {
        return makeWish(session, source->info(), {t}, {{0, most}}, bins, false);
    };
    ViewContext now = context();
    now.headless = true;
    const auto other = feed.get(now, "statistics", wish(500, 16));
    const auto older = feed.get(now, "statistics", wish(500, 8)), newer = feed.get(now, "statistics", wish(600, 8));
    ASSERT_NE(older, newer);
    now.headless = false;
    EXPECT_EQ(feed.get(now, "statistics", wish(700, 8)), newer);
    EXPECT_EQ(feed.get(now, "statistics", wish(700, 16)), other);
    EXPECT_EQ(feed.get(now, "statistics", wish(700, 32)), nullptr);
    jobs.wait();
    jobs.collect();
}

TEST_F(Feeds, ASurfaceInTwoPartsTellsItsProgressInOne) {
    for (const char* colorBy : {"", "H2"}) {
        const Range range = source->info().channelRange(
            source->info().channels()[std::size_t(source->info().findChannel("T").value())]);
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

TEST_F(Feeds, CancelledSurfaceWaitsForAnotherWish) {
    SurfaceFeed feed;
    vis::IsoLayer layer{.channel = "T"};
    const Range range =
        source->info().channelRange(source->info().channels()[std::size_t(*source->info().findChannel("T"))]);
    layer.value = 0.5 * (range.lo + range.hi);
    layer.method = vis::SurfaceMethod::Polygons;
    session.layers = {{"surface", true, layer}};
    const auto get = [&](ViewContext& now) { return feed.get(now, "pane", false); };
    EXPECT_EQ(cancelAll(get), 1);
    EXPECT_FALSE(busy);
    std::get<vis::IsoLayer>(session.layers[0].technique).value = 0.4 * range.lo + 0.6 * range.hi;
    finish(get);
    ViewContext now = context();
    EXPECT_EQ(get(now).size(), 1u);
}

TEST_F(Feeds, CancelledSamplesOfTheTesseractWaitForAnotherWish) {
    TesseractFeed feed;
    volume::SamplesQuery query;
    query.channels = {0};
    query.times = {0, 1};
    const auto get = [&](ViewContext& now) { return feed.get(now, "tesseract", query, {}); };
    EXPECT_EQ(cancelAll(get), 1);
    EXPECT_FALSE(busy);
    EXPECT_EQ(feed.failure(), "cancelled");
    query.channels = {1};
    finish(get);
    ViewContext now = context();
    EXPECT_TRUE(get(now));
}

TEST_F(Feeds, CancelledDataToCompareAreNotOpenedAgain) {
    CompareFeed feed;
    std::vector<CompareVariant> variants{{"as it is", {}}, {"other", {{"/data/model", "\"marschner-lobb\""}}}};
    session.data.model = "fuel-cell";
    const auto get = [&](ViewContext& now) { feed.draw(now, "pane", variants, 0, {32, 24}, false); };
    EXPECT_EQ(cancelAll(get, ":data"), 1);
    finish(get);
    ASSERT_EQ(feed.cells().size(), 2u);
    EXPECT_EQ(feed.cells()[1]->failure, "cancelled");
    EXPECT_EQ(feed.cells()[0]->failure, "");
    session.camera.distance *= 1.1f; // another picture of the same data
    EXPECT_EQ(cancelAll(get, ":data"), 0);
    variants[1].changes = {{"/data/model", "\"marschner-lobb\""},
                           {"/data/settings", "{\"nx\": 8, \"ny\": 8, \"nz\": 8}"}};
    finish(get);
    EXPECT_EQ(feed.cells()[1]->failure, "");
    EXPECT_TRUE(feed.cells()[1]->finished());
}

// Renderers of other data share the limits with the window's, and what they have to say reaches the log.
TEST_F(Feeds, RenderersOfVariantsShareTheLimitsAndSpeak) {
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
    CompareFeed feed;
    session.data.model = "fuel-cell";
    const Json files = Json::array({{{"path", path}, {"absolutePath", path}}});
    const std::vector<CompareVariant> variants{
        {"as it is", {}}, {"damaged", {{"/data/files", files.dump()}, {"/layers/0/technique/channel", "rho"}}}};
    std::vector<std::string> said;
    const auto get = [&](ViewContext& now) {
        now.renderers = 1 + feed.renderers();
        feed.draw(now, "pane", variants, 0, {32, 24}, false);
        said.insert(said.end(), now.messages.begin(), now.messages.end());
    };
    finish(get);
    std::filesystem::remove(path);
    ASSERT_EQ(feed.cells()[1]->failure, "");
    EXPECT_EQ(feed.renderers(), 1);
    const auto half = std::size_t(session.render.limits.textureMemory) / 2 << 20;
    EXPECT_EQ(renderer.residency().textureBudget, half);
    EXPECT_EQ(feed.cells()[1]->data->renderer->residency().textureBudget, half);
    EXPECT_EQ(feed.cells()[1]->data->renderer->residency().memoryBudget,
              std::size_t(session.render.limits.brickMemory) / 2 << 20);
    EXPECT_THAT(said, testing::Contains(testing::StartsWith("damaged: ")));
}

} // namespace
} // namespace tessera::app
