#include "tests/vis/ball_silhouette.h"
#include "tests/vis/drawn_ball.h"
#include "tests/vis/raycast_compare.h"

#include "vis/optics/look_shading.h"

#include <set>

/// Looks in pictures: against the reference, and against what is known of a sphere.
namespace tessera::vis {
namespace {

using reference::Difference;

struct LookCase {
    LatticeKind kind;
    bool masked, bricked;
    std::string name() const {
        return std::string(volume::kLatticeNames[std::size_t(kind)]) + (masked ? "_masked" : "_whole") +
               (bricked ? "_bricked" : "");
    }
};

class Looks : public testing::TestWithParam<LookCase> {
protected:
    HeadlessContext context;
    Drawing drawing{GetParam().kind, GetParam().masked, true, GetParam().bricked};

    /// Steps of light and the dark of a hard grain fall either way in single precision here and there.
    void check(const std::string& what, const Scene& scene, std::size_t outliers = 4 * kOutliers) {
        const Linear got = drawing.draw(scene), wanted = drawing.truth(scene);
        const Difference difference = reference::compare(got, wanted, 2e-3);
        const std::string name = GetParam().name() + " " + what;
        EXPECT_TRUE(difference.rmseWithin <= 1e-4 && difference.beyond <= outliers)
            << name << ": " << words(difference) << "; " << evidence(name, got, wanted);
        Scene plain = scene;
        for (Layer& layer : plain.layers)
            std::visit(
                [](auto& own) {
                    if constexpr (requires { own.look; }) own.look = {};
                },
                layer.technique);
        EXPECT_GT(reference::compare(got, drawing.draw(plain), 1e-2).beyond, 100u) << name << " changes nothing";
    }
};

INSTANTIATE_TEST_SUITE_P(Lattices, Looks,
                         testing::Values(LookCase{LatticeKind::CC, false, false}, LookCase{LatticeKind::CC, true, true},
                                         LookCase{LatticeKind::BCC, true, false},
                                         LookCase{LatticeKind::BCC, false, true}),
                         [](const auto& each) { return each.param.name(); });

TEST_P(Looks, PresetsAgreeWithTheReference) {
    Scene scene = baseScene(true);
    scene.transfer["a"].opacity = {{0, 0}, {0.45f, 0}, {0.6f, 0.2f}, {1, 0.4f}};
    for (const std::string_view name : Look::kPresetNames) {
        if (name == "plain") continue;
        scene.layers = {{"", true, VolumeLayer{.channel = "a", .look = *Look::preset(name)}}};
        check(std::string(name), scene);
    }
}

/// All parts of a look on volume and surface, in parallel projection, under a near light, on what is not brushed.
TEST_P(Looks, PartsComposeWithBrushesAndLayers) {
    Scene scene = baseScene(false);
    Look all;
    all.part = LookPart::Context;
    all.tone = WarmCool{.amount = 0.5f};
    all.boundary.emplace();
    all.silhouette.emplace();
    all.distance = DistanceColor{.toBackground = false};
    all.charcoal = CharcoalDrawing{.hardness = 0.2f, .angle = 30};
    Look surface = *Look::preset("illustration");
    surface.part = LookPart::Focus;
    scene.layers = {{"", true, VolumeLayer{.channel = "a", .look = all}},
                    {"", true, IsoLayer{.channel = "a", .value = 335, .opacity = 0.6f, .look = surface}},
                    {"", true, SliceLayer{.channel = "b", .opacity = 0.5f}}};
    scene.lighting.lights = {{.kind = LightKind::Point, .position = {0.6f, 0.9f, 0.8f}}};
    scene.selection.brushes = {rangeBrush({{"b", 0.4, 1.2, 0.3}})};
    scene.selection.contextOpacity = 0.6f;
    scene.render.samples = 2; // what presents a picture leaves the units of the next pass alone
    scene.paper = Paper{.color = glm::vec3(0.9f)};
    check("all parts", scene);
}

/// The rims of surfaces that the box cuts are drawn, by broad lines here.
TEST_P(Looks, RimsOfSurfacesAgreeWithTheReference) {
    Scene scene = baseScene(true);
    for (const std::string_view name : {"cartoon", "hatching"}) {
        Look look = *Look::preset(name);
        if (look.cartoon) look.cartoon->outline = 6;
        if (look.charcoal) look.charcoal->outline = 6;
        scene.layers = {{"", true, IsoLayer{.channel = "a", .value = 335, .look = look}}};
        check(std::string(name), scene);
    }
}

TEST(LooksOfABall, SilhouettesAreTheRim) {
    Ball ball;
    IsoLayer& layer = ball.surface();
    layer.opacity = kSilhouetteOpacity;
    layer.look.silhouette = kSilhouette;
    expectSilhouette(ball.draw(kPicture), kPicture, [&](int x, int y) { return ball.place(x, y, kPicture); });
}

TEST(LooksOfABall, ToneRunsFromWarmToCool) {
    Ball ball;
    IsoLayer& layer = ball.surface();
    layer.look.tone.emplace();
    ball.scene.lighting.lights = {{.azimuth = 60, .elevation = 0}};
    const glm::dvec3 light = lightDirection(ball.scene.lighting.lights[0], ball.scene.camera);
    const std::vector<glm::vec4> picture = ball.draw(kPicture);
    const glm::dvec3 warm = linearFromSrgb(glm::dvec3(layer.look.tone->warmColor)),
                     cool = linearFromSrgb(glm::dvec3(layer.look.tone->coolColor));
    for (int y = 0; y < kPicture.y; ++y)
        for (int x = 0; x < kPicture.x; ++x) {
            const glm::dvec2 p = ball.place(x, y, kPicture);
            if (glm::length(p) > 0.9) continue;
            const double l = glm::dot(glm::dvec3(p, std::sqrt(1 - glm::dot(p, p))), light);
            const glm::dvec3 expected = glm::mix(cool, warm, (1 + l) / 2); // of white
            const glm::vec4 got = picture[std::size_t(y * kPicture.x + x)];
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], expected[k], 0.03) << p.x << ' ' << p.y;
        }
}

