#pragma once

#include "vis/glyphs/glyph_mesh.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <numbers>

/// Pieces that glyphs are made of; `part`: the index of what they show, -1: none.
namespace tessera::vis {

inline std::uint32_t addVertex(GlyphShape& shape, glm::dvec3 at, glm::dvec3 normal, int part) {
    shape.positions.push_back(at);
    shape.normals.push_back(normal);
    shape.parts.push_back(std::int8_t(part));
    return std::uint32_t(shape.positions.size()) - 1;
}

/// A flat triangle or four-sided face with corners of its own.
inline void addFace(GlyphShape& shape, std::initializer_list<glm::dvec3> corners, int part) {
    const auto first = std::uint32_t(shape.positions.size());
    for (const glm::dvec3& corner : corners) addVertex(shape, corner, glm::dvec3(0), part);
    for (std::uint32_t i = 2; i < corners.size(); ++i) shape.triangles.push_back({first, first + i - 1, first + i});
}

/// The side of a truncated cone around z, closed at `from` by a disc.
inline void addCone(GlyphShape& shape, double from, double to, double radiusFrom, double radiusTo, int sides,
                    int part) {
    const auto first = std::uint32_t(shape.positions.size());
    const std::uint32_t centre = addVertex(shape, {0, 0, from}, {0, 0, -1}, part);
    for (int i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides, x = std::cos(angle), y = std::sin(angle);
        const glm::dvec3 normal{x * (to - from), y * (to - from), radiusFrom - radiusTo};
        addVertex(shape, {x * radiusFrom, y * radiusFrom, from}, {0, 0, -1}, part);
        addVertex(shape, {x * radiusFrom, y * radiusFrom, from}, normal, part);
        addVertex(shape, {x * radiusTo, y * radiusTo, to}, normal, part);
    }
    for (int i = 0; i < sides; ++i) {
        const std::uint32_t a = first + 1 + 3 * std::uint32_t(i), b = first + 1 + 3 * std::uint32_t((i + 1) % sides);
        shape.triangles.push_back({centre, b, a});
        shape.triangles.push_back({a + 1, b + 1, a + 2});
        if (radiusTo > 0) shape.triangles.push_back({b + 1, b + 2, a + 2});
    }
}

/// How many triangles figures of rods and boxes have.
enum class RodDetail {
    Open,  ///< without their back, which is seen through from behind
    Few,   ///< rods become thinner, boxes are their front
    Whole, ///< as thick up to their end, with all sides
};

/// A rod with a ridge towards z that ends in a point exactly at `to`.
inline void addRod(GlyphShape& shape, glm::dvec3 from, glm::dvec3 to, double width, RodDetail detail, int part) {
    const glm::dvec3 way = to - from;
    const double length = glm::length(way);
    if (!(length > 0)) return;
    const glm::dvec3 beside = glm::dvec3(-way.y, way.x, 0) / length * width, up{0, 0, 1.2 * width};
    const auto first = std::uint32_t(shape.positions.size());
    const glm::dvec3 corners[] = {beside, -beside, up};
    for (const glm::dvec3& corner : corners) addVertex(shape, from + corner, glm::dvec3(0), part);
    std::uint32_t last = first;
    if (detail == RodDetail::Whole && length > width) {
        last = first + 3;
        for (const glm::dvec3& corner : corners)
            addVertex(shape, from + way * (1 - width / length) + corner, glm::dvec3(0), part);
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t a = first + i, b = first + (i + 1) % 3;
            shape.triangles.push_back({a, b, b + 3});
            shape.triangles.push_back({a, b + 3, a + 3});
        }
    }
    const std::uint32_t tip = addVertex(shape, to, glm::dvec3(0), part);
    for (std::uint32_t i = detail == RodDetail::Open; i < 3; ++i)
        shape.triangles.push_back({last + i, last + (i + 1) % 3, tip});
}

/// A box that rests on a plane across z.
inline void addBox(GlyphShape& shape, glm::dvec2 lo, glm::dvec2 hi, double depth, RodDetail detail, int part) {
    const auto at = [&](int i) { return glm::dvec3(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? depth : 0); };
    addFace(shape, {at(4), at(5), at(7), at(6)}, part);
    if (detail != RodDetail::Whole) return;
    addFace(shape, {at(2), at(6), at(7), at(3)}, part);
    addFace(shape, {at(0), at(1), at(5), at(4)}, part);
    addFace(shape, {at(1), at(3), at(7), at(5)}, part);
    addFace(shape, {at(0), at(4), at(6), at(2)}, part);
}

/// An octahedron, or its half towards z.
inline void addHub(GlyphShape& shape, glm::dvec3 centre, glm::dvec3 radius, RodDetail detail, int part) {
    const auto first = std::uint32_t(shape.positions.size());
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {1.0, -1.0}) {
            glm::dvec3 at = centre;
            at[axis] += side * radius[axis];
            addVertex(shape, at, glm::dvec3(0), part);
        }
    for (std::uint32_t i = 0; i < (detail == RodDetail::Open ? 4u : 8u); ++i) {
        const std::uint32_t x = first + (i & 1), y = first + 2 + (i >> 1 & 1), z = first + 4 + (i >> 2);
        shape.triangles.push_back({x, y, z});
    }
}

/// A ball with normals, `place(x, y, z on the unit ball) -> {position, normal}` applied.
template <class Place> void addRound(GlyphShape& shape, int sides, int part, const Place& place) {
    const int rings = std::max(2, sides / 2);
    const auto first = std::uint32_t(shape.positions.size());
    for (int ring = 0; ring <= rings; ++ring)
        for (int i = 0; i < sides; ++i) {
            const double theta = 2 * std::numbers::pi * i / sides, phi = std::numbers::pi * ring / rings;
            const auto [at, normal] = place(theta, phi);
            addVertex(shape, at, normal, part);
        }
    for (int ring = 0; ring < rings; ++ring)
        for (int i = 0; i < sides; ++i) {
            const auto row = first + std::uint32_t(ring * sides);
            const auto a = row + std::uint32_t(i), b = row + std::uint32_t((i + 1) % sides),
                       under = std::uint32_t(sides);
            if (ring > 0) shape.triangles.push_back({a, b + under, b});
            if (ring + 1 < rings) shape.triangles.push_back({a, a + under, b + under});
        }
}

} // namespace tessera::vis
