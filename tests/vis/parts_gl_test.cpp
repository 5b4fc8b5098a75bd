#include "tests/vis/parts_drawing.h"

#include "vis/shapes/proxy.h"

#include <functional>

/// Regions that are never mixed, in pictures: nothing but what each of them holds is seen, and the shader draws what
/// the reference draws.
namespace tessera::vis {
namespace {

struct PartsMode {
    const char* name;
    std::function<void(Scene&)> apply;
    double rmse = 1.5 * kRmse;
    double psnr16 = kPsnr16;
};

const PartsMode kPartsModes[] = {
    {"composite",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "gas", .shaded = false}}};
     }},
    {"shaded",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "heat", .density = 3}}};
     }},
    {"classified before",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "gas", .classification = Classification::Pre}}};
     }},
    {"pre-integrated",
     [](Scene& s) {
         s.layers = {
             {"", true, VolumeLayer{.channel = "gas", .classification = Classification::PreIntegrated, .density = 2}}};
     },
     3 * kRmse}, // the table's entries are 256 to the range
    {"gradient",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "gas", .quantity = Quantity::Gradient, .density = 3}}};
         s.transfer["gas"].gradientTop = 0.01f;
         s.transfer["gas"].opacity = {{0, 0}, {1, 0.2f}};
     }},
    {"surfaces",
     [](Scene& s) {
         s.layers = {{"", true, IsoLayer{.channel = "gas", .value = 0.99, .opacity = 0.7f}},
                     {"", true, IsoLayer{.channel = "heat", .value = 2.0, .opacity = 0.6f}},
                     {"", true, VolumeLayer{.channel = "smooth", .density = 0.3f}}};
     }},
    {"maximum",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "gas", .style = RayStyle::Maximum, .density = 5}}};
     }},
    {"x-ray",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "heat", .style = RayStyle::XRay, .density = 0.5f}}};
     }},
    {"slices",
     [](Scene& s) {
         s.layers = {{"", true, SliceLayer{.channel = "gas", .orientation = SliceOrientation::X}},
                     {"", true,
                      SliceLayer{.channel = "heat",
                                 .orientation = SliceOrientation::Oblique,
                                 .atCursor = false,
                                 .position = 0.4,
                                 .normal = {0.3f, 0.5f, -0.8f},
                                 .opacity = 0.6f}}};
     }},
    {"brushes",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "smooth"}}};
         s.selection.brushes = {rangeBrush({{"gas", 0.95, 1.4, 0.2}, {"smooth", 0.1, 0.8, 0.1}})};
         s.selection.contextOpacity = 0.1f;
     }},
    {"shadows",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "heat", .density = 2}},
                     {"", true, IsoLayer{.channel = "gas", .value = 0.97, .opacity = 0.6f}}};
         s.lighting.shadows = {.strength = 0.9f, .occlusion = 0.8f, .resolution = 24};
     }},
    {"a lens that magnifies",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "gas", .density = 2}}};
         s.lenses = {{.effect = LensEffect::Magnify, .center = s.cursor, .size = glm::vec3(0.25f)}};
     }},
    {"three parts",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "three", .density = 2}},
                     {"", true, SliceLayer{.channel = "three", .orientation = SliceOrientation::Z, .opacity = 0.7f}}};
         s.transfer["three"] = fog();
         s.transfer["three"].range = {0.8, 3.2};
     }},
    {"longer steps",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "heat", .shaded = false, .density = 0.3f}}};
         s.render.adaptiveStep = 0.1f;
     },
     3 * kRmse}, // a sample, and its rounding, stands for several
    {"outlined",
     [](Scene& s) {
         VolumeLayer layer{.channel = "gas", .density = 3};
         layer.look.silhouette = SilhouetteEnhancement{};
         layer.look.cartoon = Cartoon{};
         s.layers = {{"", true, layer}};
     },
     1.5 * kRmse, 56}, // the width of outlines follows second differences of the rounded samples
};

class PartsPictures : public testing::TestWithParam<LatticeKind> {
protected:
    HeadlessContext context;
};
INSTANTIATE_TEST_SUITE_P(Lattices, PartsPictures, testing::Values(LatticeKind::CC, LatticeKind::BCC),
                         [](const auto& each) { return std::string(volume::kLatticeNames[std::size_t(each.param)]); });

