#include "tests/vis/ball_silhouette.h"
#include "tests/vis/raycast_compare.h"
#include "vis/optics/surface_light.h"

#include "vis/optics/look_shading.h"

#include <functional>
#include <glm/gtc/quaternion.hpp>
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

/// A ball of radius 0.4 world units in the middle, as its distance function.
struct Ball {
    static constexpr double kRadius = 0.4;
    HeadlessContext context;
    std::shared_ptr<FunctionSource> data;
    Renderer renderer{optionsFor(true, false)};
    Scene scene;

    Ball() {
        const auto distance = [](glm::dvec3 p) -> std::optional<double> { return glm::length(p - 20.0) / 40; };
        data = std::make_shared<FunctionSource>(LatticeKind::CC, glm::ivec3(41), glm::dvec3(1),
                                                std::vector<FunctionSource::Channel>{{"d", distance, {0, 0.87}}}, 16,
                                                glm::dvec3(0));
        renderer.setSource(data);
        scene.camera.projection = Projection::Orthographic;
        scene.camera.orientation = {1, 0, 0, 0};
        scene.showBox = false;
        scene.render.samples = 1;
        scene.render.stepVoxels = 0.25f;
    }
    IsoLayer& surface() {
        scene.layers = {{"", true, IsoLayer{.channel = "d", .value = kRadius, .color = glm::vec3(1)}}};
        return std::get<IsoLayer>(scene.layers[0].technique);
    }
    std::vector<glm::vec4> draw(glm::ivec2 size) {
        const ViewTargetPtr target = renderer.makeTarget();
        FrameRequest request;
        request.size = size;
        request.wait = true;
        renderer.render(*target, scene, request);
        for (const std::string& message : renderer.takeMessages()) ADD_FAILURE() << message;
        return renderer.readLinear(*target);
    }
    /// Places on the ball's front, in radii: x, y of a pixel.
    glm::dvec2 place(int x, int y, glm::ivec2 size) const {
        const glm::dvec2 ndc = (glm::dvec2(x, size.y - 1 - y) + 0.5) / glm::dvec2(size) * 2.0 - 1.0;
        return glm::dvec2(cameraRay(scene.camera, double(size.x) / size.y, ndc).origin) / kRadius;
    }
};

constexpr glm::ivec2 kPicture{120, 120};

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
            const glm::dvec3 expected =
                glm::mix(cool, warm, (1 + l) / 2) + double(layer.look.tone->ownColor) * std::max(l, 0.0);
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
    layer.look.cartoon = Cartoon{.shadow = 1, .outline = 5, .outlineColor = glm::vec3(0)};
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

/// Mean change of the picture, as shown, at the same places of the ball's surface while it turns by a degree under the
/// light. `meanwhile` may change the scene between the two pictures.
double changeOnTheBall(
    Ball& ball, glm::ivec2 size, const std::function<void()>& meanwhile = [] {}) {
    const std::vector<glm::vec4> before = ball.draw(size);
    const glm::dquat turn = glm::angleAxis(glm::radians(1.0), glm::dvec3(0, 1, 0));
    ball.scene.camera.orientation = glm::quat(turn);
    meanwhile();
    const std::vector<glm::vec4> after = ball.draw(size);
    ball.scene.camera.orientation = {1, 0, 0, 0};
    const double radius = 1 / (ball.place(1, 0, size).x - ball.place(0, 0, size).x); // pixels
    const auto at = [&](const std::vector<glm::vec4>& picture, glm::dvec3 place) {
        const glm::dvec2 pixel = glm::dvec2(place.x, -place.y) * radius + glm::dvec2(size) / 2.0 - 0.5;
        const glm::dvec2 base = glm::floor(pixel), part = pixel - base;
        const auto fetch = [&](int x, int y) {
            const glm::vec4 color = picture[std::size_t((int(base.y) + y) * size.x + int(base.x) + x)];
            return srgbFromLinear(std::clamp(double(color.g), 0.0, 1.0));
        };
        return glm::mix(glm::mix(fetch(0, 0), fetch(1, 0), part.x), glm::mix(fetch(0, 1), fetch(1, 1), part.x), part.y);
    };
    double sum = 0;
    int count = 0;
    for (double y = -0.8; y <= 0.8; y += 0.008)
        for (double x = -0.8; x <= 0.8; x += 0.008) {
            if (x * x + y * y > 0.7) continue;
            const glm::dvec3 place(x, y, std::sqrt(1 - x * x - y * y)), moved = turn * place;
            sum += std::abs(at(after, moved) - at(before, place));
            ++count;
        }
    return sum / count;
}

/// Under a turn of a degree a place of the surface changes no more in charcoal than 1.5 times what it changes in plain
/// shading; grain that is not fixed to it would change far more.
TEST(LooksOfABall, CharcoalGrainDoesNotSwim) {
    Ball ball;
    IsoLayer& layer = ball.surface();
    ball.scene.lighting.lights = {{.azimuth = -50, .elevation = 40}};
    constexpr glm::ivec2 kLarge{480, 480};
    const double plain = changeOnTheBall(ball, kLarge);
    EXPECT_GT(plain, 1e-3) << "the light moves over the ball";
    // Four times the usual grain: as a picture of a quarter of the size that is averaged over its pixels.
    layer.look.charcoal = CharcoalDrawing{.outline = 9, .grain = 10};
    const double drawn = changeOnTheBall(ball, kLarge);
    EXPECT_LE(drawn, 1.5 * plain);
    const double swimming = changeOnTheBall(ball, kLarge, [&] { layer.look.charcoal->angle = 90; });
    EXPECT_GT(swimming, 5 * plain) << "the measure sees grain that moves";
    RecordProperty("drawnOverPlain", std::to_string(drawn / plain));
    RecordProperty("swimmingOverPlain", std::to_string(swimming / plain));
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
