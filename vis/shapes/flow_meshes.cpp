#include "vis/shapes/flow_geometry.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

/// Tubes around lines, and glyphs, as meshes of rings.
namespace tessera::vis {

namespace {

constexpr int kSides = 12;

struct Frame {
    glm::dvec3 along, u, v; ///< right-handed, length 1
};

Frame frameAlong(glm::dvec3 direction) {
    const glm::dvec3 along = glm::normalize(direction);
    const glm::dvec3 other = std::abs(along.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(other, along));
    return {along, u, glm::cross(along, u)};
}

/// Builds meshes from rings of vertices around an axis, in stretched space.
class Rings {
public:
    explicit Rings(glm::dvec3 stretch) : stretch_(stretch) {}
    /// Adds a ring; `lean`: axial component of its normals per unit of radial component.
    void add(glm::dvec3 centre, const Frame& frame, double radius, double lean, double outwards, float scalar) {
        for (int i = 0; i < kSides; ++i) {
            const double angle = 2 * std::numbers::pi * i / kSides;
            const glm::dvec3 out = frame.u * std::cos(angle) + frame.v * std::sin(angle);
            mesh.positions.emplace_back((centre + out * radius) / stretch_);
            // Normals transform with the inverse transpose.
            mesh.normals.emplace_back(glm::normalize((out * outwards + frame.along * lean) * stretch_));
            mesh.scalars.push_back(scalar);
        }
    }
    /// Adds triangles between the last two rings.
    void connect() {
        const auto first = std::uint32_t(mesh.positions.size()) - 2 * kSides;
        for (std::uint32_t i = 0; i < kSides; ++i) {
            const std::uint32_t next = (i + 1) % kSides;
            const std::uint32_t a = first + i, b = first + next, c = a + kSides, d = b + kSides;
            mesh.triangles.push_back({a, b, d});
            mesh.triangles.push_back({a, d, c});
        }
    }
    /// Adds the lateral surface of a truncated cone between two positions on an axis.
    void face(glm::dvec3 from, glm::dvec3 to, const Frame& frame, double radiusFrom, double radiusTo, float scalar) {
        const double rise = glm::dot(to - from, frame.along), fall = radiusFrom - radiusTo;
        add(from, frame, radiusFrom, fall, rise, scalar);
        add(to, frame, radiusTo, fall, rise, scalar);
        connect();
    }
    volume::SurfaceMesh mesh;

private:
    glm::dvec3 stretch_;
};

/// The vertices of a line, in stretched space.
struct Course {
    std::vector<glm::dvec3> places;
    std::vector<float> scalars;
};

/// Removes vertices as long as positions stay within `apart` of the polyline and scalars within `step` of linear
/// interpolation. (Douglas and Peucker, Algorithms for the reduction of the number of points, 1973.)
Course simplified(const Course& course, double apart, double step) {
    const std::size_t n = course.places.size();
    if (n < 3) return course;
    std::vector<bool> kept(n, false);
    kept.front() = kept.back() = true;
    std::vector<std::pair<std::size_t, std::size_t>> parts{{0, n - 1}};
    while (!parts.empty()) {
        const auto [first, last] = parts.back();
        parts.pop_back();
        const glm::dvec3 from = course.places[first], way = course.places[last] - from;
        const double length2 = glm::dot(way, way);
        double worst = 1;
        std::size_t at = first;
        for (std::size_t i = first + 1; i < last; ++i) {
            const glm::dvec3 to = course.places[i] - from;
            const double t = length2 > 0 ? std::clamp(glm::dot(to, way) / length2, 0.0, 1.0) : 0;
            const double even = (1 - t) * double(course.scalars[first]) + t * double(course.scalars[last]);
            const double colour = std::abs(double(course.scalars[i]) - even);
            double error = glm::length(to - t * way) / apart;
            if (step > 0 && colour > error * step) error = colour / step;
            if (error > worst) worst = error, at = i;
        }
        if (at == first) continue;
        kept[at] = true;
        parts.emplace_back(first, at);
        parts.emplace_back(at, last);
    }
    Course out;
    for (std::size_t i = 0; i < n; ++i) {
        if (!kept[i]) continue;
        out.places.push_back(course.places[i]);
        out.scalars.push_back(course.scalars[i]);
    }
    return out;
}

/// A line of a set, without coincident vertices.
Course courseOf(const LineSet& lines, std::uint32_t begin, std::uint32_t end, double apart, glm::dvec3 stretch) {
    Course out;
    for (std::uint32_t i = begin; i < end; ++i) {
        const glm::dvec3 place = glm::dvec3(lines.positions[i]) * stretch;
        if (!out.places.empty() && glm::distance(place, out.places.back()) <= apart) continue;
        out.places.push_back(place);
        out.scalars.push_back(lines.scalars.empty() ? 0 : lines.scalars[i]);
    }
    return out;
}

volume::SurfaceMesh glyphMesh(std::span<const Glyph> glyphs, glm::dvec3 stretch, bool shafts) {
    Rings rings(stretch);
    for (const Glyph& glyph : glyphs) {
        const double length = glm::length(glyph.vector);
        if (!(length > 0)) continue;
        const Frame frame = frameAlong(glyph.vector);
        const double neck = shafts ? 0.62 : 0, head = length * (shafts ? 0.14 : 0.22);
        const glm::dvec3 foot = glyph.place * stretch - glyph.vector * (shafts ? 0.0 : 0.5);
        const glm::dvec3 at = foot + glyph.vector * neck, tip = foot + glyph.vector;
        const double shaft = shafts ? length * 0.045 : 0;
        if (shafts) {
            rings.face(foot, foot, frame, 0, shaft, glyph.scalar);
            rings.face(foot, at, frame, shaft, shaft, glyph.scalar);
        }
        rings.face(at, at, frame, shaft, head, glyph.scalar);
        rings.face(at, tip, frame, head, 0, glyph.scalar);
    }
    return std::move(rings.mesh);
}

} // namespace

volume::SurfaceMesh tubes(const LineSet& lines, double radius, glm::dvec3 stretch) {
    constexpr double kColorSteps = 250; // distinguishable colours over the range
    const auto [least, most] = std::minmax_element(lines.scalars.begin(), lines.scalars.end());
    const double step = lines.scalars.empty() ? 0 : double(*most - *least) / kColorSteps;
    Rings rings(stretch);
    rings.mesh.origin = lines.origin;
    std::uint32_t begin = 0;
    for (const std::uint32_t end : lines.ends) {
        const Course course = simplified(courseOf(lines, begin, end, radius * 0.05, stretch), radius * 0.05, step);
        begin = end;
        const std::size_t n = course.places.size();
        if (n < 2) continue;
        Frame frame = frameAlong(course.places[1] - course.places[0]);
        rings.face(course.places[0], course.places[0], frame, 0, radius, course.scalars[0]);
        for (std::size_t i = 0; i < n; ++i) {
            // Rotation-minimising frame: the former frame, rotated only as far as the new direction requires.
            const glm::dvec3 way = course.places[std::min(i + 1, n - 1)] - course.places[i > 0 ? i - 1 : 0];
            if (glm::length(way) > 0) frame.along = glm::normalize(way);
            const glm::dvec3 u = frame.u - frame.along * glm::dot(frame.u, frame.along);
            frame.u = glm::length(u) > 1e-6 ? glm::normalize(u) : frameAlong(frame.along).u;
            frame.v = glm::cross(frame.along, frame.u);
            rings.add(course.places[i], frame, radius, 0, 1, course.scalars[i]);
            if (i > 0) rings.connect();
        }
        rings.face(course.places[n - 1], course.places[n - 1], frame, radius, 0, course.scalars[n - 1]);
    }
    return std::move(rings.mesh);
}

volume::SurfaceMesh arrows(std::span<const Glyph> glyphs, glm::dvec3 stretch) {
    return glyphMesh(glyphs, stretch, true);
}

volume::SurfaceMesh cones(std::span<const Glyph> glyphs, glm::dvec3 stretch) {
    return glyphMesh(glyphs, stretch, false);
}

} // namespace tessera::vis