TEST_P(PartsPictures, AgreeWithTheReferenceAndSixteenBitsAreClose) {
    const auto data = regionSource(GetParam(), Regions::Sloped, true);
    Drawn drawn(data), rounded(data, false, false);
    for (std::size_t i = 0; i < std::size(kPartsModes); ++i) {
        const PartsMode& mode = kPartsModes[i];
        Scene scene = regionScene();
        scene.transfer["gas"] = scene.transfer["heat"] = fog();
        mode.apply(scene);
        const Linear wanted = drawn.truth(scene);
        // Most of the time goes to shaders: each mode is drawn of floats on one lattice, and rounded on the other.
        if ((i % 2 == 0) == (GetParam() == LatticeKind::BCC)) {
            drawn.check(mode.name, scene, wanted, mode.rmse);
            continue;
        }
        const reference::Difference rounding = reference::compare(rounded.draw(scene), wanted, kOutlier);
        EXPECT_GE(rounding.psnr, mode.psnr16) << mode.name << ": " << words(rounding);
    }
}

TEST_P(PartsPictures, AgreeWithTheReferenceInBricksAndBetweenTimes) {
    Drawn bricked(regionSource(GetParam(), Regions::Sloped, true), true);
    Drawn series(std::make_shared<RegionSeries>(GetParam(), Regions::Sloped, true));
    for (std::size_t filter = 0; filter < std::size(kFilterNames); ++filter) {
        const PartsMode& mode = kPartsModes[filter == 0 ? 5 : 1]; // surfaces, shaded
        Scene scene = regionScene(false);
        scene.transfer["gas"] = scene.transfer["heat"] = fog();
        scene.render.filter = Filter(filter);
        mode.apply(scene);
        const std::string name = std::string(mode.name) + " " + std::string(kFilterNames[filter]);
        bricked.check(name + " in bricks", scene);
        scene.time = 0.37;
        series.check(name + " between times", scene);
    }
}

/// Techniques that would show a value between what the regions hold.
const PartsMode kFilled[] = {
    {"composite",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "heat", .shaded = false}}};
     }},
    {"pre-integrated",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "heat", .classification = Classification::PreIntegrated}}};
     }},
    {"x-ray",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "gas", .style = RayStyle::XRay, .density = 3}}};
     }},
    {"surface",
     [](Scene& s) {
         s.layers = {{"", true, IsoLayer{.channel = "gas", .value = 1.5}}};
     }},
    {"planes",
     [](Scene& s) {
         s.layers = {{"", true, VolumeLayer{.channel = "heat", .shaded = false}}};
         s.render.proxy = Proxy::Slices;
     }},
};

/// Only what the regions hold is seen; without parts the same picture shows what neither holds.
void expectNothingBetween(LatticeKind kind, Regions regions, const std::function<void(Scene&)>& apply,
                          const std::string& name, bool bricked, double time) {
    for (const bool parts : {true, false}) {
        Drawn drawn(std::make_shared<RegionSeries>(kind, regions, parts), bricked);
        Scene scene = regionScene(!bricked);
        scene.transfer["gas"] = scene.transfer["heat"] = between();
        scene.time = time;
        apply(scene);
        const double shader = Drawn::greatest(drawn.draw(scene));
        const double judge =
            drawnByProxy(scene) ? shader : Drawn::greatest(reference::render(scene, *drawn.data, kSize, {}));
        if (parts) {
            EXPECT_EQ(shader, 0) << name;
            EXPECT_EQ(judge, 0) << name;
        } else {
            EXPECT_GT(shader, 0.05) << name << " tests nothing";
            EXPECT_GT(judge, 0.05) << name << " tests nothing";
        }
    }
}

TEST_P(PartsPictures, ShowNoValueThatNoRegionHolds) {
    for (const PartsMode& mode : kFilled) {
        expectNothingBetween(GetParam(), Regions::Constant, mode.apply, mode.name, true, 0);
        expectNothingBetween(GetParam(), Regions::Sloped, mode.apply, mode.name, false, 0.4);
    }
}

TEST_P(PartsPictures, EveryFilterKeepsRegionsApart) {
    for (std::size_t filter = 0; filter < std::size(kFilterNames); ++filter) {
        const auto apply = [&](Scene& scene) {
            kFilled[0].apply(scene);
            scene.render.filter = Filter(filter);
        };
        expectNothingBetween(GetParam(), Regions::Sloped, apply, std::string(kFilterNames[filter]), false, 0.6);
    }
}

