#include "tests/vis/renderer_scenes.h"

#include "vis/optics/ray_setup.h"
#include "vis/scene/tone.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <thread>

namespace tessera {
namespace {

using test::brickedSource, test::exact, test::flatScene, test::picture, test::richScene;
using vis::Scene;

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

TEST_F(RendererTest, LightIsMappedToTheScreenByItsCurve) {
    vis::Renderer renderer(exact());
    renderer.setSource(std::make_shared<vis::FunctionSource>(
        volume::LatticeKind::CC, glm::ivec3(9), glm::dvec3(1),
        std::vector<vis::FunctionSource::Channel>{{"v", [](glm::dvec3) { return 0.5; }}}));
    const vis::ViewTargetPtr target = renderer.makeTarget();
    Scene scene = flatScene(0.9f);
    for (const vis::ToneCurve curve : {vis::ToneCurve::None, vis::ToneCurve::Reinhard, vis::ToneCurve::Filmic})
        for (const float exposure : {-1.5f, 0.0f, 1.0f}) {
            scene.tone = {.curve = curve, .exposure = exposure, .white = 2};
            test::renderAll(renderer, *target, scene, {17, 17});
            const glm::dvec4 light(renderer.readLinear(*target)[8 * 17 + 8]);
            ASSERT_GT(light.a, 0.999);
            glm::ivec2 size;
            const std::vector<std::uint8_t> shown = renderer.readPixels(*target, size);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(
                    shown[std::size_t(4 * (8 * 17 + 8) + c)],
                    255 * vis::srgbFromLinear(glm::clamp(vis::toneMap(glm::dvec3(light), scene.tone)[c], 0.0, 1.0)), 1)
                    << int(curve) << ' ' << exposure << ' ' << c;
        }
}

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
    while (!status.complete && ++frames < 20000) {
        status = renderer.render(*refined, scene, request);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(status.complete);
    EXPECT_EQ(test::maxDifference(renderer.readLinear(*waited), renderer.readLinear(*refined)), 0);
    // Nothing left to do: the same texture, at once.
    EXPECT_EQ(renderer.render(*refined, scene, request).texture, status.texture);
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

// A picture that the driver refuses: the former one stays and a message says so, once; who waits is told by an
// exception.
TEST_F(RendererTest, APictureTooLargeIsRefused) {
    vis::Renderer renderer;
    renderer.setSource(brickedSource(volume::LatticeKind::CC));
    const vis::ViewTargetPtr target = renderer.makeTarget();
    const vis::TextureName former = test::renderAll(renderer, *target, richScene(), {20, 10}).texture;
    const std::vector<glm::vec4> pixels = renderer.readLinear(*target);
    vis::FrameRequest request;
    request.size = {1 << 20, 8};
    for (int i = 0; i < 2; ++i) EXPECT_EQ(renderer.render(*target, richScene(), request).texture, former);
    const std::vector<std::string> said = renderer.takeMessages();
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("1048576 x 8"), std::string::npos) << said[0];
    EXPECT_EQ(renderer.readLinear(*target), pixels);
    request.wait = true;
    EXPECT_THROW(renderer.render(*target, richScene(), request), MachineError);
    EXPECT_EQ(test::renderAll(renderer, *target, richScene(), {20, 10}).texture, former);
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
