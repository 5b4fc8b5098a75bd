#include "app/data/growth_watch.h"
#include "app/platform/gui.h"
#include "app/platform/headless.h"
#include "codec/archive/archive.h"
#include "codec/container/container.h"
#include "codec/pack/pack.h"
#include "vis/gl/headless.h"
#include "volume/derived/derived_bricks.h"
#include "volume/synthetic/models.h"

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <imgui.h>
#include <mutex>
#include <unistd.h>

namespace tessera::app {
namespace {

using namespace std::chrono_literals;

struct GrowthGl : ::testing::Test {
    std::string path = ::testing::TempDir() + "growth_" + std::to_string(::getpid()) + ".tsr";
    std::string beside = ::testing::TempDir() + "growth_beside_" + std::to_string(::getpid()) + ".tsr";
    void TearDown() override {
        std::filesystem::remove(path);
        std::filesystem::remove(beside);
    }
};

/// Some times of a signal that moves.
volume::Dataset moving(int first, int count) {
    volume::Dataset whole =
        volume::makeModel("marschner-lobb", {{"nx", 16}, {"ny", 16}, {"nz", 16}, {"times", 6}, {"bits", 8}});
    volume::Dataset some;
    some.info = whole.info;
    some.info.times.assign(whole.info.times.begin() + first, whole.info.times.begin() + first + count);
    some.read = [read = whole.read, first](int p, int c, int t) { return read(p, c, first + t); };
    return some;
}

template <class Condition> bool comes(Condition&& condition) {
    for (int turn = 0; turn < 1000; ++turn, std::this_thread::sleep_for(10ms))
        if (condition()) return true;
    return false;
}

TEST_F(GrowthGl, AWatchTellsOfWholeStatesOnly) {
    volume::Dataset early = moving(0, 2), late = moving(2, 1);
    codec::pack(early, {}, path);
    std::atomic<int> woken = 0;
    GrowthWatch watch(
        path, [&] { ++woken; }, 1ms);
    EXPECT_TRUE(watch.changed()); // whatever came before
    EXPECT_FALSE(watch.changed());
    std::ofstream(path, std::ios::app | std::ios::binary) << "not whole yet";
    std::this_thread::sleep_for(100ms);
    EXPECT_FALSE(watch.changed());
    codec::append(late, path);
    EXPECT_TRUE(comes([&] { return watch.changed(); }));
    EXPECT_TRUE(comes([&] { return woken > 0; })); // it wakes after it has noted the change
    std::filesystem::remove(path);
    std::this_thread::sleep_for(20ms);
    EXPECT_FALSE(watch.changed());
    EXPECT_EQ(woken, 1);
}

// A commit writes its header twice, and whoever looks between sees two different ones.
TEST_F(GrowthGl, TheTwoCopiesOfAHeaderAreOneChange) {
    volume::Dataset early = moving(0, 2), late = moving(2, 1);
    codec::pack(early, {}, path);
    constexpr std::size_t kBoth = 2 * codec::kHeaderBytes;
    const auto headers = [&] {
        std::string bytes(kBoth, 0);
        std::ifstream(path, std::ios::binary).read(bytes.data(), kBoth);
        return bytes;
    };
    const auto write = [&](std::size_t place, const std::string& bytes) {
        std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(std::streamoff(place));
        file << bytes;
    };
    const std::string before = headers();
    codec::append(late, path);
    const std::string after = headers();
    ASSERT_NE(before, after);
    write(0, before); // as it is just before the commit

    std::atomic<int> woken = 0;
    GrowthWatch watch(
        path, [&] { ++woken; }, 1ms);
    write(codec::kHeaderBytes, after.substr(codec::kHeaderBytes));
    EXPECT_TRUE(comes([&] { return woken > 0; }));
    EXPECT_TRUE(watch.changed());
    write(0, after.substr(0, codec::kHeaderBytes));
    std::this_thread::sleep_for(100ms);
    EXPECT_FALSE(watch.changed());
    EXPECT_EQ(woken, 1);
}

TEST_F(GrowthGl, TheWorkbenchTakesNewTimesOver) {
    volume::Dataset early = moving(0, 2), late = moving(2, 4);
    codec::pack(early, {}, path);
    OpenRequest request;
    request.paths = {path};
    const Opened opened = open(request);
    const vis::HeadlessContext gl;
    const Gui gui;
    Workbench workbench({.renderer = nullptr,
                         .render = {},
                         .headless = false,
                         .onlyPane = {},
                         .stateFolder = {},
                         .growthInterval = 1ms});
    workbench.install(opened);
    const vis::Image before = drawUntilDone(workbench, {600, 400}, 1);
    const std::vector<double> times = workbench.source()->info().times;
    ASSERT_EQ(times.size(), 2u);
    const double shown = workbench.session().time;
    const std::size_t layers = workbench.session().layers.size();

    codec::append(late, path);
    ASSERT_TRUE(comes([&] {
        (void)drawUntilDone(workbench, {600, 400}, 1);
        return workbench.source()->info().times.size() == 6;
    }));
    EXPECT_EQ(workbench.session().time, shown);
    EXPECT_EQ(workbench.session().layers.size(), layers);
    workbench.session().time = workbench.source()->info().times[5];
    const vis::Image after = drawUntilDone(workbench, {600, 400}, 1);
    EXPECT_NE(before.rgba, after.rgba);
    EXPECT_FALSE(workbench.busy());
}

// What is held of a view stays held, and its picture with it.
TEST_F(GrowthGl, ADragGoesOnWhenNewTimesCome) {
    volume::Dataset early = moving(0, 2), late = moving(2, 4);
    codec::pack(early, {}, path);
    OpenRequest request;
    request.paths = {path};
    const vis::HeadlessContext gl;
    const Gui gui;
    Workbench workbench({.onlyPane = "volume", .growthInterval = 1ms});
    workbench.install(open(request));
    (void)drawUntilDone(workbench, {600, 400}, 1);
    OffscreenFrames frames({600, 400});
    const auto hold = [&](float x, bool down) {
        frames.draw(workbench, 1, [&](ImGuiIO& io) {
            io.MousePos = {x, 200};
            io.MouseDown[0] = down;
        });
    };
    hold(300, false);
    hold(300, false);
    hold(300, true);
    const vis::Camera start = workbench.session().camera;
    hold(320, true);
    const vis::Camera held = workbench.session().camera;
    ASSERT_FALSE(held == start);
    const ViewCache* cache = workbench.cache("volume");
    codec::append(late, path);
    ASSERT_TRUE(comes([&] {
        hold(320, true);
        return workbench.source()->info().times.size() == 6;
    }));
    EXPECT_EQ(workbench.cache("volume"), cache);
    EXPECT_TRUE(workbench.session().camera == held);
    hold(360, true);
    EXPECT_FALSE(workbench.session().camera == held);
    hold(360, false);
    (void)drawUntilDone(workbench, {600, 400}, 1);
}

/// An archive that can be made to keep its readers waiting.
class GatedArchive final : public volume::BrickSource {
public:
    explicit GatedArchive(const std::string& path) : archive_(codec::openArchive(path)) {}
    const volume::DatasetInfo& info() const override { return archive_->info(); }
    const volume::BrickGrid& grid() const override { return archive_->grid(); }
    volume::BrickStats stats(const volume::BrickKey& key) const override { return archive_->stats(key); }
    volume::BrickSamples read(const volume::BrickKey& key) const override {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return open_; });
        return archive_->read(key);
    }
    void open(bool open) const {
        const std::lock_guard lock(mutex_);
        open_ = open;
        changed_.notify_all();
    }

private:
    std::shared_ptr<const volume::BrickSource> archive_;
    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    mutable bool open_ = true;
};

