#include "tests/vis/ball_silhouette.h"
#include "tests/vis/raycast_compare.h"

#include "vis/optics/look_shading.h"
#include "vis/optics/shade.h"

#include <glm/trigonometric.hpp>
#include <numbers>

/// Looks and brushes on rasterised geometry: against the formulas, and against slices in the same place.
namespace tessera::vis {
namespace {

/// A ball of radius 0.4 world units in the middle of an empty cube of edge 40, as a fine mesh.
constexpr double kBallRadius = 0.4;
constexpr glm::ivec2 kBallPicture{120, 120};

std::shared_ptr<const Geometry> ballMesh() {
    constexpr int kRound = 192, kUp = 96;
    auto geometry = std::make_shared<Geometry>();
    for (int j = 0; j <= kUp; ++j)
        for (int i = 0; i <= kRound; ++i) {
            const double along = 2 * std::numbers::pi * i / kRound, up = std::numbers::pi * j / kUp;
            const glm::dvec3 normal(std::sin(up) * std::cos(along), std::cos(up), std::sin(up) * std::sin(along));
            geometry->mesh.positions.emplace_back(20.0 + normal * (kBallRadius * 40));
            geometry->mesh.normals.emplace_back(normal);
            geometry->mesh.scalars.push_back(std::numeric_limits<float>::quiet_NaN());
        }
    for (std::uint32_t j = 0; j < kUp; ++j)
        for (std::uint32_t i = 0; i < kRound; ++i) {
            const std::uint32_t a = j * (kRound + 1) + i, b = a + kRound + 1;
            geometry->mesh.triangles.push_back({a, b, a + 1});
            geometry->mesh.triangles.push_back({a + 1, b, b + 1});
        }
    return geometry;
}

struct MeshBall {
    HeadlessContext context;
    std::shared_ptr<FunctionSource> data;
    Renderer renderer{optionsFor(true, false)};
    Scene scene;

