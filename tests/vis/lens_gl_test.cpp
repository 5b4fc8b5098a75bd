#include "tests/vis/raycast_compare.h"
#include "tests/vis/shader_probe.h"
#include "vis/raycast/lens_uniforms.h"
#include "volume/sources/memory_source.h"

#include <functional>
#include <random>

/// Lenses in the shader against the double-precision reference, and what they must do by themselves.
namespace tessera::vis {
namespace {

using LensLib = test::ShaderProbe;

TEST_F(LensLib, WeighsBendsAndActsAsItsTwinDoes) {
    std::mt19937 seeded(3);
    std::uniform_real_distribution<float> number(-0.4f, 0.4f);
    for (int round = 0; round < 6; ++round) {
        Scene scene;
        for (int i = 0; i < 3; ++i)
            scene.lenses.push_back({.name = std::to_string(i),
                                    .shape = LensShape((round + i) % 4),
                                    .effect = LensEffect((round + 2 * i) % 6),
                                    .center = {number(seeded), number(seeded), number(seeded)},
                                    .size = glm::vec3(0.6f + number(seeded), 0.5f, 0.4f),
                                    .rotation = {400 * number(seeded), 30, 70},
                                    .rim = 0.3f,
                                    .inverted = i == round % 3,
                                    .strength = 0.7f});
        scene.layers = {{"", true, VolumeLayer{}, "1"}};
        ProgramRecipe recipe;
        const WorldFrame frame;
        const std::vector<PlacedLens> lenses = placeLenses(scene, frame);
        addLenses(recipe, lenses, scene);
        const auto got = [&](const std::string& expression) {
            return evaluate("uniform vec3 halfSize;\n#include \"lib/sampling/lenses.glsl\"\n", expression, recipe,
                            [&](const Program& program) {
                                setLensUniforms(program, lenses);
                                program.set("halfSize", glm::vec3(frame.halfSize));
                            });
        };
        const auto weights = got("vec4(lensAction(-1, 0.5 * a[i].xyz), lensAction(1, 0.5 * a[i].xyz))");
        const auto bent = got("vec4(lensBend(0.5 * a[i].xyz), lensConfine(abs(b[i].x), 0.5 * a[i].xyz))");
        for (int i = 0; i < kCases; ++i) {
            const glm::dvec3 p = 0.5 * glm::dvec3(a[i]);
            const LensAction below = lensAction(lenses, -1, p), own = lensAction(lenses, 1, p);
            EXPECT_NEAR(weights[i].x, below.opacity, 1e-5 * (1 + below.opacity));
            EXPECT_NEAR(weights[i].y, below.saturation, 1e-5);
            EXPECT_NEAR(weights[i].z, own.opacity, 1e-5 * (1 + own.opacity));
            EXPECT_NEAR(weights[i].w, own.saturation, 1e-5);
            const glm::dvec3 expected = bend(lenses, p, frame.halfSize);
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(bent[i][k], expected[k], 1e-5);
            EXPECT_NEAR(bent[i].w, confine(lenses, std::abs(double(b[i].x)), p), 1e-5);
        }
    }
}

/// A lens somewhere in the data of raycast_compare.h.
Lens lensAt(const char* name, glm::dvec3 center, float size) {
    return {.name = name, .center = center, .size = glm::vec3(size)};
}

struct Mode {
    const char* name;
    std::function<void(Scene&)> apply;
};

const Mode kModes[] = {
    {"replaced",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .density = 3}},
                     {"", true, IsoLayer{.channel = "b", .value = 0.55, .opacity = 0.7f}, "inner"},
                     {"", true, VolumeLayer{.channel = "b", .shaded = false}, "inner"},
                     {"", true, IsoLayer{.channel = "a", .value = 320}, "missing"}};
         s.lenses = {lensAt("inner", s.cursor, 0.25f)};
     }},
    {"plain",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .shaded = false}},
                     {"", true, VolumeLayer{.channel = "b", .shaded = false}, "inner"}};
         s.lenses = {lensAt("inner", s.cursor, 0.3f)};
         s.lenses[0].strength = 0.6f;
     }},
    {"stacked",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .density = 3}},
                     {"", true, IsoLayer{.channel = "b", .value = 0.55}, "first"},
                     {"", true, VolumeLayer{.channel = "a", .density = 5}, "second", "own"},
                     {"", true, SliceLayer{.channel = "b", .orientation = SliceOrientation::Y, .opacity = 0.8f}}};
         s.transfer["own"].colormap = "plasma";
         s.transfer["own"].opacity = {{0, 0.1f}, {1, 0.02f}};
         s.lenses = {lensAt("first", s.cursor, 0.3f), lensAt("second", s.cursor - 3.0, 0.25f),
                     lensAt("third", s.cursor + 3.0, 0.2f)};
         s.lenses[1].shape = LensShape::Box;
         s.lenses[1].rotation = {20, 35, -10};
         s.lenses[2].effect = LensEffect::Suppress;
     }},
    {"only in a turned cylinder",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .density = 3}},
                     {"", true, SliceLayer{.channel = "b", .orientation = SliceOrientation::X}}};
         s.lenses = {lensAt("only", s.cursor, 0.35f), lensAt("more", s.cursor + 2.0, 0.2f)};
         s.lenses[0].effect = LensEffect::Only;
         s.lenses[0].shape = LensShape::Cylinder;
         s.lenses[0].rotation = {40, 10, 0};
         s.lenses[1].effect = LensEffect::Enhance;
         s.lenses[1].strength = 0.5f;
     }},
    {"magnified",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .density = 4}},
                     {"", true, IsoLayer{.channel = "b", .value = 0.55, .opacity = 0.6f}}};
         s.lenses = {lensAt("larger", s.cursor, 0.4f)};
         s.lenses[0].effect = LensEffect::Magnify;
     }},
    {"magnified classes",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .classification = Classification::Pre}},
                     {"", true, VolumeLayer{.channel = "b", .classification = Classification::PreIntegrated}},
                     {"", true, SliceLayer{.channel = "a", .orientation = SliceOrientation::Y, .opacity = 0.7f}}};
         s.lenses = {lensAt("disc", s.cursor, 0.25f), lensAt("box", s.cursor - 4.0, 0.3f)};
         s.lenses[0].effect = s.lenses[1].effect = LensEffect::Magnify;
         s.lenses[0].shape = LensShape::Disc;
         s.lenses[1].shape = LensShape::Box;
     }},
    {"projections",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .style = RayStyle::Maximum}},
                     {"", true, VolumeLayer{.channel = "b", .style = RayStyle::XRay, .density = 0.3f}, "disc"},
                     {"", true, VolumeLayer{.channel = "b", .style = RayStyle::Average}}};
         s.lenses = {lensAt("disc", s.cursor, 0.2f)};
         s.lenses[0].shape = LensShape::Disc;
     }},
    {"brushed and confined",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .density = 3}}};
         s.selection.brushes = {rangeBrush({{"b", 0.1, 0.9, 0.2}}), {.inverted = true, .region = LensRegion{"small"}}};
         s.selection.contextLightness = 1.5f;
         s.selection.contextOpacity = 0.3f;
         s.lenses = {lensAt("focus", s.cursor, 0.3f), lensAt("small", s.cursor, 0.1f)};
         s.lenses[0].effect = LensEffect::Focus;
         s.lenses[1].effect = LensEffect::Suppress;
         s.lenses[1].strength = 0.2f;
     }},
    {"what is brushed",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .density = 3}},
                     {"", true, IsoLayer{.channel = "a", .value = 320, .opacity = 0.6f}, "brushed"},
                     {"", true, VolumeLayer{.channel = "b", .shaded = false}, "brushed"},
                     {"", true, SliceLayer{.channel = "b", .orientation = SliceOrientation::Y, .opacity = 0.8f}}};
         for (Layer& layer : s.layers) layer.brushes = BrushEffect::None;
         s.selection.brushes = {rangeBrush({{"b", 0.3, 0.6, 0.3}})};
         s.lenses = {lensAt("brushed", s.cursor, 0.3f), lensAt("rest", s.cursor, 0.2f)};
         s.lenses[0].shape = s.lenses[1].shape = LensShape::Selection;
         s.lenses[1].effect = LensEffect::Suppress;
         s.lenses[1].inverted = true;
     }},
    {"projections of what is brushed",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .style = RayStyle::Maximum}},
                     {"", true, VolumeLayer{.channel = "b", .style = RayStyle::Average}, "brushed"}};
         s.selection.brushes = {rangeBrush({{"b", 0.3, 0.6, 0.3}})};
         s.lenses = {lensAt("brushed", s.cursor, 0.3f)};
         s.lenses[0].shape = LensShape::Selection;
     }},
    {"shadows",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "a", .density = 3}},
                     {"", true, IsoLayer{.channel = "b", .value = 0.9, .opacity = 0.6f}, "inner"}};
         s.lenses = {lensAt("inner", s.cursor, 0.3f)};
         s.lighting.shadows = {.strength = 0.9f, .occlusion = 0.8f, .resolution = 24};
     }},
};