// New times that come while a parameter is being derived take its data away: it is derived from the new ones.
TEST_F(GrowthGl, AParameterIsDerivedThoughNewTimesCome) {
    volume::Dataset early = moving(0, 2), late = moving(2, 4);
    codec::pack(early, {}, path);
    OpenRequest request;
    request.paths = {path};
    Opened opened = open(request);
    const auto gated = std::make_shared<const GatedArchive>(path);
    opened.source = opened.numbers = gated;
    const vis::HeadlessContext gl;
    const Gui gui;
    Workbench workbench({.growthInterval = 1ms});
    workbench.install(std::move(opened));
    (void)drawUntilDone(workbench, {600, 400}, 1);
    OffscreenFrames frames({600, 400});
    gated->open(false);
    workbench.session().data.derived = {{"twice", "", volume::ExpressionRecipe{"2*rho"}}};
    frames.draw(workbench, 1);
    codec::append(late, path);
    EXPECT_TRUE(comes([&] {
        frames.draw(workbench, 1);
        return workbench.source()->info().times.size() == 6;
    }));
    EXPECT_TRUE(workbench.jobs().running("derive"));
    gated->open(true);
    EXPECT_TRUE(comes([&] {
        frames.draw(workbench, 1);
        return workbench.source()->info().findChannel("twice").has_value();
    }));
    EXPECT_EQ(workbench.source()->info().times.size(), 6u);
}

