#include "tests/vis/gl_fixture.h"
#include "tests/vis/lens_scene.h"
#include "tests/vis/parts_drawing.h"
#include "vis/raycast/ray_plan.h"

#include <functional>

/// Layers that take their colours from another channel: the shader draws what the reference draws, and both what the
/// two transfer functions say.
namespace tessera::vis {
namespace {

struct Mode {
    const char* name;
    std::function<void(Scene&)> apply;
    double rmse = kRmse;
    std::size_t outliers = kOutliers;
};
/// The nearest label of a place, which colours it, falls the other way in single precision more often than others.
constexpr std::size_t kLabelOutliers = 24;

VolumeLayer coloredVolume(RayStyle style = RayStyle::Composite) {
    return {.channel = "a", .style = style, .density = 2, .colorBy = "b"};
}

const Mode kModes[] = {
    {"plain",
     [](Scene& s) {
         VolumeLayer plain = coloredVolume();
         plain.shaded = false;
         s.layers = {{"", true, plain}};
     }},
    {"shaded, with functions of their own",
     [](Scene& s) {
         s.layers = {{"", true, coloredVolume(), "", "own"},
                     {"", true, IsoLayer{.channel = "a", .value = 330, .opacity = 0.5f, .colorBy = "b"}, "", "other"}};
         s.transfer["own"].opacity = {{0, 0.1f}, {1, 0.02f}};
         s.transfer["other"].colormap = "plasma";
         s.transfer["other"].autoRange = false;
         s.transfer["other"].range = {0.2, 1.1};
     }},
    {"surfaces",
     [](Scene& s) {
         s.layers = {{"", true, IsoLayer{.channel = "b", .value = 0.55, .opacity = 0.7f, .colorBy = "a"}},
                     {"", true, IsoLayer{.channel = "a", .value = 317, .opacity = 0.6f, .colorBy = "a"}},
                     {"", true, IsoLayer{.channel = "a", .value = 330, .opacity = 0.6f}},
                     {"", true, SliceLayer{.channel = "a", .orientation = SliceOrientation::Y, .opacity = 0.4f}}};
     }},
    {"looks",
     [](Scene& s) {
         VolumeLayer drawn = coloredVolume();
         drawn.look.cartoon = Cartoon{};
         IsoLayer surface{.channel = "a", .value = 317, .opacity = 0.7f, .colorBy = "b"};
         surface.look.tone = WarmCool{};
         s.layers = {{"", true, drawn}, {"", true, surface}};
     },
     2 * kRmse},
    {"classified before",
     [](Scene& s) {
         VolumeLayer before = coloredVolume();
         before.classification = Classification::Pre;
         s.layers = {{"", true, before}};
     }},
    {"pre-integrated",
     [](Scene& s) {
         VolumeLayer slab = coloredVolume();
         slab.classification = Classification::PreIntegrated;
         s.layers = {{"", true, slab}};
     },
     4 * kRmse}, // the table's entries are 256 to the range
    {"gradient and a label",
     [](Scene& s) {
         VolumeLayer steep = coloredVolume();
         steep.quantity = Quantity::Gradient;
         steep.colorBy = "label";
         s.layers = {{"", true, steep}};
     },
     kRmse, kLabelOutliers},
    {"maximum",
     [](Scene& s) {
         s.layers = {{"", true, coloredVolume(RayStyle::Maximum)}};
         s.transfer["a"].opacity = {{0, 0.2f}, {1, 0.6f}};
     }},
    {"local maximum and minimum",
     [](Scene& s) {
         VolumeLayer local = coloredVolume(RayStyle::LocalMaximum);
         local.threshold = 310;
         s.layers = {{"", true, local}, {"", true, coloredVolume(RayStyle::Minimum)}};
         s.transfer["a"].opacity = {{0, 0.3f}, {1, 0.2f}};
     }},
    {"average",
     [](Scene& s) {
         s.layers = {{"", true, coloredVolume(RayStyle::Average)}};
         s.transfer["a"].opacity = {{0, 0.3f}, {1, 0.5f}};
     }},
    {"x-ray",
     [](Scene& s) {
         s.layers = {{"", true, coloredVolume(RayStyle::XRay)}};
         s.transfer["a"].opacity = {{0, 0.02f}, {1, 0.2f}};
     }},
    {"translucent, among brushes",
     [](Scene& s) {
         s.layers = {{"", true, coloredVolume()},
                     {"", true, IsoLayer{.channel = "b", .value = 0.9, .opacity = 0.6f, .colorBy = "a"}}};
         s.lighting.shadows = {.strength = 0.9f, .translucency = 0.8f, .resolution = 20};
         s.selection.brushes = {rangeBrush({{"b", 0.1, 0.9, 0.2}})};
         s.selection.contextOpacity = 0.3f;
     }},
    {"inside a lens",
     [](Scene& s) {
         s = lensScene(s.camera.projection == Projection::Perspective);
         s.lenses[0].size = glm::vec3(0.3f);
         std::get<IsoLayer>(s.layers[1].technique).colorBy = "a";
         std::get<VolumeLayer>(s.layers[2].technique).colorBy = "label";
     },
     4 * kRmse},
    {"around and inside lenses",
     [](Scene& s) {
         s = lensScene(s.camera.projection == Projection::Perspective);
         for (Lens& lens : s.lenses) lens.size = glm::vec3(0.25f);
         std::get<VolumeLayer>(s.layers[0].technique).colorBy = "b";
         std::get<IsoLayer>(s.layers[1].technique).colorBy = "b";
         std::get<VolumeLayer>(s.layers[2].technique).colorBy = "a";
         s.layers[2].transfer = "own";
         s.transfer["own"].opacity = {{0, 0.05f}, {1, 0.3f}};
     },
     4 * kRmse},
    {"in a small lens, with shadows",
     [](Scene& s) {
         s = lensScene(s.camera.projection == Projection::Perspective);
         s.lenses.pop_back();
         std::get<VolumeLayer>(s.layers[0].technique).colorBy = "b";
         std::get<IsoLayer>(s.layers[1].technique).colorBy = "a";
         s.lighting.shadows = {.strength = 0.9f, .occlusion = 0.8f, .resolution = 24};
     },
     4 * kRmse},
};

class ColorBy : public testing::TestWithParam<Case> {
protected:
    HeadlessContext context;
};
INSTANTIATE_TEST_SUITE_P(Lattices, ColorBy, testing::Values(Case{LatticeKind::CC, false}, Case{LatticeKind::BCC, true}),
                         [](const auto& each) { return each.param.name(); });

/// The same layers by colours of their own.
Scene withoutColorBy(Scene scene) {
    for (Layer& layer : scene.layers)
        std::visit(
            [](auto& technique) {
                if constexpr (requires { technique.colorBy; }) technique.colorBy.clear();
            },
            layer.technique);
    return scene;
}

TEST_P(ColorBy, AgreesWithTheReference) {
    Drawing dense(GetParam().kind, GetParam().masked, true), bricked(GetParam().kind, GetParam().masked, true, true);
    for (std::size_t i = 0; i < std::size(kModes); ++i)
        for (const bool perspective : {false, true}) {
            const Mode& mode = kModes[i];
            // Each mode on one lattice in one texture, on the other in bricks: every program takes long to compile.
            const bool inBricks = (i % 2 == 0) == GetParam().masked;
            Scene scene = baseScene(perspective);
            mode.apply(scene);
            const Linear wanted = dense.truth(scene), got = (inBricks ? bricked : dense).draw(scene);
            const std::string name = GetParam().name() + " by " + mode.name + (inBricks ? " in bricks" : "") +
                                     (perspective ? " perspective" : " parallel");
            const reference::Difference difference = reference::compare(got, wanted, kOutlier);
            EXPECT_TRUE(difference.rmseWithin <= mode.rmse && difference.beyond <= mode.outliers)
                << name << ": " << words(difference) << "; " << evidence(name, got, wanted);
            if (perspective) continue;
            const Linear own = dense.truth(withoutColorBy(scene));
            EXPECT_GT(reference::compare(own, wanted, kOutlier).rmse, 1e-3) << name << " looks as without";
        }
}

/// What a channel colours by itself is what it shows by itself.
TEST_P(ColorBy, ItsOwnParameterChangesNothing) {
    Drawing drawing(GetParam().kind, GetParam().masked, true);
    for (const RayStyle style : {RayStyle::Composite, RayStyle::Maximum, RayStyle::Minimum}) {
        Scene scene = baseScene(true);
        scene.layers = {{"", true, VolumeLayer{.channel = "a", .style = style, .density = 3}}};
        scene.transfer["a"].opacity = {{0, 0.05f}, {1, 0.2f}};
        const Linear own = drawing.draw(scene);
        std::get<VolumeLayer>(scene.layers[0].technique).colorBy = "a";
        EXPECT_LT(reference::compare(drawing.draw(scene), own, kOutlier).maximum, 1e-6) << int(style);
    }
}

/// 0 to 1 from left to right in one channel, and an opaque slab in another: a picture whose colours are known.
TEST(ColorByFunction, GivesTheColours) {
    HeadlessContext context;
    const auto ramp = [](glm::dvec3 p) -> std::optional<double> {
        if (p.x > 24) return std::nullopt; // and nothing in the last quarter
        return p.x / 32;
    };
    const auto data = std::make_shared<FunctionSource>(
        LatticeKind::CC, glm::ivec3(33, 33, 33), glm::dvec3(1),
        std::vector<FunctionSource::Channel>{
            {"shape", [](glm::dvec3 p) { return std::optional<double>(p.z / 32); }, {0, 1}}, {"ramp", ramp, {0, 1}}});
    Drawn drawn(data);
    Scene scene;
    scene.camera = test::frontCamera();
    scene.showBox = false;
    scene.render.samples = 1;
    scene.transfer["shape"].colormap = "gray";
    scene.transfer["shape"].opacity = {{0, 1}, {1, 1}};
    scene.transfer["ramp"].colormap = "inferno";
    scene.transfer["ramp"].opacity = {{0, 0}, {1, 0}}; // no part of it
    scene.lighting.lights.clear();
    scene.lighting.ambient = 1;
    const glm::vec3 plain(0.1f, 0.8f, 0.3f);
    const std::vector<Technique> techniques{
        VolumeLayer{.channel = "shape", .shaded = false, .density = 20, .colorBy = "ramp"},
        VolumeLayer{.channel = "shape", .style = RayStyle::Maximum, .density = 20, .colorBy = "ramp"},
        IsoLayer{.channel = "shape", .value = 0.5, .color = plain, .colorBy = "ramp"}};
    const TransferFunction& function = scene.transfer["ramp"];
    for (const Technique& technique : techniques) {
        scene.layers = {{"", true, technique}};
        const Linear got = drawn.draw(scene);
        const bool surface = std::holds_alternative<IsoLayer>(technique);
        int seen = 0, absent = 0;
        for (int x = 0; x < kSize.x; ++x) {
            const glm::dvec4 pixel = got.pixels[std::size_t(kSize.y / 2 * kSize.x + x)];
            if (pixel.a < 0.99) continue;
            // Parallel rays along -z through the middles of pixels.
            const Ray ray = cameraRay(scene.camera, double(kSize.x) / kSize.y, {(x + 0.5) / kSize.x * 2 - 1, 0});
            const double at = worldFrame(data->info(), scene.stretch).toPhysical(ray.origin).x / 32;
            if (std::abs(at - 24.5 / 32) < 0.05) continue; // coverage ends there
            const bool is = at < 0.75;
            const glm::dvec3 srgb = is        ? glm::dvec3(evaluate(function, {0, 1}, at))
                                    : surface ? glm::dvec3(plain)
                                              : glm::dvec3(kNoValueColor);
            const glm::dvec3 expected = linearFromSrgb(srgb), color = glm::dvec3(pixel) / pixel.a;
            EXPECT_LT(glm::length(color - expected), 2e-3) << technique.index() << " at " << at;
            ++(is ? seen : absent);
        }
        EXPECT_GT(seen, 20);
        EXPECT_GT(absent, 5);
    }
}

class PartsColorBy : public testing::TestWithParam<LatticeKind> {
protected:
    HeadlessContext context;
};
INSTANTIATE_TEST_SUITE_P(Lattices, PartsColorBy, testing::Values(LatticeKind::CC, LatticeKind::BCC),
                         [](const auto& each) { return std::string(volume::kLatticeNames[std::size_t(each.param)]); });

/// Colours come from the part that a place belongs to, dense and in bricks, between times, and in a lens.
TEST_P(PartsColorBy, AgreesWithTheReference) {
    const auto data = regionSource(GetParam(), Regions::Sloped, true);
    Drawn dense(data), bricked(data, true);
    Drawn series(std::make_shared<RegionSeries>(GetParam(), Regions::Sloped, true));
    const std::vector<std::pair<std::string, std::vector<Layer>>> scenes{
        {"one part by two", {{"", true, VolumeLayer{.channel = "smooth", .density = 0.2f, .colorBy = "gas"}}}},
        {"two parts by three", {{"", true, VolumeLayer{.channel = "heat", .shaded = false, .colorBy = "three"}}}},
        {"surfaces",
         {{"", true, IsoLayer{.channel = "smooth", .value = 0.6, .opacity = 0.8f, .colorBy = "heat"}},
          {"", true, IsoLayer{.channel = "gas", .value = 0.97, .opacity = 0.7f, .colorBy = "smooth"}}}},
        {"in a lens",
         {{"", true, VolumeLayer{.channel = "heat", .colorBy = "smooth"}},
          {"", true, IsoLayer{.channel = "smooth", .value = 0.6, .colorBy = "gas"}, "inner"}}}};
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const auto& [name, layers] = scenes[i];
        Scene scene = regionScene();
        scene.transfer["gas"] = scene.transfer["heat"] = scene.transfer["three"] = fog();
        scene.transfer["three"].range = {0.8, 3.2};
        scene.layers = layers;
        if (layers.back().lens == "inner")
            scene.lenses = {{.name = "inner", .center = scene.cursor, .size = glm::vec3(0.3f)}};
        const Linear wanted = dense.truth(scene);
        dense.check("coloured " + name, scene, wanted, 2 * kRmse);
        // Each scene on one lattice in bricks, on the other between times: every program takes long to compile.
        if ((i % 2 == 0) == (GetParam() == LatticeKind::BCC)) {
            bricked.check("coloured " + name + " in bricks", scene, wanted, 2 * kRmse);
        } else {
            scene.time = 0.37;
            series.check("coloured " + name + " between times", scene, 2 * kRmse);
        }
    }
}

/// No colour that neither region holds: of a surface that passes through both.
TEST_P(PartsColorBy, MixesNoRegions) {
    Drawn drawn(regionSource(GetParam(), Regions::Constant, true));
    Scene scene = regionScene();
    scene.layers = {{"", true, IsoLayer{.channel = "smooth", .value = 0.6, .color = glm::vec3(0), .colorBy = "gas"}}};
    scene.lighting.lights.clear();
    scene.lighting.ambient = 1;
    TransferFunction& function = scene.transfer["gas"];
    function.autoRange = false;
    function.range = {1, 2};
    function.colors = {{0, {1, 0, 0}}, {0.2f, {0, 1, 0}}, {0.8f, {0, 1, 0}}, {1, {0, 0, 1}}}; // green only between
    const Linear got = drawn.draw(scene);
    int red = 0, blue = 0;
    for (const glm::dvec4& pixel : got.pixels) {
        EXPECT_LT(pixel.g, 1e-4);
        red += pixel.r > 0.5;
        blue += pixel.b > 0.5;
    }
    EXPECT_GT(red, 50);
    EXPECT_GT(blue, 50);
}

/// What no layer asks for costs nothing: no field and no row.
TEST(ColorByPlan, TakesAFieldOnlyWhereAsked) {
    const auto data = regionSource(LatticeKind::CC, Regions::Constant, false);
    Scene scene = regionScene();
    scene.layers = {{"", true, VolumeLayer{.channel = "smooth"}}};
    EXPECT_EQ(planRays(scene, data->info()).fields.size(), 1u);
    EXPECT_EQ(planRays(scene, data->info()).rows, 1);
    std::get<VolumeLayer>(scene.layers[0].technique).colorBy = "heat";
    EXPECT_EQ(planRays(scene, data->info()).fields.size(), 2u);
    EXPECT_EQ(planRays(scene, data->info()).rows, 2);
    std::get<VolumeLayer>(scene.layers[0].technique).colorBy = "nowhere";
    EXPECT_EQ(planRays(scene, data->info()).fields.size(), 1u);
}

} // namespace
} // namespace tessera::vis
