#include "tests/vis/raycast_compare.h"

#include <functional>

/// Styles and classifications of volume layers against the reference: on CC and BCC, dense and in bricks, with and
/// without absent samples.
namespace tessera::vis {
namespace {

using reference::Difference;

struct StyleCase {
    LatticeKind kind;
    bool masked, bricked;
    std::string name() const {
        return std::string(volume::kLatticeNames[std::size_t(kind)]) + (masked ? "_masked" : "_whole") +
               (bricked ? "_bricked" : "");
    }
};

class RayStyles : public testing::TestWithParam<StyleCase> {
protected:
    HeadlessContext context;
    Drawing drawing{GetParam().kind, GetParam().masked, true, GetParam().bricked};

    /// The picture, after the comparison.
    Linear check(const std::string& what, const Scene& scene, double rmse = kRmse) {
        const Linear got = drawing.draw(scene), wanted = drawing.truth(scene);
        const Difference difference = reference::compare(got, wanted, kOutlier);
        double most = 0;
        for (const glm::dvec4& pixel : wanted.pixels) most = std::max(most, pixel.a);
        const std::string name = GetParam().name() + " " + what;
        EXPECT_GT(most, 0.1) << name << " shows next to nothing";
        EXPECT_TRUE(difference.rmseWithin <= rmse && difference.beyond <= kOutliers)
            << name << ": " << words(difference) << "; " << evidence(name, got, wanted);
        return got;
    }
};

INSTANTIATE_TEST_SUITE_P(Lattices, RayStyles,
                         testing::Values(StyleCase{LatticeKind::CC, false, false},
                                         StyleCase{LatticeKind::CC, true, true},
                                         StyleCase{LatticeKind::BCC, true, false},
                                         StyleCase{LatticeKind::BCC, false, true}),
                         [](const auto& each) { return each.param.name(); });

TEST_P(RayStyles, ProjectionsAgree) {
    Scene scene = baseScene(true);
    scene.transfer["a"].opacity = {{0, 0.02f}, {1, 0.01f}};
    scene.layers = {{"", true, VolumeLayer{.channel = "b", .style = RayStyle::Minimum, .density = 0.3f}},
                    {"", true, VolumeLayer{.channel = "b", .style = RayStyle::Average, .density = 0.3f}},
                    {"", true, VolumeLayer{.channel = "a", .style = RayStyle::XRay, .density = 2}},
                    {"", true, VolumeLayer{.channel = "b", .style = RayStyle::LocalMaximum, .threshold = 0.5}}};
    const std::vector<Layer> all = scene.layers;
    for (const Layer& layer : all) {
        scene.layers = {layer};
        check(std::string(kVolumeStyleNames[std::size_t(std::get<VolumeLayer>(layer.technique).style)]), scene);
    }
    scene.layers = all;
    scene.selection.brushes = {rangeBrush({{"a", 290, 340, 12}})};
    scene.selection.contextOpacity = 0.3f;
    check("brushed projections", scene);
}

TEST_P(RayStyles, GradientMagnitudeAgrees) {
    Scene scene = baseScene(false);
    scene.transfer["a"].opacity = {{0, 0}, {0.2f, 0}, {1, 0.1f}};
    scene.transfer["a"].gradientTop = 0.2f;
    scene.layers = {{"", true, VolumeLayer{.channel = "a", .quantity = Quantity::Gradient}}};
    check("gradient", scene);
    scene.transfer["b"].gradientTop = 0.1f;
    scene.layers = {{"", true, VolumeLayer{.channel = "a", .quantity = Quantity::Gradient, .shaded = false}}};
    check("gradient without shading", scene);
    scene.layers = {
        {"", true,
         VolumeLayer{.channel = "b", .style = RayStyle::Maximum, .quantity = Quantity::Gradient, .density = 0.5f}}};
    check("largest gradient", scene);
}

/// Two surfaces and a slice that long steps cross between two samples are seen in their order along the ray.
TEST_P(RayStyles, SurfacesAreCompositedInTheirOrder) {
    Scene scene = baseScene(true);
    scene.render.stepVoxels = 3;
    scene.layers = {{"", true, IsoLayer{.channel = "a", .value = 331, .color = {1, 0, 0}, .opacity = 0.5f}},
                    {"", true, IsoLayer{.channel = "a", .value = 314, .color = {0, 1, 0}, .opacity = 0.5f}},
                    {"", true, SliceLayer{.channel = "b", .opacity = 0.5f}},
                    {"", true, IsoLayer{.channel = "a", .value = 322, .color = {0, 0, 1}, .opacity = 0.5f}}};
    const Linear one = check("three surfaces", scene);
    std::swap(scene.layers[0], scene.layers[3]);
    std::swap(scene.layers[1], scene.layers[2]);
    const Difference difference = reference::compare(one, drawing.draw(scene), kOutlier);
    EXPECT_LE(difference.beyond, kOutliers) << "the order of layers does not medium: " << words(difference);
}

TEST_P(RayStyles, PreClassificationAgrees) {
    Scene scene = baseScene(true);
    scene.transfer["a"].opacity = {{0, 0}, {0.3f, 0}, {0.8f, 0.08f}, {1, 0.02f}};
    scene.layers = {{"", true, VolumeLayer{.channel = "a", .classification = Classification::Pre}}};
    check("pre", scene);
}

/// The pre-integration table is interpolated: more room than rounding needs.
constexpr double kTableRmse = 2e-4;

TEST_P(RayStyles, PreIntegrationAgrees) {
    Scene scene = baseScene(true);
    scene.transfer["a"].opacity = {{0, 0}, {0.4f, 0}, {0.5f, 0.05f}, {0.6f, 0.08f}, {0.7f, 0}};
    VolumeLayer layer{.channel = "a", .classification = Classification::PreIntegrated, .density = 2};
    scene.layers = {{"", true, layer}};
    const auto close = [&](const std::string& what) {
        const Linear got = drawing.draw(scene), wanted = drawing.truth(scene);
        const Difference difference = reference::compare(got, wanted, 0.01);
        EXPECT_TRUE(difference.rmse <= kTableRmse && difference.beyond <= kOutliers)
            << what << ": " << words(difference) << "; " << evidence(GetParam().name() + " " + what, got, wanted);
    };
    close("preintegrated, shaded");
    layer.shaded = false;
    scene.layers = {{"", true, layer}};
    scene.render.stepVoxels = 2;
    close("preintegrated, long steps");
}

TEST_P(RayStyles, RegionsAgree) {
    Scene scene = baseScene(true);
    TransferFunction& function = scene.transfer["a"];
    function.kind = TransferKind::Regions;
    function.gradientTop = 0.2f;
    function.regions = {{.shape = RegionShape::Gaussian, .centre = {0.7f, 0.4f}, .size = {0.5f, 0.9f}, .opacity = 0.1f},
                        {.shape = RegionShape::Triangle,
                         .centre = {0.4f, 0.5f},
                         .size = {0.3f, 1},
                         .opacity = 0.1f,
                         .ownColor = false}};
    scene.layers = {{"", true, VolumeLayer{.channel = "a"}}};
    const Linear got = drawing.draw(scene), wanted = drawing.truth(scene);
    const Difference difference = reference::compare(got, wanted, 0.01);
    EXPECT_TRUE(difference.rmse <= 5e-4 && difference.beyond <= kOutliers)
        << words(difference) << "; " << evidence(GetParam().name() + " regions", got, wanted);
}

TEST_P(RayStyles, QuantizedNormalsAgree) {
    Scene scene = baseScene(true);
    scene.layers = {{"", true, IsoLayer{.channel = "a", .value = 317}}};
    const Linear exact = drawing.draw(scene);
    scene.render.normalBits = 5;
    const Linear got = drawing.draw(scene), wanted = drawing.truth(scene);
    // Directions at the edge of a step may fall to either side of it.
    const Difference difference = reference::compare(got, wanted, kOutlier);
    EXPECT_LE(difference.beyond, 4 * kOutliers) << words(difference);
    EXPECT_GT(reference::compare(got, exact, 1e-3).beyond, 100u) << "five bits show";
}

} // namespace
} // namespace tessera::vis
