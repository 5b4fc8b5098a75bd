#include "vis/glyphs/glyph_parts.h"
#include "vis/glyphs/glyph_shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <limits>

namespace tessera::vis {
namespace {

constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
constexpr GlyphKind kAllKinds[] = {GlyphKind::Arrow,       GlyphKind::Cone,         GlyphKind::SixSided,
                                   GlyphKind::Star,        GlyphKind::Bars,         GlyphKind::Pie,
                                   GlyphKind::JumpingJack, GlyphKind::Superquadric, GlyphKind::Ellipsoid};

std::vector<double> atRest(GlyphKind kind) {
    return std::vector<double>(glyphPartNames(kind).size(), kPartAtRest);
}
GlyphShape shapeOf(GlyphKind kind, const std::vector<double>& values, int sides = 24) {
    GlyphShape shape;
    makeGlyphShape(kind, values, sides, shape);
    return shape;
}
/// With the own parts set to some values, in order.
GlyphShape withParts(GlyphKind kind, std::initializer_list<double> own, int sides = 24) {
    std::vector<double> values = atRest(kind);
    std::ranges::copy(own, values.begin() + kCommonGlyphParts);
    return shapeOf(kind, values, sides);
}
/// Vertices of a part.
std::vector<glm::dvec3> verticesOf(const GlyphShape& shape, int ownPart) {
    std::vector<glm::dvec3> out;
    for (std::size_t i = 0; i < shape.positions.size(); ++i)
        if (shape.parts[i] == ownPart + int(kCommonGlyphParts)) out.push_back(shape.positions[i]);
    return out;
}
double outermost(const std::vector<glm::dvec3>& points) {
    double most = 0;
    for (const glm::dvec3& point : points) most = std::max(most, glm::length(point));
    return most;
}
double areaOf(const GlyphShape& shape, int ownPart) {
    double area = 0;
    for (const glm::uvec3& t : shape.triangles) {
        if (shape.parts[t.z] != ownPart + int(kCommonGlyphParts)) continue;
        const glm::dvec2 a(shape.positions[t.x]), b(shape.positions[t.y]), c(shape.positions[t.z]);
        area += 0.5 * std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    }
    return area;
}

TEST(GlyphShapesTest, EveryShapeIsWholeAndStaysInItsBall) {
    for (const GlyphKind kind : kAllKinds)
        for (const int sides : {3, 6, 12, 20})
            for (const double value : {kPartAtRest, 0.0, 0.37, 1.0}) {
                std::vector<double> values = atRest(kind);
                for (std::size_t i = kCommonGlyphParts; i < values.size(); ++i)
                    values[i] = kind == GlyphKind::Ellipsoid && value > 0 ? value / 3 : value; // a tensor of length 1
                const GlyphShape shape = shapeOf(kind, values, sides);
                EXPECT_FALSE(shape.triangles.empty()) << int(kind) << " " << value;
                EXPECT_LE(outermost(shape.positions), 0.5 + 1e-12) << int(kind) << " " << value;
                ASSERT_EQ(shape.positions.size(), shape.normals.size());
                ASSERT_EQ(shape.positions.size(), shape.parts.size());
                for (const glm::uvec3& t : shape.triangles)
                    for (int i = 0; i < 3; ++i) EXPECT_LT(t[i], shape.positions.size());
                for (const glm::dvec3& at : shape.positions) EXPECT_TRUE(std::isfinite(at.x + at.y + at.z));
            }
}

TEST(GlyphShapesTest, SpokesAreAsLongAsTheirValueAndStandEvenly) {
    const double values[] = {0, 0.25, 0.5, 1};
    const GlyphShape star = withParts(GlyphKind::Star, {values[0], values[1], values[2], values[3]});
    for (int i = 0; i < 4; ++i) {
        const auto spoke = verticesOf(star, i);
        ASSERT_FALSE(spoke.empty());
        const glm::dvec3 tip = *std::ranges::max_element(spoke, {}, [](glm::dvec3 at) { return glm::length(at); });
        EXPECT_NEAR(glm::length(tip), 0.5 * (0.15 + 0.85 * values[i]), 1e-12) << i;
        const double angle = std::numbers::pi / 2 * (1 - i); // up, right, down, left
        EXPECT_NEAR(glm::dot(glm::normalize(tip), glm::dvec3(std::cos(angle), std::sin(angle), 0)), 1, 1e-12) << i;
    }
}

TEST(GlyphShapesTest, AnAbsentValueIsAGapAndALeastOneIsNot) {
    for (const GlyphKind kind :
         {GlyphKind::SixSided, GlyphKind::Star, GlyphKind::Bars, GlyphKind::Pie, GlyphKind::JumpingJack}) {
        const GlyphShape whole = withParts(kind, {0, 0, 0, 0, 0, 0});
        const GlyphShape lacking = withParts(kind, {0, kAbsent, 0, 0, 0, 0});
        for (int i = 0; i < 6; ++i) {
            EXPECT_FALSE(verticesOf(whole, i).empty()) << int(kind) << " " << i;
            EXPECT_EQ(verticesOf(lacking, i).empty(), i == 1) << int(kind) << " " << i;
            if (i == 1) continue;
            ASSERT_EQ(verticesOf(lacking, i).size(), verticesOf(whole, i).size());
            EXPECT_EQ(verticesOf(lacking, i), verticesOf(whole, i)) << "others keep their places";
        }
    }
    for (const GlyphKind kind : {GlyphKind::Arrow, GlyphKind::Cone, GlyphKind::Superquadric, GlyphKind::Ellipsoid}) {
        EXPECT_TRUE(withParts(kind, {0.3, kAbsent}).triangles.empty()) << int(kind);
        std::vector<double> values = atRest(kind);
        values[kSizePart] = kAbsent;
        EXPECT_TRUE(shapeOf(kind, values).triangles.empty()) << int(kind);
        values[kSizePart] = 1;
        values[kColorPart] = kAbsent; // drawn in the colour of no value
        EXPECT_FALSE(shapeOf(kind, values).triangles.empty()) << int(kind);
    }
}

TEST(GlyphShapesTest, BarsHaveTheHeightAndSlicesTheAreaOfTheirValue) {
    const double values[] = {0, 0.4, 1, 0.7};
    const GlyphShape bars = withParts(GlyphKind::Bars, {values[0], values[1], values[2], values[3]});
    const GlyphShape pie = withParts(GlyphKind::Pie, {values[0], values[1], values[2], values[3]}, 240);
    double left = -1;
    for (int i = 0; i < 4; ++i) {
        const auto bar = verticesOf(bars, i);
        const auto [low, high] = std::ranges::minmax(bar, {}, &glm::dvec3::y);
        EXPECT_NEAR(high.y - low.y, 0.65 * partLength(values[i]), 1e-12);
        const double x = std::ranges::min(bar, {}, &glm::dvec3::x).x;
        EXPECT_GT(x, left) << "from the left";
        left = x;
        EXPECT_NEAR(areaOf(pie, i) / areaOf(pie, 2), partLength(values[i]), 1e-9);
    }
}

TEST(GlyphShapesTest, SidesAreFilledUpToTheirValue) {
    const GlyphShape cone = withParts(GlyphKind::SixSided, {0, 0.2, 0.4, 0.6, 0.8, 1});
    for (int i = 0; i < 6; ++i) {
        const double highest = std::ranges::max(verticesOf(cone, i), {}, &glm::dvec3::z).z;
        EXPECT_NEAR((highest + 0.35) / 0.85, partLength(0.2 * i), 1e-12) << i;
    }
}

TEST(GlyphShapesTest, LimbsTurnByTheirValue) {
    const auto hand = [](double value) {
        return verticesOf(withParts(GlyphKind::JumpingJack, {0.5, value, 0.5, 0.5, 0.5, 0.5}), 1).back();
    };
    const glm::dvec3 shoulder = hand(0.5) - glm::dvec3(0.28, 0, 0); // level
    for (const double value : {0.2, 0.5, 0.9}) {
        const glm::dvec3 way = hand(value) - shoulder;
        EXPECT_NEAR(std::atan2(way.y, way.x) * 180 / std::numbers::pi, -70 + 140 * value, 1e-9);
        EXPECT_NEAR(glm::length(way), 0.28, 1e-12);
    }
}

TEST(GlyphShapesTest, ASuperquadricAtRestIsASphereAndNearlyACubeAtItsLeast) {
    for (const GlyphShape& sphere :
         {withParts(GlyphKind::Superquadric, {}), withParts(GlyphKind::Superquadric, {1, 1})})
        for (std::size_t i = 0; i < sphere.positions.size(); ++i) {
            EXPECT_NEAR(glm::length(sphere.positions[i]), 0.5 / std::sqrt(3.0), 1e-12);
            EXPECT_GT(glm::dot(glm::normalize(sphere.normals[i]), glm::normalize(sphere.positions[i])), 1 - 1e-9);
        }
    // The implicit form of the paper: ((x^(2/a) + y^(2/a))^(a/b) + z^(2/b) = 1.
    const double a = partLength(0.3), b = partLength(0.6), radius = 0.5 / std::sqrt(3.0);
    for (const glm::dvec3& at : withParts(GlyphKind::Superquadric, {0.3, 0.6}).positions) {
        const glm::dvec3 p = glm::abs(at / radius);
        const double across = std::pow(p.x, 2 / a) + std::pow(p.y, 2 / a);
        EXPECT_NEAR(std::pow(across, a / b) + std::pow(p.z, 2 / b), 1, 1e-9);
    }
    const GlyphShape flat = withParts(GlyphKind::Superquadric, {1, 1, 1, 1, 0});
    EXPECT_NEAR(std::ranges::max(flat.positions, {}, &glm::dvec3::z).z, 0.15 * radius, 1e-12);
}

TEST(GlyphShapesTest, AnEllipsoidHasTheAxesOfItsTensor) {
    // Eigenvalues 0.8, 0.4, -0.2 along the axes turned by 30 degrees around z.
    const double c = std::cos(std::numbers::pi / 6), s = std::sin(std::numbers::pi / 6);
    const double xx = 0.8 * c * c + 0.4 * s * s, yy = 0.8 * s * s + 0.4 * c * c, xy = (0.8 - 0.4) * c * s;
    const GlyphShape shape = withParts(GlyphKind::Ellipsoid, {xx, yy, -0.2, xy, 0, 0}, 48);
    for (std::size_t i = 0; i < shape.positions.size(); ++i) {
        const glm::dvec3 at = shape.positions[i];
        const glm::dvec3 own{(at.x * c + at.y * s) / 0.4, (-at.x * s + at.y * c) / 0.2, at.z / 0.1};
        EXPECT_NEAR(glm::length(own), 1, 1e-9);
        const glm::dvec3 normal = shape.normals[i];
        EXPECT_GT(glm::dot(normal, at), 0) << "outwards";
    }
    const GlyphShape rest = withParts(GlyphKind::Ellipsoid, {});
    for (const glm::dvec3& at : rest.positions) EXPECT_NEAR(glm::length(at), 0.3, 1e-12);
}

TEST(GlyphShapesTest, EigenvectorsOfRandomTensors) {
    std::uint32_t state = 7;
    const auto next = [&] {
        state = state * 1664525u + 1013904223u;
        return double(state) / 4294967296.0 * 2 - 1;
    };
    for (int n = 0; n < 1000; ++n) {
        glm::dmat3 a;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j <= i; ++j) a[i][j] = a[j][i] = n % 5 == 0 && i != j ? 0 : next();
        const Eigen3 eigen = eigenOf(a);
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(glm::length(a * eigen.vectors[i] - eigen.values[i] * eigen.vectors[i]), 0, 1e-10);
            EXPECT_NEAR(glm::length(eigen.vectors[i]), 1, 1e-12);
        }
        EXPECT_NEAR(glm::dot(glm::cross(eigen.vectors[0], eigen.vectors[1]), eigen.vectors[2]), 1, 1e-12);
    }
}

