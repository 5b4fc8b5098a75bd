#include "vis/glyphs/glyph_shapes.h"

#include "vis/glyphs/glyph_parts.h"
#include "vis/glyphs/shape_parts.h"

#include <algorithm>

namespace tessera::vis {

namespace {

using std::numbers::pi;

double orRest(double value, double rest) {
    return value == kPartAtRest ? rest : value;
}

/// Parts of the own ones that parameters move.
std::vector<std::size_t> movedParts(std::span<const double> values) {
    std::vector<std::size_t> moved;
    for (std::size_t i = kCommonGlyphParts; i < values.size(); ++i)
        if (values[i] != kPartAtRest) moved.push_back(i);
    return moved;
}

void makeArrow(std::span<const double> own, int sides, GlyphShape& shape) {
    const double length = partLength(orRest(own[0], 1)), width = partLength(orRest(own[1], 1));
    const double foot = -0.49 * length, neck = 0.12 * length;
    addCone(shape, foot, neck, 0.045 * width, 0.045 * width, sides, -1);
    addCone(shape, neck, 0.5 * length, 0.14 * width, 0, sides, -1);
}

void makeCone(std::span<const double> own, int sides, GlyphShape& shape) {
    const double length = partLength(orRest(own[0], 1)), width = partLength(orRest(own[1], 1));
    addCone(shape, -0.4 * length, 0.5 * length, 0.22 * width, 0, sides, -1);
}

void makeSixSided(std::span<const double> own, GlyphShape& shape) {
    constexpr double kBase = -0.35, kRadius = 0.34;
    const glm::dvec3 tip{0, 0, 0.5};
    const auto corner = [&](int i) {
        return glm::dvec3(kRadius * std::cos(pi / 3 * i), kRadius * std::sin(pi / 3 * i), kBase);
    };
    for (int i = 0; i < 6; ++i) {
        const double value = own[std::size_t(i)];
        const glm::dvec3 a = corner(i), b = corner(i + 1);
        if (std::isnan(value)) continue;
        if (value == kPartAtRest) {
            addFace(shape, {a, b, tip}, -1);
            continue;
        }
        const double filled = partLength(value);
        const glm::dvec3 c = glm::mix(b, tip, filled), d = glm::mix(a, tip, filled);
        addFace(shape, {a, b, c, d}, i + int(kCommonGlyphParts));
        if (filled < 1) addFace(shape, {d, c, tip}, -1);
    }
    addFace(shape, {corner(5), corner(4), corner(3), corner(2), corner(1), corner(0)}, -1);
}

void makeStar(std::span<const double> values, RodDetail detail, GlyphShape& shape) {
    const std::vector<std::size_t> moved = movedParts(values);
    addHub(shape, {0, 0, 0.02}, {0.055, 0.055, 0.045}, detail, -1);
    for (std::size_t i = 0; i < moved.size(); ++i) {
        const double value = values[moved[i]], angle = pi / 2 - 2 * pi * double(i) / double(moved.size());
        const glm::dvec3 way{std::cos(angle), std::sin(angle), 0};
        if (!std::isnan(value))
            addRod(shape, way * 0.02, way * (0.5 * partLength(value)), detail == RodDetail::Whole ? 0.03 : 0.045,
                   detail, int(moved[i]));
    }
}

void makeBars(std::span<const double> values, RodDetail detail, GlyphShape& shape) {
    constexpr double kHalf = 0.36, kFoot = -0.32, kHeight = 0.65, kDepth = 0.05;
    const std::vector<std::size_t> moved = movedParts(values);
    addBox(shape, {-kHalf, kFoot - 0.02}, {kHalf, kFoot}, kDepth, detail, -1);
    const double step = 2 * kHalf / double(std::max<std::size_t>(moved.size(), 1));
    for (std::size_t i = 0; i < moved.size(); ++i) {
        const double value = values[moved[i]], left = -kHalf + step * double(i);
        if (!std::isnan(value))
            addBox(shape, {left + 0.1 * step, kFoot}, {left + 0.9 * step, kFoot + kHeight * partLength(value)}, kDepth,
                   detail, int(moved[i]));
    }
}

void makePie(std::span<const double> values, int sides, GlyphShape& shape) {
    constexpr double kGap = 0.02; // angle between slices
    const std::vector<std::size_t> moved = movedParts(values);
    if (moved.empty()) addHub(shape, glm::dvec3(0), glm::dvec3(0.055), RodDetail::Whole, -1);
    const auto count = double(moved.size());
    for (std::size_t i = 0; i < moved.size(); ++i) {
        if (std::isnan(values[moved[i]])) continue;
        const double radius = 0.5 * std::sqrt(partLength(values[moved[i]])), slice = 2 * pi / count - 2 * kGap;
        const double from = pi / 2 - 2 * pi * double(i) / count - kGap;
        const int pieces = std::max(2, int(std::ceil(sides * slice / (2 * pi))));
        const int part = int(moved[i]);
        const std::uint32_t middle = addVertex(shape, {0, 0, 0.06}, glm::dvec3(0), part);
        for (int k = 0; k <= pieces; ++k) {
            const double angle = from - slice * k / pieces;
            const std::uint32_t rim =
                addVertex(shape, {radius * std::cos(angle), radius * std::sin(angle), 0}, glm::dvec3(0), part);
            if (k > 0) shape.triangles.push_back({middle, rim, rim - 1});
        }
    }
}

void makeJack(std::span<const double> own, RodDetail detail, GlyphShape& shape) {
    constexpr double kWidth = 0.03, kArm = 0.28, kLeg = 0.33;
    const int first = int(kCommonGlyphParts);
    const double body = orRest(own[5], 0.2), head = orRest(own[4], 0.5);
    const double half = std::isnan(body) ? 0.02 : 0.02 + 0.07 * body; // absent: limbs keep their places
    for (const int side : {0, 1}) {                                   // left, right, as seen
        const double sign = side == 0 ? -1 : 1;
        const double arm = orRest(own[std::size_t(side)], 0.5), leg = orRest(own[std::size_t(2 + side)], 0.3);
        const glm::dvec3 shoulder{sign * half, 0.14, 0}, hip{sign * half * 0.6, -0.08, 0};
        const double lifted = (-70 + 140 * arm) * pi / 180, spread = (3 + 65 * leg) * pi / 180;
        const glm::dvec3 toHand{sign * std::cos(lifted), std::sin(lifted), 0},
            toFoot{sign * std::sin(spread), -std::cos(spread), 0};
        if (!std::isnan(arm)) addRod(shape, shoulder, shoulder + toHand * kArm, kWidth, detail, first + side);
        if (!std::isnan(leg)) addRod(shape, hip, hip + toFoot * kLeg, kWidth, detail, first + 2 + side);
    }
    if (!std::isnan(body)) addBox(shape, {-half, -0.1}, {half, 0.16}, 0.04, detail, first + 5);
    const double radius = 0.04 + 0.07 * head;
    if (!std::isnan(head)) addHub(shape, {0, 0.17 + radius, 0.02}, {radius, radius, radius * 0.6}, detail, first + 4);
}

double signedPower(double base, double exponent) {
    return std::copysign(std::pow(std::abs(base), exponent), base);
}

void makeSuperquadric(std::span<const double> own, int sides, GlyphShape& shape) {
    constexpr double kRadius = 0.2886751345948129; // 1 / (2 sqrt 3): a cube fits into the ball
    const double alpha = partLength(orRest(own[0], 1)), beta = partLength(orRest(own[1], 1));
    glm::dvec3 radius;
    for (int axis = 0; axis < 3; ++axis) radius[axis] = kRadius * partLength(orRest(own[std::size_t(2 + axis)], 1));
    addRound(shape, sides, -1, [&](double theta, double phi) {
        const double ct = std::cos(theta), st = std::sin(theta), cp = std::cos(phi), sp = std::max(std::sin(phi), 0.0);
        const glm::dvec3 at{signedPower(ct, alpha) * std::pow(sp, beta), signedPower(st, alpha) * std::pow(sp, beta),
                            signedPower(cp, beta)};
        const glm::dvec3 normal{signedPower(ct, 2 - alpha) * std::pow(sp, 2 - beta),
                                signedPower(st, 2 - alpha) * std::pow(sp, 2 - beta), signedPower(cp, 2 - beta)};
        return std::pair(at * radius, normal / radius);
    });
}

void makeEllipsoid(std::span<const double> own, int sides, GlyphShape& shape) {
    constexpr double kThinnest = 0.03; // share of the radius of the ball
    const bool rest = std::ranges::all_of(own, [](double value) { return value == kPartAtRest; });
    const auto of = [&](std::size_t i) { return orRest(own[i], 0); };
    const Eigen3 eigen = rest ? Eigen3{glm::dvec3(0.6), glm::dmat3(1)}
                              : eigenOf({{of(0), of(3), of(5)}, {of(3), of(1), of(4)}, {of(5), of(4), of(2)}});
    const glm::dvec3 radius = 0.5 * glm::clamp(glm::abs(eigen.values), kThinnest, 1.0);
    addRound(shape, sides, -1, [&](double theta, double phi) {
        const glm::dvec3 ball{std::cos(theta) * std::sin(phi), std::sin(theta) * std::sin(phi), std::cos(phi)};
        return std::pair(eigen.vectors * (ball * radius), eigen.vectors * (ball / radius));
    });
}

} // namespace

void GlyphShape::clear() {
    positions.clear();
    normals.clear();
    parts.clear();
    triangles.clear();
}

Eigen3 eigenOf(glm::dmat3 a) {
    glm::dmat3 v(1);
    for (int sweep = 0; sweep < 30; ++sweep) {
        const double off = a[1][0] * a[1][0] + a[2][0] * a[2][0] + a[2][1] * a[2][1];
        const double on = a[0][0] * a[0][0] + a[1][1] * a[1][1] + a[2][2] * a[2][2];
        if (off <= 1e-30 * on || off == 0) break;
        for (int p = 0; p < 2; ++p)
            for (int q = p + 1; q < 3; ++q) {
                if (a[q][p] == 0) continue;
                const double theta = (a[q][q] - a[p][p]) / (2 * a[q][p]);
                const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1));
                const double c = 1 / std::sqrt(t * t + 1), s = t * c;
                glm::dmat3 turn(1); // columns p and q turned by the angle whose tangent is t
                turn[p][p] = turn[q][q] = c;
                turn[q][p] = s;
                turn[p][q] = -s;
                a = glm::transpose(turn) * a * turn;
                v = v * turn;
            }
    }
    return {{a[0][0], a[1][1], a[2][2]}, v};
}

void makeGlyphShape(GlyphKind kind, std::span<const double> values, int sides, GlyphShape& shape) {
    shape.clear();
    for (std::size_t i = 0; i < values.size(); ++i)
        if (std::isnan(values[i]) && isWholeGlyph(kind, i)) return;
    const RodDetail detail = sides >= 8 ? RodDetail::Whole : sides >= 6 ? RodDetail::Few : RodDetail::Open;
    const auto own = values.subspan(kCommonGlyphParts);
    switch (kind) {
    case GlyphKind::Arrow:
        return makeArrow(own, sides, shape);
    case GlyphKind::Cone:
        return makeCone(own, sides, shape);
    case GlyphKind::SixSided:
        return makeSixSided(own, shape);
    case GlyphKind::Star:
        return makeStar(values, detail, shape);
    case GlyphKind::Bars:
        return makeBars(values, detail, shape);
    case GlyphKind::Pie:
        return makePie(values, sides, shape);
    case GlyphKind::JumpingJack:
        return makeJack(own, detail, shape);
    case GlyphKind::Superquadric:
        return makeSuperquadric(own, sides, shape);
    case GlyphKind::Ellipsoid:
        return makeEllipsoid(own, sides, shape);
    }
}

} // namespace tessera::vis