    MeshBall() {
        const auto along = [](glm::dvec3 p) -> std::optional<double> { return p.x / 40; };
        data = std::make_shared<FunctionSource>(LatticeKind::CC, glm::ivec3(41), glm::dvec3(1),
                                                std::vector<FunctionSource::Channel>{{"f", along, {0, 1}}}, 16,
                                                glm::dvec3(0));
        renderer.setSource(data);
        scene.camera.projection = Projection::Orthographic;
        scene.camera.orientation = {1, 0, 0, 0};
        scene.showBox = false;
        scene.render.samples = 1;
        scene.lighting.lights = {{.azimuth = 40, .elevation = 30}};
        scene.geometry = {{.geometry = ballMesh(), .style = {.color = {0.9f, 0.6f, 0.3f}}}};
    }
    std::vector<glm::vec4> draw() {
        const ViewTargetPtr target = renderer.makeTarget();
        FrameRequest request;
        request.size = kBallPicture;
        request.wait = true;
        renderer.render(*target, scene, request);
        for (const std::string& message : renderer.takeMessages()) ADD_FAILURE() << message;
        return renderer.readLinear(*target);
    }
    /// What the formulas say of the ball's front at (x, y) radii; of its opacity 1 and no back.
    glm::dvec4 expected(glm::dvec2 at) const {
        const GeometryLayer& layer = scene.geometry[0];
        const glm::dvec3 normal(at, std::sqrt(1 - glm::dot(at, at))), place = normal * kBallRadius;
        const glm::dvec3 toViewer(0, 0, 1), albedo = linearFromSrgb(glm::dvec3(layer.style.color));
        const LookView view = lookView(scene, glm::dvec3(0.5), glm::dvec3(1.0 / 40), kBallPicture);
        LookSample sample;
        sample.at = facing(normal, toViewer);
        sample.weight = sample.steepness = 1;
        sample.curvature = 1 / kBallRadius;
        const Ray middle = cameraRay(scene.camera, 1, {0, 0});
        sample.depth =
            (glm::dot(place - middle.origin, middle.direction) - view.nearest) / (view.farthest - view.nearest);
        sample.pixel = view.pixel.x;
        sample.toLight = view.light.place;
        if (layer.style.look.charcoal)
            sample.grain = marksAt(*layer.style.look.charcoal, place, normal, SurfaceBend(0), sample.pixel);
        if (layer.style.look.wire)
            sample.wire = wireCoverage(place, normal, toViewer, double(layer.style.look.wire->spacing),
                                       double(layer.style.look.wire->width), sample.pixel);
        const Illumination light = illuminate(scene.lighting, scene.camera);
        const glm::dvec3 lit = shade(light, lookAlbedo(layer.style.look, albedo, 1.0), normal, 1, place, toViewer);
        const double alpha = lookOpacity(layer.style.look, double(layer.style.opacity), sample);
        return {lookColor(layer.style.look, albedo, lit, sample, view.ground) * alpha, alpha};
    }
    glm::dvec2 place(int x, int y) const {
        const glm::dvec2 ndc = (glm::dvec2(x, kBallPicture.y - 1 - y) + 0.5) / glm::dvec2(kBallPicture) * 2.0 - 1.0;
        return glm::dvec2(cameraRay(scene.camera, 1, ndc).origin) / kBallRadius;
    }
};

/// An iso-surface ends where the box cuts it, and drawings outline that rim; a mesh as large has none.
TEST(PolygonLooks, RimsOfCutSurfacesAreOutlined) {
    MeshBall ball;
    const auto square = std::make_shared<Geometry>();
    for (const glm::vec3 corner : {glm::vec3(0), glm::vec3(40, 0, 0), glm::vec3(40, 40, 0), glm::vec3(0, 40, 0)}) {
        square->mesh.positions.push_back(corner + glm::vec3(0, 0, 20));
        square->mesh.normals.push_back({0, 0, 1});
    }
    square->mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    ball.scene.camera.distance = 3;
    ball.scene.paper = Paper{.color = glm::vec3(1), .tooth = 0};
    ball.scene.lighting.lights = {{.azimuth = 0, .elevation = 0}}; // from the camera: nothing is in the shade
    GeometryStyle& style = ball.scene.geometry[0].style;
    ball.scene.geometry[0].geometry = square;
    for (const std::string_view name : {"cartoon", "hatching", "stipple"}) {
        const auto darkest = [&](bool cut, double from, double to) { // of what is from .. to half edges off the middle
            style.look = *Look::preset(name);
            style.cutByBox = cut;
            const std::vector<glm::vec4> picture = ball.draw();
            double lowest = 1;
            for (int y = 0; y < kBallPicture.y; ++y)
                for (int x = 0; x < kBallPicture.x; ++x) {
                    const glm::dvec2 at = glm::abs(ball.place(x, y)) * kBallRadius * 2.0;
                    const double off = std::max(at.x, at.y);
                    const glm::vec4 pixel = picture[std::size_t(y * kBallPicture.x + x)];
                    if (off > from && off < to) lowest = std::min(lowest, luminance(glm::dvec3(pixel)));
                }
            return lowest;
        };
        const double pixel = std::abs(ball.place(1, 0).x - ball.place(0, 0).x) * kBallRadius * 2, edge = 1 - 2 * pixel;
        EXPECT_LT(darkest(true, edge, 1), 0.5 * darkest(false, edge, 1)) << name;
        EXPECT_EQ(darkest(true, 0.2, 0.8), darkest(false, 0.2, 0.8)) << name << ": nothing changes away from the rim";
    }
}

TEST(PolygonLooks, PresetsFollowTheFormulas) {
    MeshBall ball;
    for (const std::string_view name : Look::kPresetNames) {
        ball.scene.geometry[0].style.look = *Look::preset(name);
        // Silhouettes and wires let the back of the ball shine through: another formula, tested below.
        if (ball.scene.geometry[0].style.look.silhouette || ball.scene.geometry[0].style.look.wire) continue;
        const std::vector<glm::vec4> picture = ball.draw();
        int seen = 0, beyond = 0;
        double squares = 0;
        for (int y = 0; y < kBallPicture.y; ++y)
            for (int x = 0; x < kBallPicture.x; ++x) {
                const glm::dvec2 at = ball.place(x, y);
                if (glm::length(at) > 0.98) continue;
                const glm::dvec4 apart = glm::dvec4(picture[std::size_t(y * kBallPicture.x + x)]) - ball.expected(at);
                const double worst =
                    std::max({std::abs(apart.x), std::abs(apart.y), std::abs(apart.z), std::abs(apart.w)});
                ++seen;
                beyond += worst > 0.03; // bands and hard grain fall either way here and there
                if (worst <= 0.03) squares += glm::dot(apart, apart);
            }
        ASSERT_GT(seen, 3000);
        EXPECT_LT(beyond, seen * 3 / 100) << name;
        EXPECT_LT(std::sqrt(squares / seen), 0.008) << name;
    }
}

TEST(PolygonLooks, SilhouettesAreTheRim) {
    MeshBall ball;
    ball.scene.geometry[0].style.opacity = kSilhouetteOpacity;
    ball.scene.geometry[0].style.look.silhouette = kSilhouette;
    expectSilhouette(ball.draw(), kBallPicture, [&](int x, int y) { return ball.place(x, y); });
}

/// On a plane across the view lines of width w lie every s along x and y: 1 - (1 - w / s)^2 of it is line.
TEST(WireFrames, CoverTheShareThatTheirWidthSays) {
    const double spacing = 0.1, pixel = 0.005, width = 2;
    const glm::dvec3 view(0, 0, 1);
    double sum = 0;
    int count = 0;
    for (double y = 0.00025; y < 0.2; y += 0.0005)
        for (double x = 0.00025; x < 0.2; x += 0.0005, ++count)
            sum += wireCoverage({x, y, 0.05}, view, view, spacing, width, pixel);
    const double share = width * pixel / spacing;
    EXPECT_NEAR(sum / count, 1 - (1 - share) * (1 - share), 0.01);
    // A plane that lies along the planes of z shows none of those, wherever it is.
    EXPECT_EQ(wireCoverage({0.05, 0.05, 0.1}, view, view, spacing, width, pixel), 0);
    // Tilted, lines across the tilt stand closer on screen by its cosine, and stay as wide.
    const double tilt = glm::radians(50.0);
    const glm::dvec3 normal(std::sin(tilt), 0, std::cos(tilt));
    double covered = 0;
    const int n = 4000;
    for (int i = 0; i < n; ++i) {
        const double across = 0.2 * (i + 0.5) / n; // on screen
        const glm::dvec3 place(across, 0.05, -across * std::tan(tilt));
        covered += wireCoverage(place, normal, view, spacing, width, pixel) > 0.5;
    }
    // Along x: planes of x every s, and planes of z every s / tan(tilt), which meet in 0.
    const double lines = 0.2 / spacing + 0.2 * std::tan(tilt) / spacing;
    EXPECT_NEAR(covered / n * 0.2 / pixel, lines * width, 0.35 * lines * width);
}

/// The rectangle through the middle of the cube of edge 40 in the place of a slice, coloured by the same values.
std::shared_ptr<const Geometry> middlePlane() {
    auto geometry = std::make_shared<Geometry>();
    for (const glm::vec2 corner : {glm::vec2(0, 0), {40, 0}, {40, 40}, {0, 40}}) {
        geometry->mesh.positions.emplace_back(corner, 20);
        geometry->mesh.scalars.push_back(corner.x / 40);
    }
    geometry->mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return geometry;
}

TEST(PolygonBrushes, ActAsOnASliceInTheSamePlace) {
    for (const BrushEffect effect :
         {BrushEffect::Fade, BrushEffect::None, BrushEffect::ContextOnly, BrushEffect::FocusOnly}) {
        MeshBall ball;
        Scene scene = ball.scene;
        scene.geometry.clear();
        scene.lighting.ambient = 1;
        scene.lighting.diffuse = scene.lighting.specular = 0;
        scene.selection.brushes = {rangeBrush({{"f", 0.3, 0.6, 0.2}})};
        scene.selection.contextOpacity = 0.3f;
        scene.selection.contextSaturation = 0.2f;
        scene.selection.contextLightness = 0.7f;
        scene.selection.brushColor = 0.5f;
        ball.scene = scene;
        ball.scene.layers = {
            {"", true, SliceLayer{.channel = "f", .atCursor = false, .position = 0.5, .opacity = 0.8f}}};
        ball.scene.layers[0].brushes = effect;
        const std::vector<glm::vec4> slice = ball.draw();
        ball.scene.layers.clear();
        ball.scene.geometry = {
            {.geometry = middlePlane(), .style = {.opacity = 0.8f}, .channel = "f", .brushes = effect}};
        const std::vector<glm::vec4> mesh = ball.draw();
        std::size_t differ = 0, seen = 0;
        for (std::size_t i = 0; i < slice.size(); ++i) {
            const glm::vec4 apart = glm::abs(slice[i] - mesh[i]);
            differ += std::max({apart.x, apart.y, apart.z, apart.w}) > 4e-3f;
            seen += slice[i].a > 0.1f;
        }
        EXPECT_GT(seen, 1000u) << int(effect);
        EXPECT_LT(differ, 120u) << int(effect) << ": of the border alone, beyond which samples repeat";
    }
}

/// What brushes do to layers, and the colours they give, as the reference says.
class BrushEffects : public testing::TestWithParam<Case> {
protected:
    HeadlessContext context;
    Drawing drawing{GetParam().kind, GetParam().masked, true};
};
INSTANTIATE_TEST_SUITE_P(Lattices, BrushEffects,
                         testing::Values(Case{LatticeKind::CC, false}, Case{LatticeKind::BCC, true}),
                         [](const auto& each) { return each.param.name(); });

TEST_P(BrushEffects, AgreeWithTheReference) {
    Scene scene = baseScene(true);
    scene.selection.brushColor = 0.6f;
    Brush other = rangeBrush({{"b", 0.9, 1.4, 0.2}});
    other.color = {0.2f, 0.6f, 1};
    other.combine = BrushCombine::Or;
    scene.selection.brushes = {rangeBrush({{"a", 310, 330, 10}}), other};
    for (const int number : {0, 1, 2, 3, 4, 5, 6, 7}) {
        const auto effect = static_cast<BrushEffect>(number % 4);
        scene.selection.contextOpacity = number < 4 ? 0.3f : 0; // where brushes hide all, rays leap over it
        scene.layers = {{"", true, VolumeLayer{.channel = "a"}},
                        {"", true, IsoLayer{.channel = "a", .value = 335, .opacity = 0.6f}},
                        {"", true, SliceLayer{.channel = "b", .opacity = 0.5f}}};
        // Each in turn, so that programs with layers of different effects are tried.
        scene.layers[std::size_t(effect) % 3].brushes = effect;
        scene.layers[1].brushes = effect;
        const Linear got = drawing.draw(scene), wanted = drawing.truth(scene);
        const reference::Difference difference = reference::compare(got, wanted, kOutlier);
        EXPECT_TRUE(agrees(difference)) << number << ": " << words(difference) << "; "
                                        << evidence("brush effect " + std::to_string(number), got, wanted);
        Scene plain = scene;
        plain.selection.brushColor = 0;
        EXPECT_GT(reference::compare(got, drawing.draw(plain), 1e-2).beyond, 50u) << "brushes colour";
    }
    for (Layer& layer : scene.layers) layer.brushes = BrushEffect::None;
    const Linear unbrushed = drawing.draw(scene);
    scene.selection.brushes.clear();
    EXPECT_LT(reference::compare(unbrushed, drawing.draw(scene), kOutlier).beyond, 1u) << "as if there were no brush";
}

TEST_P(BrushEffects, NothingIsContextWithoutABrush) {
    Scene scene = baseScene(true);
    scene.layers = {{"", true, IsoLayer{.channel = "a", .value = 335}}};
    scene.layers[0].brushes = BrushEffect::ContextOnly;
    for (const glm::dvec4& pixel : drawing.draw(scene).pixels) EXPECT_EQ(pixel.a, 0);
}

} // namespace
} // namespace tessera::vis