TEST(GlyphPartsTest, EveryPartHasANameOfItsOwn) {
    for (const GlyphKind kind : kAllKinds) {
        const auto names = glyphPartNames(kind);
        for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(findGlyphPart(kind, names[i]), i);
        EXPECT_EQ(names[kSizePart], "size");
        EXPECT_EQ(names[kColorPart], "color");
        EXPECT_EQ(names[kOpacityPart], "opacity");
        EXPECT_EQ(names[kTiltPart], "tilt");
        EXPECT_FALSE(findGlyphPart(kind, "tail"));
    }
}

TEST(GlyphPartsTest, ParametersMoveToAnotherKindInOrder) {
    const std::vector<GlyphPart> parts{{"spoke 3", "c", {1, 2}},
                                       {"size", "s", {0, 0}},
                                       {"spoke 1", "a", {0, 0}},
                                       {"spoke 2", "b", {0, 0}},
                                       {"limb", "x", {0, 0}}};
    const auto bars = partsOnKind(parts, GlyphKind::Star, GlyphKind::Bars);
    const std::vector<GlyphPart> wanted{
        {"size", "s", {0, 0}}, {"bar 1", "a", {0, 0}}, {"bar 2", "b", {0, 0}}, {"bar 3", "c", {1, 2}}};
    EXPECT_EQ(bars, wanted);
    const auto cone = partsOnKind(parts, GlyphKind::Star, GlyphKind::Cone);
    ASSERT_EQ(cone.size(), 3u) << "it has two parts of its own";
    EXPECT_EQ(cone[2].part, "width");
}

TEST(GlyphPartsTest, FirstPartsAreParametersThatVary) {
    volume::DatasetInfo info;
    info.parameters.resize(4);
    info.parameters[0].name = "still", info.parameters[0].ranges = {{3, 3}};
    info.parameters[1].name = "a", info.parameters[1].ranges = {{0, 1}};
    info.parameters[2].name = "region", info.parameters[2].ranges = {{0, 4}}, info.parameters[2].categorical = true;
    info.parameters[3].name = "U", info.parameters[3].components = 3;
    info.parameters[3].ranges = {{0, 1}, {0, 1}, {0, 1}, {0, 2}};
    const auto parts = firstGlyphParts(GlyphKind::Star, info);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0], (GlyphPart{"spoke 1", "a", {0, 0}}));
    EXPECT_EQ(parts[1], (GlyphPart{"spoke 2", "|U|", {0, 0}}));
    EXPECT_EQ(glyphPartRange(parts[1], info), (Range{0, 2}));
    EXPECT_EQ(glyphPartRange({"spoke 1", "a", {4, 2}}, info), (Range{4, 2}));
    EXPECT_FALSE(glyphPartRange({"spoke 1", "none", {4, 2}}, info));
}

} // namespace
} // namespace tessera::vis