// The last time is another one when the archive has grown, and so is what was taken away.
TEST_F(GrowthGl, ADifferenceFromTheLastTimeFollowsTheArchive) {
    volume::Dataset early = moving(0, 2), late = moving(2, 4);
    codec::pack(early, {}, path);
    OpenRequest request;
    request.data = dataOf({path}, {});
    request.data->derived = {{"d", "", volume::DifferenceRecipe{"rho", volume::OtherTime::Last}}};
    const vis::HeadlessContext gl;
    const Gui gui;
    Workbench workbench({.growthInterval = 1ms});
    workbench.install(open(request));
    (void)drawUntilDone(workbench, {600, 400}, 1);
    const auto expectLast = [&] { // in numbers: samples of pictures are made of the differences
        const auto source = workbench.document().sources().numbers;
        const int last = int(source->info().times.size()) - 1;
        const volume::BrickKey key{*source->info().findChannel("rho"), 0, 0, {0, 0, 0}};
        volume::BrickKey then = key, difference = key;
        then.time = last;
        difference.channel = *source->info().findChannel("d");
        const volume::BrickSamples a = source->read(key), b = source->read(then), d = source->read(difference);
        double most = 0;
        for (std::size_t i = 0; i < d.values.size(); ++i) {
            EXPECT_EQ(d.values[i], float(double(a.values[i]) - double(b.values[i])));
            most = std::max(most, std::abs(double(d.values[i])));
        }
        EXPECT_GT(most, 0);
    };
    expectLast();
    codec::append(late, path);
    ASSERT_TRUE(comes([&] {
        (void)drawUntilDone(workbench, {600, 400}, 1);
        return workbench.source()->info().times.size() == 6;
    }));
    expectLast();
}

// Of two archives either may grow, the other one at times of the first that it did not reach.
TEST_F(GrowthGl, TheOtherDataGrowToo) {
    volume::Dataset most = moving(0, 5), last = moving(5, 1), early = moving(0, 2), late = moving(2, 4);
    codec::pack(most, {}, path);
    codec::pack(early, {}, beside);
    OpenRequest request;
    request.data = dataOf({path}, {});
    request.data->other = OtherData{.files = dataOf({beside}, {}).files, .model = {}, .settings = {}, .import = {}};
    const vis::HeadlessContext gl;
    const Gui gui;
    Workbench workbench({.onlyPane = "volume", .growthInterval = 1ms});
    workbench.install(open(request));
    vis::Layer layer;
    layer.name = "other";
    layer.technique = vis::VolumeLayer{.channel = "rho (other)"};
    workbench.session().layers = {layer};
    workbench.session().time = workbench.source()->info().times[4];
    const vis::Image before = drawUntilDone(workbench, {600, 400}, 1);
    // Whether the other data are there at this time; then they are the same as the first.
    const auto both = [&](int time) {
        const auto source = workbench.source();
        const volume::BrickKey key{*source->info().findChannel("rho"), time, 0, {0, 0, 0}};
        volume::BrickKey otherKey = key;
        otherKey.channel = *source->info().findChannel("rho (other)");
        const volume::BrickSamples own = source->read(key), other = source->read(otherKey);
        const bool there = other.isPresent(0);
        if (there) {
            EXPECT_EQ(other.values, own.values) << time;
        }
        return there;
    };
    EXPECT_TRUE(both(1));
    EXPECT_FALSE(both(4));
    codec::append(late, beside);
    ASSERT_TRUE(comes([&] {
        (void)drawUntilDone(workbench, {600, 400}, 1);
        return both(4);
    }));
    EXPECT_NE(before.rgba, drawUntilDone(workbench, {600, 400}, 1).rgba);
    EXPECT_EQ(workbench.source()->info().times.size(), 5u);
    codec::append(last, path);
    ASSERT_TRUE(comes([&] {
        (void)drawUntilDone(workbench, {600, 400}, 1);
        return workbench.source()->info().times.size() == 6;
    }));
    EXPECT_TRUE(both(5));
    EXPECT_FALSE(workbench.busy());
}

} // namespace
} // namespace tessera::app
