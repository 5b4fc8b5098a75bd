#include "tests/vis/function_source.h"
#include "tests/vis/gl_fixture.h"

#include "vis/model/ray_setup.h"
#include "vis/reference/raycast.h"
#include "volume/error.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

namespace tessera {
namespace {

using vis::Scene;

vis::RendererOptions exact() {
    vis::RendererOptions options;
    options.exactTextures = true;
    return options;
}

/// One composite layer of channel "v" with a constant opacity over the range 0..1.
Scene flatScene(float opacity) {
    Scene scene;
    scene.camera = test::frontCamera();
    vis::VolumeLayer layer;
    layer.channel = "v";
    layer.shaded = false;
    scene.layers.push_back({"volume", true, layer});
    vis::TransferFunction function;
    function.autoRange = false;
    function.range = {0, 1};
    function.opacity = {{0, opacity}, {1, opacity}};
    scene.transfer["v"] = function;
    scene.showBox = false;
    scene.render.samples = 1;
    return scene;
}

class RendererTest : public test::GlTest {};

TEST_F(RendererTest, NothingLoadedIsBackground) {
    vis::Renderer renderer;
    const vis::ViewTargetPtr target = renderer.makeTarget();
    Scene scene;
    test::renderAll(renderer, *target, scene, {5, 3});
    glm::ivec2 size;
    const std::vector<std::uint8_t> pixels = renderer.readPixels(*target, size);
    ASSERT_EQ(size, glm::ivec2(5, 3));
    ASSERT_EQ(pixels.size(), 60u);
    EXPECT_NEAR(pixels[0], scene.background.r * 255, 1);
    EXPECT_EQ(pixels[3], 255);
    EXPECT_FALSE(renderer.pick(*target, {2, 1}));
}

// A medium of constant density in a box of depth L has opacity 1 - (1 - a)^(L / reference).
TEST_F(RendererTest, FurnaceOpacityIsExponential) {
    for (const volume::LatticeKind lattice : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
        vis::Renderer renderer(exact());
        renderer.setSource(std::make_shared<vis::FunctionSource>(
            lattice, glm::ivec3(17, 17, 9), glm::dvec3(1),
            std::vector<vis::FunctionSource::Channel>{{"v", [](glm::dvec3) { return 0.5; }}}));
        const vis::ViewTargetPtr target = renderer.makeTarget();
        for (const float opacity : {0.001f, 0.01f, 0.1f}) {
            const Scene scene = flatScene(opacity);
            test::renderAll(renderer, *target, scene, {33, 33});
            const glm::vec4 middle = renderer.readLinear(*target)[16 * 33 + 16];
            const double expected = 1 - std::pow(1 - double(opacity), 0.5 / vis::kReferenceLength);
            EXPECT_NEAR(middle.a, expected, 2e-5 + (expected > 0.99 ? 0.005 : 0)) << opacity;
            const glm::dvec3 color =
                vis::linearFromSrgb(glm::dvec3(vis::evaluate(scene.transfer.at("v"), {0, 1}, 0.5)));
            EXPECT_NEAR(middle.r / middle.a, color.r, 1e-4);
            EXPECT_NEAR(middle.b / middle.a, color.b, 1e-4);
        }
        EXPECT_TRUE(renderer.takeMessages().empty());
    }
}

/// A smooth field that is absent in a corner, a label, and a field everywhere; many small bricks.
std::shared_ptr<vis::FunctionSource> brickedSource(volume::LatticeKind kind) {
    const auto v = [](glm::dvec3 p) -> std::optional<double> {
        if (p.x + p.y + p.z < 13) return std::nullopt;
        return 0.5 + 0.4 * std::sin(0.5 * p.x) * std::cos(0.4 * p.y + 0.3 * p.z);
    };
    const auto w = [](glm::dvec3 p) -> std::optional<double> { return p.x * 0.04 - p.z * 0.01; };
    const auto label = [](glm::dvec3 p) -> std::optional<double> { return p.y > 12 ? 2 : 1; };
    return std::make_shared<vis::FunctionSource>(
        kind, glm::ivec3(29, 25, 37), glm::dvec3(1),
        std::vector<vis::FunctionSource::Channel>{{"v", v}, {"w", w}, {"label", label, {1, 2}, true}});
}

Scene richScene() {
    Scene scene = flatScene(0.1f);
    scene.camera = {};
    scene.camera.distance = 1.8f;
    scene.transfer["v"].opacity = {{0, 0}, {0.3f, 0}, {0.5f, 0.3f}, {1, 0.6f}};
    std::get<vis::VolumeLayer>(scene.layers[0].technique).shaded = true;
    scene.layers.push_back({"iso", true, vis::IsoLayer{.channel = "w", .value = 0.35, .opacity = 0.5f}});
    scene.layers.push_back({"slice", true, vis::SliceLayer{.channel = "label", .atCursor = false, .position = 0.3}});
    scene.selection.brushes = {vis::rangeBrush({{"w", 0.2, 0.9, 0.1}})};
    return scene;
}

using test::picture;

// Bricks of 8 texels in an atlas and one texture of the whole give the same picture: no seams, right page table.
TEST_F(RendererTest, BricksAndOneTextureAgree) {
    const struct {
        volume::LatticeKind kind;
        vis::Filter filter;
        bool exact;
    } cases[] = {{volume::LatticeKind::CC, vis::Filter::AverageQuasi, true},
                 {volume::LatticeKind::BCC, vis::Filter::Tetrahedral, true},
                 {volume::LatticeKind::BCC, vis::Filter::AverageQuasi, false}};
    for (const auto& test : cases) {
        SCOPED_TRACE(std::to_string(int(test.kind)) + " " + std::to_string(int(test.filter)));
        Scene scene = richScene();
        scene.render.filter = test.filter;
        vis::RendererOptions whole, bricks;
        whole.exactTextures = bricks.exactTextures = test.exact;
        bricks.denseTexels = 0;
        EXPECT_LT(test::maxDifference(picture(brickedSource(test.kind), whole, scene),
                                      picture(brickedSource(test.kind), bricks, scene)),
                  test.exact ? 2e-4 : 1.0 / 255);
    }
}

// A finished still stays while the linked cursor moves, unless something drawn moves with it.
TEST_F(RendererTest, TheCursorAloneCostsNothing) {
    vis::Renderer renderer;
    renderer.setSource(brickedSource(volume::LatticeKind::BCC));
    const vis::ViewTargetPtr target = renderer.makeTarget();
    Scene scene = richScene();
    scene.render.samples = 16; // never done within a frame
    std::erase_if(scene.layers,
                  [](const vis::Layer& layer) { return std::holds_alternative<vis::SliceLayer>(layer.technique); });
    const vis::FrameRequest quick{.size = {48, 40}, .budgetMs = 0.001};
    const auto staysAsItIs = [&](const Scene& shown) {
        test::renderAll(renderer, *target, shown, quick.size);
        Scene moved = shown;
        moved.cursor += 0.1;
        return renderer.render(*target, moved, quick).complete;
    };
    EXPECT_TRUE(staysAsItIs(scene));
    Scene lens = scene;
    lens.lenses = {{.name = "here", .followsCursor = true}};
    EXPECT_FALSE(staysAsItIs(lens));
    scene.layers.push_back({"slice", true, vis::SliceLayer{.channel = "w"}});
    EXPECT_FALSE(staysAsItIs(scene));
    scene.layers.back().visible = false;
    EXPECT_TRUE(staysAsItIs(scene));
}

// A budget for a handful of bricks does not change a picture that is waited for.
TEST_F(RendererTest, TinyBudgetStillCompletes) {
    const auto source = brickedSource(volume::LatticeKind::BCC);
    vis::RendererOptions tiny;
    tiny.denseTexels = 0;
    tiny.textureBudget = 1;
    tiny.memoryBudget = 1;
    EXPECT_LT(test::maxDifference(picture(source, {}, richScene()), picture(source, tiny, richScene())), 1.0 / 255);
}

/// Another source's bricks, after asking `check`.
class CheckedSource : public volume::BrickSource {
public:
    CheckedSource(std::shared_ptr<const volume::BrickSource> source, std::function<void(const volume::BrickKey&)> check)
        : source_(std::move(source)), check_(std::move(check)) {}
    const volume::DatasetInfo& info() const override { return source_->info(); }
    const volume::BrickGrid& grid() const override { return source_->grid(); }
    volume::BrickStats stats(const volume::BrickKey& key) const override { return source_->stats(key); }
    volume::BrickSamples read(const volume::BrickKey& key) const override {
        check_(key);
        return source_->read(key);
    }

private:
    std::shared_ptr<const volume::BrickSource> source_;
    std::function<void(const volume::BrickKey&)> check_;
};

// A damaged brick is absent, the others are drawn, and the log says so.
TEST_F(RendererTest, DamagedBrickIsLeftOut) {
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
TEST_F(RendererTest, CoarseLevelsLieWhereFineOnesDo) {
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
        for (int i = 0; i < 2000 && (coarse.empty() || coarse[16 * 32 + 16].a == 0); ++i) {
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

// Frames of a small budget lead to the picture that waiting gives, by way of presentable ones.
TEST_F(RendererTest, RefinesToTheSamePicture) {
    vis::Renderer renderer;
    renderer.setSource(brickedSource(volume::LatticeKind::BCC));
    const vis::ViewTargetPtr waited = renderer.makeTarget(), refined = renderer.makeTarget();
    const Scene scene = richScene();
    const glm::ivec2 size(150, 90);
    test::renderAll(renderer, *waited, scene, size);
    vis::FrameRequest request;
    request.size = size;
    request.budgetMs = 0.5;
    request.moving = true;
    vis::FrameStatus status = renderer.render(*refined, scene, request);
    EXPECT_NE(status.texture, 0u);
    glm::ivec2 got;
    const std::vector<std::uint8_t> first = renderer.readPixels(*refined, got);
    EXPECT_EQ(got, size);
    EXPECT_GT(*std::max_element(first.begin(), first.begin() + 4 * 150 * 45), 60);
    request.moving = false;
    int frames = 0;
    while (!status.complete && ++frames < 1000) status = renderer.render(*refined, scene, request);
    EXPECT_TRUE(status.complete);
    EXPECT_EQ(test::maxDifference(renderer.readLinear(*waited), renderer.readLinear(*refined)), 0);
    // Nothing left to do: the same texture, at once.
    EXPECT_EQ(renderer.render(*refined, scene, request).texture, status.texture);
}

// Leaping over empty blocks changes nothing: a sparse volume, against the reference that visits every sample.
TEST_F(RendererTest, EmptySpaceIsSkippedExactly) {
    for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
        const auto shells = [](glm::dvec3 p) -> std::optional<double> {
            if (p.z > 40) return std::nullopt;
            const double r = glm::length(p - glm::dvec3(20, 22, 26));
            return r < 15 ? 1 / (1 + 0.05 * (r - 9) * (r - 9)) : 0.2 / (1 + 0.3 * (r - 15));
        };
        const auto source = std::make_shared<vis::FunctionSource>(
            kind, glm::ivec3(61, 47, 53), glm::dvec3(1), std::vector<vis::FunctionSource::Channel>{{"v", shells}}, 16);
        Scene scene = flatScene(0);
        scene.camera = {};
        scene.camera.distance = 1.7f;
        scene.transfer["v"].opacity = {{0, 0}, {0.85f, 0}, {0.95f, 0.5f}, {1, 0.8f}};
        for (const bool shaded : {false, true}) {
            std::get<vis::VolumeLayer>(scene.layers[0].technique).shaded = shaded;
            if (shaded) {
                scene.layers.push_back({"iso", true, vis::IsoLayer{.channel = "v", .value = 0.7, .opacity = 0.5f}});
                scene.layers.push_back(
                    {"slice", true,
                     vis::SliceLayer{.channel = "v", .atCursor = false, .position = 0.6, .opacity = 0.5f}});
            }
            const glm::ivec2 size(56, 44);
            vis::reference::Image drawn{size, {}};
            for (const glm::vec4& pixel : picture(source, exact(), scene, size)) drawn.pixels.emplace_back(pixel);
            const vis::reference::Difference difference =
                vis::reference::compare(drawn, vis::reference::render(scene, *source, size), 2e-3);
            EXPECT_LT(difference.rmseWithin, 2e-5);
            EXPECT_LE(difference.beyond, 8u) << difference.worst.x << ", " << difference.worst.y;
        }
    }
}

// Where a brush leaves nothing and the rest is hidden, blocks are leapt over, and nothing changes.
TEST_F(RendererTest, WhatBrushesHideIsSkippedExactly) {
    const auto ramp = [](glm::dvec3 p) -> std::optional<double> { return p.x / 60; };
    const auto waves = [](glm::dvec3 p) -> std::optional<double> {
        if (p.y > 40) return std::nullopt;
        return 0.5 + 0.5 * std::sin(0.3 * p.x) * std::sin(0.25 * p.z);
    };
    for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
        const auto source = std::make_shared<vis::FunctionSource>(
            kind, glm::ivec3(61, 47, 53), glm::dvec3(1),
            std::vector<vis::FunctionSource::Channel>{{"v", ramp}, {"w", waves}}, 16);
        Scene scene = flatScene(0);
        scene.camera = {};
        scene.camera.distance = 1.7f;
        scene.transfer["v"].opacity = {{0, 0.2f}, {1, 0.2f}};
        scene.selection.contextOpacity = 0;
        scene.selection.brushes = {vis::rangeBrush({{"w", 0.94, 1, 0.02}}), vis::rangeBrush({{"v", 0.3, 0.6, 0.05}})};
        for (const bool outside : {false, true}) {
            scene.selection.brushes[1].inverted = outside;
            const glm::ivec2 size(56, 44);
            vis::reference::Image drawn{size, {}};
            double seen = 0;
            for (const glm::vec4& pixel : picture(source, exact(), scene, size)) {
                drawn.pixels.emplace_back(pixel);
                seen += double(pixel.a);
            }
            EXPECT_GT(seen, 10);
            const vis::reference::Difference difference =
                vis::reference::compare(drawn, vis::reference::render(scene, *source, size), 2e-3);
            EXPECT_LT(difference.rmseWithin, 2e-5);
            EXPECT_LE(difference.beyond, 8u) << difference.worst.x << ", " << difference.worst.y;
            vis::RendererOptions counting = exact();
            counting.countSamples = true;
            const auto samples = [&](const Scene& counted) {
                double sum = 0;
                for (const glm::vec4& pixel : picture(source, counting, counted, size)) sum += double(pixel.r);
                return sum;
            };
            Scene all = scene;
            all.selection.contextOpacity = 0.001f;
            EXPECT_LT(samples(scene), 0.9 * samples(all)) << "it leaps";
        }
    }
}

// While the bricks of the next time are on their way the former time stays on screen.
TEST_F(RendererTest, FormerTimeStaysUntilTheNextIsThere) {
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
TEST_F(RendererTest, ChannelThatFailsIsLeftOut) {
    class Failing : public CheckedSource {
    public:
        using CheckedSource::CheckedSource;
        volume::BrickStats stats(const volume::BrickKey& key) const override {
            if (key.channel == 1) throw Error("no such frame", "cell.pvd");
            return CheckedSource::stats(key);
        }
    };
    const auto source =
        std::make_shared<Failing>(brickedSource(volume::LatticeKind::CC), [](const volume::BrickKey&) {});
    vis::Renderer renderer;
    renderer.setSource(source);
    const vis::ViewTargetPtr target = renderer.makeTarget();
    test::renderAll(renderer, *target, richScene(), {32, 32});
    EXPECT_GT(renderer.readLinear(*target)[16 * 32 + 16].a, 0.01);
    const std::vector<std::string> messages = renderer.takeMessages();
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_EQ(messages[0], "w cannot be shown: cell.pvd: no such frame");
}

TEST_F(RendererTest, PickFindsTheSurface) {
    const auto ball = std::make_shared<vis::FunctionSource>(
        volume::LatticeKind::CC, glm::ivec3(33), glm::dvec3(1),
        std::vector<vis::FunctionSource::Channel>{
            {"v", [](glm::dvec3 p) { return glm::length(p - 16.0) / 16; }, {0, 1.8}}});
    vis::Renderer renderer;
    renderer.setSource(ball);
    const vis::ViewTargetPtr target = renderer.makeTarget();
    Scene scene = flatScene(0);
    scene.layers = {{"iso", true, vis::IsoLayer{.channel = "v", .value = 0.5}}};
    test::renderAll(renderer, *target, scene, {65, 65});
    const std::optional<vis::Pick> hit = renderer.pick(*target, {32, 32});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->position.x, 16, 0.05);
    EXPECT_NEAR(hit->position.y, 16, 0.05);
    EXPECT_NEAR(hit->position.z, 24, 0.05);
    // y counts down: above the middle lies greater y.
    const std::optional<vis::Pick> above = renderer.pick(*target, {32, 22});
    ASSERT_TRUE(above);
    EXPECT_GT(above->position.y, 20);
    EXPECT_FALSE(renderer.pick(*target, {1, 1}));
    EXPECT_FALSE(renderer.pick(*target, {-1, 70}));
}

TEST_F(RendererTest, LeavesTheCallersStateAlone) {
    vis::Renderer renderer;
    renderer.setSource(brickedSource(volume::LatticeKind::CC));
    const vis::ViewTargetPtr target = renderer.makeTarget();
    GLuint mine = 0;
    glCreateFramebuffers(1, &mine);
    glBindFramebuffer(GL_FRAMEBUFFER, mine);
    glViewport(1, 2, 3, 4);
    test::renderAll(renderer, *target, richScene(), {20, 10});
    GLint framebuffer = 0, viewport[4];
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
    glGetIntegerv(GL_VIEWPORT, viewport);
    EXPECT_EQ(GLuint(framebuffer), mine);
    EXPECT_EQ(viewport[0] * 1000 + viewport[1] * 100 + viewport[2] * 10 + viewport[3], 1234);
    glDeleteFramebuffers(1, &mine);
}

TEST_F(RendererTest, EmptySizesAndUnknownChannels) {
    vis::Renderer renderer;
    renderer.setSource(brickedSource(volume::LatticeKind::CC));
    const vis::ViewTargetPtr target = renderer.makeTarget();
    vis::FrameRequest request;
    request.wait = true;
    for (const glm::ivec2 size : {glm::ivec2(0, 5), glm::ivec2(5, 0), glm::ivec2(1, 1), glm::ivec2(3, 200)}) {
        request.size = size;
        EXPECT_TRUE(renderer.render(*target, richScene(), request).complete);
    }
    Scene scene = flatScene(0.5f);
    std::get<vis::VolumeLayer>(scene.layers[0].technique).channel = "no such";
    test::renderAll(renderer, *target, scene, {8, 8});
    EXPECT_EQ(renderer.readLinear(*target)[0].a, 0);
    renderer.setSource(nullptr);
    test::renderAll(renderer, *target, richScene(), {8, 8});
    EXPECT_EQ(renderer.readLinear(*target)[36].a, 0);
}

TEST_F(RendererTest, SaysWhichLightsAndClipsAreLeftOut) {
    vis::Renderer renderer;
    renderer.setSource(std::make_shared<vis::FunctionSource>(
        volume::LatticeKind::CC, glm::ivec3(9), glm::dvec3(1),
        std::vector<vis::FunctionSource::Channel>{{"v", [](glm::dvec3) { return 0.5; }}}));
    const vis::ViewTargetPtr target = renderer.makeTarget();
    Scene scene = flatScene(0.1f);
    scene.lighting.lights.resize(20);
    scene.clips.resize(9);
    test::renderAll(renderer, *target, scene, {8, 8});
    const std::vector<std::string> said = renderer.takeMessages();
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("first 16 lights"), std::string::npos) << said[0];
    EXPECT_NE(said[0].find("first 8 clips"), std::string::npos) << said[0];
    scene.time = 1;
    test::renderAll(renderer, *target, scene, {8, 8});
    EXPECT_TRUE(renderer.takeMessages().empty()) << "said once";
}

} // namespace
} // namespace tessera