TEST_P(PartsPictures, CoarseBricksKeepRegionsApart) {
    const auto coarse = [](Scene& scene) {
        kFilled[0].apply(scene);
        scene.render.detail = 1000; // the coarsest level will do everywhere
    };
    expectNothingBetween(GetParam(), Regions::Sloped, coarse, "coarse", true, 0);
    expectNothingBetween(GetParam(), Regions::Sloped, coarse, "coarse, between times", true, 0.3);
}

/// Every pixel of a slice has the colour of a value that is held by the region at its place.
TEST_P(PartsPictures, SlicesShowEachPlaceInItsOwnRegion) {
    Drawn drawn(regionSource(GetParam(), Regions::Constant, true));
    Scene scene = regionScene(false);
    scene.layers = {{"", true, SliceLayer{.channel = "heat", .orientation = SliceOrientation::X}}};
    scene.camera.orientation = standardOrientation(StandardView::Right);
    scene.transfer["heat"] = fog();
    const Linear image = drawn.draw(scene);
    const auto expected = [&](double value) {
        return linearFromSrgb(glm::dvec3(evaluate(scene.transfer["heat"], {0.8, 2.2}, value)));
    };
    std::size_t lower = 0, upper = 0;
    for (const glm::dvec4& pixel : image.pixels) {
        if (pixel.a == 0) continue;
        const bool one = glm::length(glm::dvec3(pixel) - expected(1)) < 1e-3;
        const bool two = glm::length(glm::dvec3(pixel) - expected(2)) < 1e-3;
        EXPECT_TRUE(one || two) << pixel.r << ' ' << pixel.g << ' ' << pixel.b;
        lower += one;
        upper += two;
    }
    EXPECT_GT(lower, 200u);
    EXPECT_GT(upper, 200u);
}

/// Of constants every gradient is 0, up to the border: a layer of gradients shows nothing.
TEST_P(PartsPictures, GradientsStayWithinARegion) {
    for (const bool parts : {true, false}) {
        Drawn drawn(regionSource(GetParam(), Regions::Constant, parts));
        Scene scene = regionScene();
        scene.layers = {{"", true, VolumeLayer{.channel = "heat", .quantity = Quantity::Gradient}}};
        scene.transfer["heat"] = fog();
        scene.transfer["heat"].gradientTop = 0.05f;
        scene.transfer["heat"].opacity = {{0, 0}, {0.02f, 0}, {0.03f, 1}, {1, 1}};
        const double shader = Drawn::greatest(drawn.draw(scene));
        if (parts)
            EXPECT_EQ(shader, 0);
        else
            EXPECT_GT(shader, 0.5);
    }
}

/// Contour lines lie where the value passes a level, not where it jumps over one.
TEST_P(PartsPictures, ContoursAreNotDrawnWhereTheValueJumps) {
    for (const bool parts : {true, false}) {
        Drawn drawn(regionSource(GetParam(), Regions::Constant, parts));
        Scene scene = regionScene(false);
        scene.transfer["heat"] = fog();
        scene.layers = {{"", true, SliceLayer{.channel = "heat", .orientation = SliceOrientation::Z}}};
        const Linear plain = drawn.draw(scene);
        std::get<SliceLayer>(scene.layers[0].technique).contours = 4;
        const Linear lines = drawn.draw(scene);
        double most = 0;
        for (std::size_t i = 0; i < plain.pixels.size(); ++i)
            most = std::max(most, glm::length(plain.pixels[i] - lines.pixels[i]));
        if (parts)
            EXPECT_LT(most, 1e-4);
        else
            EXPECT_GT(most, 0.05);
    }
    // Where it does pass one they are as they were.
    Scene scene = regionScene(false);
    scene.layers = {{"", true, SliceLayer{.channel = "gas", .orientation = SliceOrientation::Z, .contours = 40}}};
    scene.transfer["gas"] = fog();
    Drawn with(regionSource(GetParam(), Regions::Sloped, true)),
        without(regionSource(GetParam(), Regions::Sloped, false));
    const Linear got = with.draw(scene), other = without.draw(scene);
    std::get<SliceLayer>(scene.layers[0].technique).contours = 0;
    const Linear plain = with.draw(scene);
    std::size_t lines = 0, same = 0;
    for (std::size_t i = 0; i < got.pixels.size(); ++i) {
        if (glm::length(got.pixels[i] - plain.pixels[i]) < 0.02) continue;
        ++lines;
        same += glm::length(got.pixels[i] - other.pixels[i]) < 0.1;
    }
    EXPECT_GT(lines, 100u);
    EXPECT_GT(same, lines * 2 / 3);
}

} // namespace
} // namespace tessera::vis
