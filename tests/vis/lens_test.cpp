#include "vis/scene/lens.h"

#include "vis/raycast/ray_plan.h"
#include "vis/scene/selection.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

namespace tessera::vis {
namespace {

std::mt19937 lensRandom(5);

glm::dvec3 vector(double most) {
    std::uniform_real_distribution<double> number(-most, most);
    return {number(lensRandom), number(lensRandom), number(lensRandom)};
}

PlacedLens place(const Lens& lens, const Camera& camera = {}) {
    return placeLenses({lens}, {}, camera, glm::dvec3(0.1)).front();
}

TEST(Lens, WeightsFallFromOneToZeroOverTheRim) {
    for (int i = 0; i < 400; ++i) {
        Lens lens;
        lens.shape = LensShape(i % 4);
        lens.center = vector(0.3);
        lens.size = glm::vec3(glm::abs(vector(0.3))) + 0.05f;
        lens.rotation = glm::vec3(vector(180));
        lens.rim = i % 5 == 0 ? 0.0f : 0.4f;
        const PlacedLens placed = place(lens);
        EXPECT_EQ(placed.weight(lens.center), 1);
        const glm::dvec3 way = glm::normalize(vector(1));
        double before = 1, seen = -1;
        for (int k = 0; k < 300; ++k) {
            const double t = k * 0.01;
            const glm::dvec3 p = lens.center + t * 0.1 * way;
            const double r = placed.radius(p), weight = placed.weight(p);
            EXPECT_LE(weight, before + 1e-12) << "grows on the way out";
            EXPECT_EQ(weight == 0, r >= 1);
            EXPECT_TRUE(weight == 1 || r > 1 - double(lens.rim) - 1e-12);
            // The radius grows along a ray as the distance does.
            if (k == 50) seen = r;
            EXPECT_TRUE(lens.shape == LensShape::Disc || k < 50 || std::abs(r / seen - t / 0.5) < 1e-9);
            before = weight;
        }
        lens.inverted = true;
        const glm::dvec3 p = lens.center + vector(0.3);
        EXPECT_NEAR(place(lens).weight(p), 1 - placed.weight(p), 1e-12);
    }
}

TEST(Lens, ShapesHaveTheirSizes) {
    Lens lens{.size = {0.2f, 0.1f, 0.4f}, .rim = 0};
    EXPECT_NEAR(place(lens).radius({0.2, 0, 0}), 1, 1e-6);
    EXPECT_NEAR(place(lens).radius({0, 0, 0.2}), 0.5, 1e-6);
    lens.shape = LensShape::Box;
    EXPECT_NEAR(place(lens).radius({0.1, 0.1, 0.2}), 1, 1e-6);
    lens.shape = LensShape::Cylinder;
    EXPECT_NEAR(place(lens).radius({0.2 * std::sqrt(0.5), 0.1 * std::sqrt(0.5), 0}), 1, 1e-6);
    EXPECT_NEAR(place(lens).radius({0, 0, 0.4}), 1, 1e-6);
    lens.rotation = {0, 0, 90}; // its x lies along y
    EXPECT_NEAR(place(lens).radius({0, 0.2, 0}), 1, 1e-6);
    lens.followsCursor = true;
    EXPECT_NEAR(place(lens).radius({0.1, 0.1, 0.1}), 0, 1e-6);
}

/// A disc is a circle in the picture, of the size it has at its middle, at every depth.
TEST(Lens, DiscsFaceTheViewer) {
    for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
        Camera camera;
        camera.projection = projection;
        camera.target = {0.1f, -0.2f, 0.05f};
        Lens lens{.shape = LensShape::Disc, .center = {0.1, 0.05, -0.1}, .size = glm::vec3(0.15f)};
        const PlacedLens placed = place(lens, camera);
        const glm::dmat4 view = viewMatrix(camera), clip = projectionMatrix(camera, 1);
        const auto ndc = [&](glm::dvec3 p) {
            const glm::dvec4 at = clip * view * glm::dvec4(p, 1);
            return glm::dvec2(at) / at.w;
        };
        const double depth = (view * glm::dvec4(lens.center, 1)).z;
        const double radius = ndc(glm::dvec3(glm::inverse(view) * glm::dvec4(0.15, 0, depth, 1))).x -
                              ndc(glm::dvec3(glm::inverse(view) * glm::dvec4(0, 0, depth, 1))).x;
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 p = vector(0.5);
            EXPECT_NEAR(placed.radius(p), glm::length(ndc(p) - ndc(lens.center)) / radius, 1e-6);
        }
    }
}