TEST(LooksOfABall, CartoonsHaveTheBandsAskedForAndEvenOutlines) {
    for (const int steps : {2, 3, 5}) {
        Ball ball;
        IsoLayer& layer = ball.surface();
        layer.look.cartoon = Cartoon{.steps = steps, .outline = 0};
        ball.scene.lighting.lights = {{.azimuth = 50, .elevation = 20}};
        std::set<long> bands;
        for (const glm::vec4& pixel : ball.draw(kPicture))
            if (pixel.a > 0.5f) bands.insert(std::lround(1000 * double(pixel.g)));
        EXPECT_EQ(bands.size(), std::size_t(steps));
    }
    Ball ball;
    IsoLayer& layer = ball.surface();
    layer.look.cartoon = Cartoon{.shadow = 1, .outline = 5};
    ball.scene.background = glm::vec3(1);
    const std::vector<glm::vec4> picture = ball.draw(kPicture);
    // Across the middle row: dark at both rims, about five pixels wide.
    int dark = 0, light = 0;
    for (int x = 0; x < kPicture.x; ++x) {
        const glm::vec4 pixel = picture[std::size_t(kPicture.y / 2 * kPicture.x + x)];
        if (pixel.a > 0.5f) (pixel.g < 0.5f ? dark : light)++;
    }
    EXPECT_GE(dark, 6);
    EXPECT_LE(dark, 11);
    EXPECT_GT(light, 40);
}

/// The same size of grain on screen near and far, and the same picture again.
TEST(LooksOfABall, GrainKeepsItsSizeOnScreen) {
    Ball ball;
    ball.scene.lighting.ambient = 0.25f; // the same middle tone everywhere
    ball.scene.lighting.diffuse = ball.scene.lighting.specular = 0;
    ball.surface().look.charcoal = CharcoalDrawing{.contrast = 1, .outlineStrength = 0, .grain = 4, .smudge = 0};
    const auto changes = [&](float distance) {
        ball.scene.camera.distance = distance;
        const std::vector<glm::vec4> picture = ball.draw({200, 200});
        EXPECT_EQ(picture, ball.draw({200, 200})) << "the same again";
        int crossings = 0;
        for (int y = 80; y < 120; ++y)
            for (int x = 80; x < 119; ++x)
                crossings +=
                    (picture[std::size_t(y * 200 + x)].g > 0.4f) != (picture[std::size_t(y * 200 + x + 1)].g > 0.4f);
        return crossings;
    };
    const int far = changes(2.2f), near = changes(0.9f);
    EXPECT_GT(far, 50);
    EXPECT_NEAR(double(near) / far, 1, 0.35);
}

} // namespace
} // namespace tessera::vis
