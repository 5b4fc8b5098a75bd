#include "tests/vis/function_source.h"
#include "tests/vis/gl_fixture.h"

#include "vis/model/ray_setup.h"

#include <cmath>

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

} // namespace
} // namespace tessera