TEST(Lens, MagnifiesTheMiddleAndLeavesTheOutside) {
    for (const LensShape shape : {LensShape::Sphere, LensShape::Box, LensShape::Cylinder, LensShape::Disc}) {
        Lens lens{.shape = shape, .effect = LensEffect::Magnify, .size = {0.3f, 0.3f, 0.2f}, .magnification = 4};
        lens.rotation = {20, 50, -70};
        Camera camera;
        camera.projection = Projection::Orthographic;
        const PlacedLens placed = place(lens, camera);
        const auto right = glm::dvec3(glm::transpose(glm::mat3_cast(camera.orientation))[0]);
        EXPECT_NEAR(glm::length(placed.bend(right * 1e-5)) * 4 / 1e-5, 1, 1e-3);
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 p = vector(0.4), bent = placed.bend(p);
            const double r = placed.radius(p), at = placed.radius(bent);
            EXPECT_TRUE(r < 1 || bent == p);
            EXPECT_NEAR(at, std::min(r / (1 + 3 * (1 - std::min(r, 1.0))), r), 1e-6);
        }
        const glm::dvec3 edge = 0.99999 * placed.center + right * (0.99999 / placed.radius(right));
        EXPECT_NEAR(glm::length(placed.bend(edge) - edge), 0, 1e-4) << "tears at its edge";
    }
    const Lens lens{.effect = LensEffect::Magnify, .center = {0.7, 0, 0}, .size = glm::vec3(0.4f), .magnification = 8};
    const auto lenses = placeLenses({lens}, {}, {}, {});
    EXPECT_LE(bend(lenses, {0.49, 0.1, 0}, glm::dvec3(0.5)).x, 0.5) << "leaves the box";
}

TEST(Lens, ActsOnWhatLiesBelow) {
    Lens replace{.name = "a", .rim = 0.5f}, enhance = replace, only = replace, suppress = replace;
    enhance.effect = LensEffect::Enhance;
    suppress.effect = LensEffect::Suppress;
    suppress.strength = 0.5f;
    only.effect = LensEffect::Only;
    const glm::dvec3 inside(0), outside(0.5, 0, 0), rim(0.15, 0, 0);
    const auto at = [&](std::vector<Lens> lenses, int own, glm::dvec3 p) {
        return lensAction(placeLenses(lenses, {}, {}, {}), own, p);
    };
    EXPECT_EQ(at({replace}, -1, inside).opacity, 0);
    EXPECT_EQ(at({replace}, 0, inside).opacity, 1);
    EXPECT_EQ(at({replace}, 0, outside).opacity, 0);
    EXPECT_NEAR(at({replace}, 0, rim).opacity + at({replace}, -1, rim).opacity, 1, 1e-12) << "they blend";
    EXPECT_EQ(at({only}, -1, inside).opacity, 1);
    EXPECT_EQ(at({only}, -1, outside).opacity, 0);
    EXPECT_NEAR(at({enhance}, -1, inside).opacity, 8, 1e-6);
    EXPECT_NEAR(at({suppress}, -1, inside).opacity, 1 / std::sqrt(8.0), 1e-6);
    EXPECT_EQ(at({suppress}, -1, inside).saturation, 0.5);
    EXPECT_EQ(at({suppress}, -1, outside).saturation, 1);
    EXPECT_EQ(at({replace, replace}, 0, inside).opacity, 0) << "the second lies over the first";
    EXPECT_EQ(at({replace, replace}, 1, inside).opacity, 1);
    replace.strength = 0;
    EXPECT_EQ(at({replace}, -1, inside).opacity, 1);
    replace.enabled = false;
    EXPECT_TRUE(placeLenses({replace}, {}, {}, {}).empty());
    EXPECT_EQ(placeLenses(std::vector<Lens>(20), {}, {}, {}).size(), std::size_t(kMaxLenses));
}

TEST(Lens, OfASelectionWeighsByTheDegreeOfInterestAlone) {
    Lens lens{.shape = LensShape::Selection};
    const glm::dvec3 anywhere(0.3, -0.2, 0.1);
    for (const bool inverted : {false, true}) {
        lens.inverted = inverted;
        const PlacedLens placed = place(lens);
        for (const double doi : {0.0, 0.25, 1.0}) {
            const double weight = inverted ? 1 - doi : doi;
            EXPECT_EQ(placed.weight(anywhere, doi), weight);
            EXPECT_EQ(placed.weight(lens.center, doi), weight) << "its centre says nothing";
            EXPECT_NEAR(lensAction({placed}, -1, anywhere, doi).opacity, 1 - weight, 1e-12);
            EXPECT_NEAR(lensAction({placed}, 0, anywhere, doi).opacity, weight, 1e-12);
        }
    }
    lens.effect = LensEffect::Focus;
    EXPECT_EQ(confine({place(lens)}, 0.25, anywhere), 0.25) << "brushes cannot be confined to themselves";
    lens.effect = LensEffect::Magnify;
    lens.inverted = false;
    EXPECT_EQ(place(lens).bend(anywhere), anywhere);
}