class LensPictures : public testing::TestWithParam<Case> {
protected:
    HeadlessContext context;
};

INSTANTIATE_TEST_SUITE_P(Lattices, LensPictures,
                         testing::Values(Case{LatticeKind::CC, false}, Case{LatticeKind::BCC, true}),
                         [](const auto& each) { return each.param.name(); });

TEST_P(LensPictures, AgreeWithTheReference) {
    Drawing drawing(GetParam().kind, GetParam().masked, true);
    for (const Mode& mode : kModes)
        for (bool perspective : {false, true}) {
            Scene scene = baseScene(perspective);
            mode.apply(scene);
            const Linear got = drawing.draw(scene), wanted = drawing.truth(scene);
            const std::string name = GetParam().name() + " lens " + mode.name + (perspective ? " p" : "");
            const reference::Difference difference = reference::compare(got, wanted, kOutlier);
            EXPECT_TRUE(difference.rmseWithin <= 4 * kRmse && difference.beyond <= kOutliers)
                << name << ": " << words(difference) << "; " << evidence(name, got, wanted);
            Scene without = scene;
            without.lenses.clear();
            for (Layer& layer : without.layers) layer.lens.clear();
            EXPECT_GT(reference::compare(drawing.truth(without), wanted, kOutlier).rmse, 1e-3) << name;
        }
}

