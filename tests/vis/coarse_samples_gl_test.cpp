#include "tests/vis/function_source.h"
#include "tests/vis/gl_fixture.h"

#include <atomic>
#include <cmath>
#include <mutex>
#include <set>
#include <sys/resource.h>
#include <thread>
#include <unistd.h>

/// The processor draws large data from coarse samples until it has read all.
namespace tessera::vis {
namespace {

class CoarseSamplesGl : public test::GlTest {};

constexpr glm::ivec2 kSmallPicture(64, 48);
constexpr int kHeldTimes = 4;

int ownNiceness() {
    return getpriority(PRIO_PROCESS, id_t(gettid()));
}

/// Waves in the middle of a box of more than 2^21 samples at each of four times, whose samples at full resolution can
/// be held back.
class HeldBack : public FunctionSource {
public:
    explicit HeldBack(glm::ivec3 size)
        : FunctionSource(volume::LatticeKind::CC, size, glm::dvec3(1), {{"v", value}}, 32) {}
    explicit HeldBack(volume::LatticeKind kind)
        : FunctionSource(kind, kind == volume::LatticeKind::CC ? glm::ivec3(130, 120, 140) : glm::ivec3(150, 140, 150),
                         glm::dvec3(1), {{"v", value}}, 32) {
        info_.times.clear();
        for (int i = 0; i < kHeldTimes; ++i) info_.times.push_back(i);
        info_.parameters[0].ranges.resize(kHeldTimes, info_.parameters[0].ranges[0]);
    }
    ~HeldBack() override = default;

    const volume::DatasetInfo& info() const override { return info_; }
    volume::BrickSamples read(const volume::BrickKey& key) const override {
        {
            const std::lock_guard lock(mutex_);
            if (key.level == 0) {
                fineTimes_.insert(key.time);
                lowestOfFine_ = std::max(lowestOfFine_, ownNiceness());
            } else {
                highestOfCoarse_ = std::min(highestOfCoarse_, ownNiceness());
            }
        }
        while (held_ && key.level == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (key.level == 0) ++fine_;
        volume::BrickSamples out = FunctionSource::read(key);
        for (float& value : out.values) value += 0.05f * float(key.time);
        return out;
    }
    void hold(bool yes) { held_ = yes; }
    std::size_t fine() const { return fine_; }
    /// Times of which samples at full resolution have been asked for.
    std::set<int> fineTimes() const {
        const std::lock_guard lock(mutex_);
        return fineTimes_;
    }
    /// Niceness of the least urgent thread that read samples at full resolution, and of the most urgent one of coarse
    /// ones: helpers of either may have that of the thread that began them.
    int lowestOfFine() const {
        const std::lock_guard lock(mutex_);
        return lowestOfFine_;
    }
    int highestOfCoarse() const {
        const std::lock_guard lock(mutex_);
        return highestOfCoarse_;
    }

private:
    static std::optional<double> value(glm::dvec3 p) {
        return 0.3 + 0.25 * std::sin(0.06 * p.x) * std::cos(0.05 * p.y) + 0.4 * p.z / 150;
    }
    volume::DatasetInfo info_ = FunctionSource::info();
    std::atomic<bool> held_ = false;
    mutable std::atomic<std::size_t> fine_ = 0;
    mutable std::mutex mutex_;
    mutable std::set<int> fineTimes_;
    mutable int lowestOfFine_ = -100, highestOfCoarse_ = 100;
};

/// A renderer of such data; what is read in the background at its end must not be held back.
struct CoarseDrawing {
    std::shared_ptr<HeldBack> source;
    std::atomic<int> arrivals = 0; ///< of samples read in the background
    Renderer renderer;
    ViewTargetPtr target = renderer.makeTarget();
    Scene scene;