TEST(Lens, ActsBetweenItsTimesAlone) {
    Lens lens{.name = "brief"};
    lens.fromTime = 0.5;
    lens.untilTime = 2;
    const auto acts = [&](double time) { return placeLenses({lens}, {}, {}, {}, time).size() == 1; };
    for (const auto& [time, wanted] : {std::pair{0.0, false}, {0.5, true}, {1.0, true}, {2.0, true}, {2.1, false}}) {
        EXPECT_EQ(acts(time), wanted) << time;
        Scene scene;
        scene.time = time;
        scene.lenses = {lens};
        EXPECT_EQ(placeLenses(scene, {}).size(), wanted ? 1u : 0u) << time;
    }
    lens.fromTime.reset();
    EXPECT_TRUE(acts(-1e9) && acts(2) && !acts(3));
    lens.fromTime = 1, lens.untilTime.reset();
    EXPECT_TRUE(!acts(0.9) && acts(1e9));
    lens.enabled = false;
    EXPECT_FALSE(acts(5));
}

TEST(Lens, BrushesWhatLiesInIt) {
    WorldFrame frame;
    frame.scale = glm::dvec3(10);
    Lens lens{.name = "a", .center = {0.03, 0, 0}, .size = glm::vec3(0.1f)}, other = lens;
    other.name = "b";
    other.center = {-0.03, 0, 0};
    other.marks = false;
    const LensSpace space{placeLenses({lens, other}, frame, {}, {}), frame};
    Selection selection;
    selection.brushes = {{.region = LensRegion{"b"}}};
    EXPECT_TRUE(selectsSpace(selection));
    EXPECT_TRUE(selectsLens(selection));
    const auto at = [&](double x) { return DoiFunction(selection, space)({}, {x, 0, 0}); };
    EXPECT_EQ(at(-0.03), 1);
    EXPECT_EQ(at(0.03), 0);
    EXPECT_NEAR(at(-0.03925), 0.5, 1e-6);
    selection.brushes[0].region = LensRegion{};
    EXPECT_EQ(at(0.03), 1) << "all that mark";
    EXPECT_EQ(at(-0.03), 0);
    EXPECT_EQ(DoiFunction(selection)({}, {0.03, 0, 0}), 0) << "no lens, nothing in it";

    lens.effect = LensEffect::Focus;
    lens.strength = 0.5f;
    const auto confining = placeLenses({lens}, frame, {}, {});
    EXPECT_EQ(confine(confining, 0.2, {0.3, 0, 0}), 0.2);
    EXPECT_NEAR(confine(confining, 0.2, {0.5, 0, 0}), 0.6, 1e-12) << "outside half as much";
}

/// Dragging, resizing, turning or fading a lens must not want another program; scenes without lenses have none of it.
TEST(Lens, ProgramsDependOnKindsAlone) {
    volume::DatasetInfo info;
    info.lattice.size = {4, 4, 4};
    info.parameters.resize(1);
    info.parameters[0].name = "a";
    Scene scene;
    scene.layers = {{"", true, VolumeLayer{.channel = "a"}}, {"", true, IsoLayer{.channel = "a"}, "one"}};
    const auto key = [&] { return rayRecipe(planRays(scene, info), scene, {}, false).key(); };
    const std::string none = key();
    EXPECT_EQ(planRays(scene, info).layers.size(), 1u) << "its lens is missing";
    scene.lenses = {{.name = "one"}};
    const std::string one = key();
    EXPECT_NE(none, one);
    scene.lenses[0].center = {1, 2, 3};
    scene.lenses[0].size = {0.01f, 1, 1};
    scene.lenses[0].rotation = {1, 2, 3};
    scene.lenses[0].strength = 0;
    scene.lenses[0].rim = 0;
    scene.lenses[0].inverted = true;
    EXPECT_EQ(key(), one);
    scene.lenses[0].shape = LensShape::Box;
    EXPECT_NE(key(), one);
}

} // namespace
} // namespace tessera::vis