/// A sharp lens over half of the picture shows one scene on its side of the edge, the other scene on the other.
TEST_P(LensPictures, OverHalfTheVolumeStitchTwoPictures) {
    Drawing drawing(GetParam().kind, GetParam().masked, true);
    const VolumeLayer outer{.channel = "a", .density = 3};
    const std::vector<Technique> inners{
        IsoLayer{.channel = "b", .value = 0.55}, VolumeLayer{.channel = "b", .shaded = false},
        SliceLayer{.channel = "a", .orientation = SliceOrientation::Z}, VolumeLayer{.channel = "a", .density = 0.5f}};
    for (const Technique& inner : inners) {
        Scene scene = baseScene(false);
        scene.camera.orientation = glm::quat(1, 0, 0, 0); // along -z, x to the right
        scene.camera.target = {};
        Scene first = scene, second = scene;
        first.layers = {{"", true, outer}};
        second.layers = {{"", true, inner}};
        scene.layers = {{"", true, outer}, {"", true, inner, "half"}};
        const WorldFrame frame = worldFrame(drawing.data->info(), scene.stretch);
        // Its left face is at x = 0, between two columns of pixels.
        scene.lenses = {{.name = "half",
                         .shape = LensShape::Box,
                         .center = frame.toPhysical({1, 0, 0}),
                         .size = {1, 2, 2},
                         .rim = 0}};
        const Linear got = drawing.draw(scene), left = drawing.draw(first), right = drawing.draw(second);
        for (std::size_t i = 0; i < got.pixels.size(); ++i) {
            const bool onLeft = int(i) % kSize.x < kSize.x / 2;
            const glm::dvec4 expected = (onLeft ? left : right).pixels[i];
            for (int k = 0; k < 4; ++k) ASSERT_NEAR(got.pixels[i][k], expected[k], 2e-6) << i << " " << inner.index();
        }
        // Cutting is the same with nothing to stand in.
        scene.layers.pop_back();
        const Linear cut = drawing.draw(scene);
        for (std::size_t i = 0; i < cut.pixels.size(); ++i)
            EXPECT_TRUE(int(i) % kSize.x < kSize.x / 2 || cut.pixels[i].a == 0) << i;
    }
}

