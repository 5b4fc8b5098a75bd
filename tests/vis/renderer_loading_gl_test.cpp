#include "tests/vis/renderer_scenes.h"

#include "volume/base/error.h"

#include <algorithm>
#include <atomic>
#include <thread>

namespace tessera {
namespace {

using test::brickedSource, test::CheckedSource, test::exact, test::flatScene, test::picture, test::richScene;
using vis::Scene;

class RendererLoading : public test::GlTest {};

// A budget for a handful of bricks does not change a picture that is waited for.
TEST_F(RendererLoading, TinyBudgetStillCompletes) {
    const auto source = brickedSource(volume::LatticeKind::BCC);
    vis::RendererOptions tiny;
    tiny.denseTexels = 0;
    tiny.textureBudget = 1;
    tiny.memoryBudget = 1;
    EXPECT_LT(test::maxDifference(picture(source, {}, richScene()), picture(source, tiny, richScene())), 1.0 / 255);
}

// A damaged brick is absent, the others are drawn, and the log says so.
TEST_F(RendererLoading, DamagedBrickIsLeftOut) {
    const auto flat = std::make_shared<vis::FunctionSource>(
        volume::LatticeKind::CC, glm::ivec3(32, 16, 16), glm::dvec3(1),
        std::vector<vis::FunctionSource::Channel>{{"v", [](glm::dvec3) { return 0.5; }}});
    const auto damaged = std::make_shared<CheckedSource>(flat, [](const volume::BrickKey& key) {
        if (key.index.x == 0) throw Error("checksum does not match", "cell.tsr", "brick 0");
    });
    for (const std::size_t dense : {std::size_t(0), std::size_t(1) << 20}) {
        vis::RendererOptions options;
        options.denseTexels = dense;
        vis::Renderer renderer(options);
        renderer.setSource(damaged);
        const vis::ViewTargetPtr target = renderer.makeTarget();
        test::renderAll(renderer, *target, flatScene(0.5f), {64, 64});
        const std::vector<glm::vec4> pixels = renderer.readLinear(*target);
        EXPECT_EQ(pixels[32 * 64 + 4].a, 0);
        EXPECT_GT(pixels[32 * 64 + 50].a, 0.99);
        const std::vector<std::string> messages = renderer.takeMessages();
        ASSERT_FALSE(messages.empty());
        EXPECT_NE(messages[0].find("checksum does not match"), std::string::npos);
    }
}

// While fine bricks are not there a coarse level shows, in the right place: a linear field looks the same at any level.
TEST_F(RendererLoading, CoarseLevelsLieWhereFineOnesDo) {
    for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
        const auto linear = std::make_shared<vis::FunctionSource>(
            kind, glm::ivec3(33, 33, 33), glm::dvec3(1),
            std::vector<vis::FunctionSource::Channel>{{"v", [](glm::dvec3 p) { return (p.x + p.y) / 64; }}});
        std::atomic<bool> open = false;
        const auto slow = std::make_shared<CheckedSource>(linear, [&](const volume::BrickKey& key) {
            while (key.level == 0 && !open) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        });
        Scene scene = flatScene(1);
        scene.layers = {{"slice", true, vis::SliceLayer{.channel = "v", .atCursor = false, .position = 0.5}}};
        vis::RendererOptions options = exact();
        options.denseTexels = 0;
        vis::Renderer renderer(options);
        renderer.setSource(slow);
        const vis::ViewTargetPtr target = renderer.makeTarget();
        vis::FrameRequest request;
        request.size = {32, 32};
        std::vector<glm::vec4> coarse;
        for (int i = 0; i < 20000 && (coarse.empty() || coarse[16 * 32 + 16].a == 0); ++i) {
            const vis::FrameStatus status = renderer.render(*target, scene, request);
            EXPECT_FALSE(status.complete);
            EXPECT_GT(status.bricksMissing, 0);
            coarse = renderer.readLinear(*target);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        open = true;
        test::renderAll(renderer, *target, scene, request.size);
        const std::vector<glm::vec4> fine = renderer.readLinear(*target);
        double worst = 0; // away from the edges, where coarse levels repeat their last sample
        for (int y = 10; y < 22; ++y)
            for (int x = 10; x < 22; ++x)
                worst = std::max(worst, double(glm::length(coarse[y * 32 + x] - fine[y * 32 + x])));
        EXPECT_LT(worst, 2e-3);
        EXPECT_NEAR(fine[16 * 32 + 16].a, 1, 1e-6);
    }
}

// While the bricks of the next time are on their way the former time stays on screen.
TEST_F(RendererLoading, FormerTimeStaysUntilTheNextIsThere) {
    class TwoTimes : public CheckedSource {
    public:
        using CheckedSource::CheckedSource;
        const volume::DatasetInfo& info() const override { return info_; }
        volume::DatasetInfo info_;
    };
    const auto flat = std::make_shared<vis::FunctionSource>(
        volume::LatticeKind::CC, glm::ivec3(8), glm::dvec3(1),
        std::vector<vis::FunctionSource::Channel>{{"v", [](glm::dvec3) { return 0.5; }}});
    std::atomic<bool> open = false;
    const auto source = std::make_shared<TwoTimes>(flat, [&](const volume::BrickKey& key) {
        while (key.time == 1 && !open) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
    source->info_ = flat->info();
    source->info_.times = {0, 1};
    vis::Renderer renderer;
    renderer.setSource(source);
    const vis::ViewTargetPtr target = renderer.makeTarget();
    Scene scene = flatScene(0.5f);
    test::renderAll(renderer, *target, scene, {9, 9});
    const std::vector<glm::vec4> before = renderer.readLinear(*target);
    scene.time = 1;
    vis::FrameRequest request;
    request.size = {9, 9};
    request.budgetMs = 1000;
    for (int i = 0; i < 3; ++i) {
        const vis::FrameStatus status = renderer.render(*target, scene, request);
        EXPECT_FALSE(status.complete);
        EXPECT_EQ(test::maxDifference(renderer.readLinear(*target), before), 0);
    }
    open = true;
    test::renderAll(renderer, *target, scene, {9, 9});
}

// A channel that cannot be loaded shows nothing, the others go on, also to another time.
/// A source whose second channel cannot be read at all.
class WithoutTheSecond : public CheckedSource {
public:
    WithoutTheSecond() : CheckedSource(brickedSource(volume::LatticeKind::CC), [](const volume::BrickKey&) {}) {}
    volume::BrickStats stats(const volume::BrickKey& key) const override {
        if (key.channel == 1) throw Error("no such frame", "cell.pvd");
        return CheckedSource::stats(key);
    }
};

// What was shown gives way to the background where nothing is to be shown, or it fails, also where nobody waits.
TEST_F(RendererLoading, AFormerPictureGoesWhereNothingComes) {
    for (const bool fails : {false, true}) {
        vis::Renderer renderer;
        renderer.setSource(std::make_shared<WithoutTheSecond>());
        const vis::ViewTargetPtr target = renderer.makeTarget();
        Scene scene = test::flatScene(0.5f);
        const glm::ivec2 size(24, 20);
        test::renderAll(renderer, *target, scene, size);
        const auto background = [&] {
            glm::ivec2 got;
            const std::vector<std::uint8_t> shown = renderer.readPixels(*target, got);
            const std::size_t middle = 4 * (10 * 24 + 12);
            for (int c = 0; c < 3; ++c)
                if (std::abs(shown[middle + std::size_t(c)] - 255 * double(scene.background[c])) > 1) return false;
            return true;
        };
        EXPECT_FALSE(background());
        if (fails)
            std::get<vis::VolumeLayer>(scene.layers[0].technique).channel = "w";
        else
            scene.layers.clear();
        vis::FrameRequest request;
        request.size = size;
        for (int frame = 0; frame < 500 && !background(); ++frame) {
            renderer.render(*target, scene, request);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        EXPECT_TRUE(background()) << fails;
    }
}

TEST_F(RendererLoading, ChannelThatFailsIsLeftOut) {
    vis::Renderer renderer;
    renderer.setSource(std::make_shared<WithoutTheSecond>());
    const vis::ViewTargetPtr target = renderer.makeTarget();
    test::renderAll(renderer, *target, richScene(), {32, 32});
    EXPECT_GT(renderer.readLinear(*target)[16 * 32 + 16].a, 0.01);
    const std::vector<std::string> messages = renderer.takeMessages();
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_EQ(messages[0], "w cannot be shown: cell.pvd: no such frame");
}

} // namespace
} // namespace tessera