    CoarseDrawing(volume::LatticeKind kind, double patience)
        : source(std::make_shared<HeldBack>(kind)),
          renderer({.packets = Packets::Always, .patience = patience, .exactTextures = true, .arrived = [this] {
                        ++arrivals;
                    }}) {
        renderer.setSource(source);
        scene.layers = {{.name = "waves", .technique = VolumeLayer{.channel = "v", .shaded = false, .density = 2}}};
        scene.transfer["v"].opacity = {{0, 0}, {1, 0.2f}};
    }
    ~CoarseDrawing() { source->hold(false); }

    FrameStatus frame(bool moving = false) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return renderer.render(*target, scene, {.size = kSmallPicture, .moving = moving, .budgetMs = 4000});
    }
    /// Frames until one is as wanted.
    template <class Wanted> FrameStatus until(const Wanted& wanted) {
        FrameStatus status;
        for (int i = 0; i < 20000; ++i)
            if (status = frame(); wanted(status)) return status;
        ADD_FAILURE() << "never";
        return status;
    }
    std::vector<glm::vec4> shown() { return renderer.readLinear(*target); }
    std::vector<glm::vec4> waited() {
        const ViewTargetPtr other = renderer.makeTarget();
        test::renderAll(renderer, *other, scene, kSmallPicture);
        return renderer.readLinear(*other);
    }
};

double rmsApart(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += double(glm::dot(a[i] - b[i], a[i] - b[i]));
    return std::sqrt(sum / double(a.size() * 4));
}

constexpr auto isCurrent = [](const FrameStatus& status) { return status.current; };
constexpr auto isComplete = [](const FrameStatus& status) { return status.complete; };

TEST_F(CoarseSamplesGl, AreDrawnUntilAllAreRead) {
    for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
        CoarseDrawing drawing(kind, 0);
        drawing.source->hold(true);
        drawing.until(isCurrent);
        FrameStatus status;
        for (int i = 0; i < 20; ++i) { // as far as it is refined without the others
            status = drawing.frame();
            EXPECT_FALSE(status.complete);
        }
        EXPECT_TRUE(status.waits) << "no need to draw on until they are here";
        EXPECT_EQ(drawing.source->fine(), 0u);
        EXPECT_EQ(drawing.arrivals, 1);
        EXPECT_TRUE(status.engine.byProcessor);
        EXPECT_EQ(status.bricksMissing, int(drawing.source->grid().brickCount())) << "it says that it is coarse";
        EXPECT_LT(status.samples, drawing.source->grid().lattice.count() / 7);
        const std::vector<glm::vec4> coarse = drawing.shown();
        drawing.scene.camera.distance *= 0.8f; // what moves meanwhile is drawn, too
        drawing.until(isCurrent);
        for (int i = 0; i < 20; ++i) drawing.frame();
        EXPECT_GT(rmsApart(coarse, drawing.shown()), 0.02);
        drawing.source->hold(false);
        status = drawing.until(isComplete);
        EXPECT_EQ(status.bricksMissing, 0);
        EXPECT_FALSE(status.waits);
        for (int i = 0; i < 20000 && drawing.arrivals < 2; ++i) drawing.frame();
        EXPECT_EQ(drawing.arrivals, 2);
        EXPECT_EQ(status.samples, drawing.source->grid().lattice.count());
        EXPECT_LT(rmsApart(drawing.shown(), drawing.waited()), 1e-6);
        drawing.scene.camera.distance /= 0.8f;
        EXPECT_EQ(drawing.frame().bricksMissing, 0) << "all stay";
        drawing.until(isComplete);
        const double apart = rmsApart(coarse, drawing.shown()),
                     all = rmsApart(drawing.shown(), {drawing.shown().size(), glm::vec4(0)});
        EXPECT_LT(apart, 0.01 * all) << int(kind) << ": samples at their places";
        EXPECT_GT(apart, 1e-5);
        EXPECT_TRUE(drawing.renderer.takeMessages().empty());
    }
}

/// Whoever drags through time sees each from coarse samples, and starts no reading of all while another goes on.
TEST_F(CoarseSamplesGl, OneTimeIsReadAtATime) {
    CoarseDrawing drawing(volume::LatticeKind::CC, 0);
    drawing.source->hold(true);
    const auto drawnCoarse = [](const FrameStatus& status) { return status.bricksMissing > 0 && status.waits; };
    for (int time = 0; time < kHeldTimes; ++time) {
        drawing.scene.time = time;
        drawing.until(drawnCoarse);
        for (int i = 0; i < 20000 && drawing.source->fineTimes().empty(); ++i) drawing.frame();
        for (int i = 0; i < 60; ++i) drawing.frame();
        EXPECT_EQ(drawing.source->fineTimes(), std::set<int>{0}) << time;
    }
    drawing.source->hold(false);
    EXPECT_EQ(drawing.until(isComplete).samples, drawing.source->grid().lattice.count());
    EXPECT_EQ(drawing.source->fineTimes(), (std::set<int>{0, kHeldTimes - 1})) << "those passed meanwhile are not read";
}

/// Coarse samples are waited for, all of them are read behind whatever else there is to do.
TEST_F(CoarseSamplesGl, AllAreReadBehindOtherWork) {
    CoarseDrawing drawing(volume::LatticeKind::CC, 0);
    drawing.until(isComplete);
    EXPECT_EQ(drawing.source->highestOfCoarse(), ownNiceness());
    EXPECT_EQ(drawing.source->lowestOfFine(), std::max(ownNiceness(), 10));
}

/// Data that need no coarse samples, opened while those of others are shown.
TEST_F(CoarseSamplesGl, AreNotThoseOfTheDataBefore) {
    CoarseDrawing drawing(volume::LatticeKind::CC, 0);
    drawing.source->hold(true);
    drawing.until([](const FrameStatus& status) { return status.bricksMissing > 0 && status.waits; });
    const auto small = std::make_shared<HeldBack>(glm::ivec3(30, 20, 25));
    small->hold(true);
    drawing.renderer.setSource(small);
    const std::size_t read = drawing.source->fine();
    drawing.source->hold(false); // what is being read of them is given up
    const FrameStatus status = drawing.frame();
    EXPECT_FALSE(status.complete);
    EXPECT_EQ(status.bricksMissing, 0);
    EXPECT_LT(drawing.source->fine() - read, drawing.source->grid().brickCount());
    small->hold(false);
    EXPECT_EQ(drawing.until(isComplete).samples, 30u * 20 * 25);
    EXPECT_LT(rmsApart(drawing.shown(), drawing.waited()), 1e-6);
}

TEST_F(CoarseSamplesGl, OpenGlSaysWhenSamplesAreThere) {
    CoarseDrawing drawing(volume::LatticeKind::CC, 0);
    drawing.scene.render.engine = Engine::OpenGl;
    drawing.until(isComplete);
    EXPECT_GT(drawing.arrivals, 0);
}

/// Coarse samples of what is asked for replace a picture at once, and all of them these: nothing coarse stays.
TEST_F(CoarseSamplesGl, ReplaceAPictureUntilAllAreRead) {
    CoarseDrawing drawing(volume::LatticeKind::CC, 1e9);
    drawing.until(isComplete);
    const std::vector<glm::vec4> before = drawing.shown();
    drawing.source->hold(true);
    drawing.scene.time = 1;
    const FrameStatus first = drawing.until(isCurrent);
    EXPECT_GT(first.bricksMissing, 0);
    EXPECT_FALSE(first.complete);
    EXPECT_GT(rmsApart(before, drawing.shown()), 1e-4) << "of the other time";
    drawing.source->hold(false);
    EXPECT_EQ(drawing.until(isComplete).bricksMissing, 0);
    EXPECT_LT(rmsApart(drawing.shown(), drawing.waited()), 1e-6);
    drawing.scene.time = 0;
    EXPECT_EQ(drawing.until(isComplete).bricksMissing, 0);
    EXPECT_LT(rmsApart(drawing.shown(), before), 1e-6) << "the samples of the first time again";
}

} // namespace
} // namespace tessera::vis