/// A layer that is shown at another time is what all of the picture is at that time.
TEST_P(LensPictures, LayersMayShowAnotherTime) {
    volume::Dataset dataset;
    dataset.info.lattice.size = {12, 12, 12};
    dataset.info.bounds = {glm::dvec3(0), glm::dvec3(11)};
    dataset.info.times = {0, 1, 2};
    volume::Parameter parameter;
    parameter.name = "a";
    parameter.ranges = {{0, 4}};
    dataset.info.parameters = {parameter};
    dataset.read = [lattice = dataset.info.lattice](int, int, int time) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        for (std::size_t i = 0; i < field.count(); ++i) field.as<float>()[i] = float(time) + float(i % 12) / 12;
        return field;
    };
    Renderer renderer;
    renderer.setSource(volume::makeMemorySource(dataset, {.lattice = GetParam().kind, .brickSize = 8}));
    const ViewTargetPtr target = renderer.makeTarget();
    const auto draw = [&](const Scene& scene) {
        FrameRequest request;
        request.size = kSize;
        request.wait = true;
        EXPECT_TRUE(renderer.render(*target, scene, request).complete);
        return renderer.readLinear(*target);
    };
    Scene scene = baseScene(false);
    scene.layers = {{"", true, VolumeLayer{.channel = "a", .shaded = false}}};
    scene.transfer["a"].opacity = {{0, 0.01f}, {1, 0.2f}};
    Scene later = scene;
    later.time = 2;
    const auto first = draw(scene), wanted = draw(later);
    scene.layers[0].timeShift = 2;
    EXPECT_EQ(draw(scene), wanted);
    EXPECT_NE(first, wanted);
    scene.layers[0].lens = "all";
    scene.lenses = {{.name = "all", .shape = LensShape::Box, .center = glm::dvec3(5.5), .size = glm::vec3(2)}};
    scene.lenses[0].rim = 0;
    EXPECT_EQ(draw(scene), wanted);
}

/// A lens that comes, goes or acts otherwise in a picture that is there already, over layers of one channel.
TEST_P(LensPictures, MayBeTurnedOnAndOff) {
    Drawing drawing(GetParam().kind, GetParam().masked, true);
    Scene scene = baseScene(false);
    scene.layers = {{"", true, VolumeLayer{.channel = "a", .shaded = false}},
                    {"", true, IsoLayer{.channel = "a", .value = 320}, "inner"},
                    {"", true, VolumeLayer{.channel = "a", .shaded = false, .density = 6}, "inner"}};
    scene.selection.brushes = {rangeBrush({{"a", 318, 330, 1}})};
    scene.selection.contextOpacity = 0;
    scene.lenses = {lensAt("inner", scene.cursor, 0.3f)};
    const ViewTargetPtr target = drawing.renderer.makeTarget();
    FrameRequest request;
    request.size = kSize;
    request.wait = true;
    std::optional<Linear> last;
    for (const bool enabled : {false, true, false, true})
        for (const LensEffect effect : {LensEffect::Replace, LensEffect::Focus, LensEffect::Enhance}) {
            scene.lenses[0].enabled = enabled;
            scene.lenses[0].effect = effect;
            ASSERT_TRUE(drawing.renderer.render(*target, scene, request).complete);
            Linear got;
            got.size = kSize;
            for (const glm::vec4& pixel : drawing.renderer.readLinear(*target)) got.pixels.emplace_back(pixel);
            const Linear wanted = drawing.draw(scene);
            EXPECT_LT(reference::compare(got, wanted, 1).rmse, 1e-6) << enabled << ' ' << int(effect);
            if (last && enabled) {
                EXPECT_GT(reference::compare(*last, wanted, 1).rmse, 1e-3) << int(effect);
            }
            last = wanted;
        }
}

} // namespace
} // namespace tessera::vis
