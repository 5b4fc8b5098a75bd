#include "tests/vis/raycast_compare.h"
#include "tests/vis/shader_probe.h"
#include "vis/formulas/context_blur.h"

#include <glm/geometric.hpp>

/// What is not brushed out of focus: shader against reference, and what must hold by itself.
namespace tessera::vis {
namespace {

using BlurLib = test::ShaderProbe;

TEST_F(BlurLib, TapsAndSharesAreAlike) {
    const auto got = evaluate("#include \"formulas/context_blur.glsl\"\n",
                              "vec4(blurTap(i / 2), blurShare(abs(a[i].x), 4.0 * abs(a[i].y), 5.0), 0.0)");
    for (int i = 0; i < kCases; ++i) {
        const glm::dvec2 tap = blurTap<double>(i / 2);
        EXPECT_NEAR(got[i].x, tap.x, 2e-5);
        EXPECT_NEAR(got[i].y, tap.y, 2e-5);
        EXPECT_LE(glm::length(tap), 1);
        EXPECT_NEAR(got[i].z, blurShare<double>(std::abs(double(a[i].x)), 4 * std::abs(double(a[i].y)), 5), 1e-5);
    }
}

class ContextBlur : public testing::TestWithParam<Case> {
protected:
    HeadlessContext context;

    /// sRGB bytes of the finished picture, rows top down.
    std::vector<std::uint8_t> shown(Drawing& drawing, const Scene& scene) {
        const ViewTargetPtr target = drawing.renderer.makeTarget();
        FrameRequest request;
        request.size = kSize;
        request.wait = true;
        EXPECT_TRUE(drawing.renderer.render(*target, scene, request).complete);
        glm::ivec2 size;
        return drawing.renderer.readPixels(*target, size);
    }
};

INSTANTIATE_TEST_SUITE_P(Lattices, ContextBlur,
                         testing::Values(Case{LatticeKind::CC, false}, Case{LatticeKind::BCC, true}),
                         [](const auto& each) { return each.param.name(); });

TEST_P(ContextBlur, AgreesWithTheReferenceAndLeavesTheFocus) {
    Drawing drawing(GetParam().kind, GetParam().masked, true);
    for (const bool slices : {false, true}) {
        Scene scene = baseScene(true);
        scene.layers = {{"", true, VolumeLayer{.channel = "a", .density = 3}},
                        {"", true, IsoLayer{.channel = "b", .value = 0.55, .opacity = 0.7f}}};
        if (slices) scene.layers.push_back({"", true, SliceLayer{.channel = "a", .orientation = SliceOrientation::Y}});
        scene.selection.brushes = {{.region = BoxRegion{scene.cursor, glm::dvec3(5, 4, 6), 0.2}}};
        scene.selection.contextOpacity = 0.5f;
        const std::vector<std::uint8_t> sharp = shown(drawing, scene);
        scene.selection.contextBlur = 0.06f;
        const std::vector<std::uint8_t> got = shown(drawing, scene);
        const Linear truth = drawing.truth(scene);
        const Linear wanted = reference::outOfFocus(truth, double(scene.selection.contextBlur) * kSize.y);
        int beyond = 0, moved = 0;
        double squares = 0;
        for (std::size_t i = 0; i < wanted.pixels.size(); ++i) {
            const glm::dvec4 pixel = wanted.pixels[i];
            const glm::dvec3 behind = linearFromSrgb(glm::dvec3(scene.background));
            const glm::dvec3 color = glm::dvec3(pixel) + (1 - pixel.a) * behind;
            for (int k = 0; k < 3; ++k) {
                const double away =
                    double(got[4 * i + std::size_t(k)]) - 255 * srgbFromLinear(std::clamp(color[k], 0.0, 1.0));
                squares += away * away / double(3 * wanted.pixels.size());
                beyond += std::abs(away) > 3 ? 1 : 0;
                const int change = std::abs(int(got[4 * i + std::size_t(k)]) - int(sharp[4 * i + std::size_t(k)]));
                moved += change > 2 ? 1 : 0;
                EXPECT_TRUE(truth.interest[i] < 0.999 || change <= 1) << i << ": the focus is not sharp";
            }
        }
        EXPECT_LT(std::sqrt(squares), 0.6) << slices;
        EXPECT_LE(beyond, 24) << slices;
        EXPECT_GT(moved, 1000) << "nothing is out of focus";
    }
}

TEST(ContextBlurReference, KeepsEvenPicturesAndSpreadsNoFocus) {
    reference::Image image{{20, 20}, std::vector<glm::dvec4>(400, {0.2, 0.3, 0.4, 0.5}), std::vector<double>(400, 0)};
    for (const glm::dvec4& pixel : reference::outOfFocus(image, 4).pixels) EXPECT_NEAR(pixel.g, 0.3, 1e-12);
    image.pixels[210] = {1, 1, 1, 1};
    image.interest[210] = 1;
    const reference::Image out = reference::outOfFocus(image, 4);
    EXPECT_EQ(out.pixels[210].r, 1);
    // Only what linear interpolation beside the pixel takes of it.
    double light = 0;
    for (std::size_t i = 0; i < 400; ++i) light += i == 210 ? 0 : out.pixels[i].r - 0.2;
    EXPECT_LT(light, 1.5);
}

// What is out of focus is spread as far to either side, up to the edges of a picture of any shape.
TEST(ContextBlurReference, SpreadsAlikeInPicturesOfAnyShape) {
    const auto spread = [](glm::ivec2 size, glm::ivec2 at) {
        const std::size_t count = std::size_t(size.x) * std::size_t(size.y);
        reference::Image image{size, std::vector<glm::dvec4>(count, glm::dvec4(0)), std::vector<double>(count, 0)};
        image.pixels[std::size_t(at.y * size.x + at.x)] = glm::dvec4(1);
        return reference::outOfFocus(image, 3).pixels;
    };
    const std::vector<glm::dvec4> square = spread({40, 40}, {20, 20}), wide = spread({40, 9}, {20, 4}),
                                  tall = spread({9, 40}, {4, 20});
    double seen = 0;
    for (int across = 2; across < 7; ++across) // the rest reads beyond the narrow edges
        for (int along = 0; along < 40; ++along) {
            const auto at = [&](int x, int y) { return square[std::size_t(y * 40 + x)].r; };
            EXPECT_NEAR(wide[std::size_t(across * 40 + along)].r, at(along, across + 16), 1e-12);
            EXPECT_NEAR(tall[std::size_t(along * 9 + across)].r, at(across + 16, along), 1e-12);
            seen += at(along, across + 16);
        }
    EXPECT_GT(seen, 0.5);
}

} // namespace
} // namespace tessera::vis
