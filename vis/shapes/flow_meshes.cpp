#include "vis/shapes/flow_geometry.h"
#include "vis/shapes/rings.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

/// Tubes, arrows and bands along lines, and glyphs, as meshes of rings.
namespace tessera::vis {

namespace {

constexpr double kRibbon = 0.16;                 ///< thickness of a ribbon, of its width
constexpr double kHeadWide = 2.6, kHeadLong = 7; ///< of a bent arrow, of the radius of its shaft
constexpr double kMostOfHead = 0.6;              ///< of the whole length of a short one

volume::SurfaceMesh glyphMesh(std::span<const Glyph> glyphs, glm::dvec3 stretch, bool shafts) {
    Rings rings(stretch);
    for (const Glyph& glyph : glyphs) {
        const double length = glm::length(glyph.vector);
        if (!(length > 0)) continue;
        const AxisFrame frame = frameAlong(glyph.vector);
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

/// Where a line is so far before its end: the last vertex before, and the way from there.
struct PlaceOnLine {
    std::size_t before = 0;
    glm::dvec3 place{0};
    float scalar = 0;
};
PlaceOnLine placeBeforeEnd(const LineCourse& course, double distance) {
    std::size_t i = course.places.size() - 1;
    for (; i > 0; --i) {
        const glm::dvec3 way = course.places[i - 1] - course.places[i];
        const double length = glm::length(way);
        if (length >= distance || i == 1) {
            const double share = length > 0 ? std::min(1.0, distance / length) : 0;
            const float a = course.scalars[i], b = course.scalars[i - 1];
            return {i - 1, course.places[i] + way * share, share < 0.5 ? a : b};
        }
        distance -= length;
    }
    return {0, course.places[0], course.scalars[0]};
}

double lengthOf(const LineCourse& course) {
    double sum = 0;
    for (std::size_t i = 1; i < course.places.size(); ++i) sum += glm::distance(course.places[i - 1], course.places[i]);
    return sum;
}

/// A frame whose v is across the plane in which a line bends, so that a ribbon lies in that plane.
AxisFrame frameInBend(const LineCourse& course) {
    const glm::dvec3 first = course.places[1] - course.places[0];
    glm::dvec3 across(0);
    for (std::size_t i = 2; i < course.places.size(); ++i) {
        const glm::dvec3 turn =
            glm::cross(course.places[i - 1] - course.places[i - 2], course.places[i] - course.places[i - 1]);
        across += glm::dot(turn, across) < 0 ? -turn : turn;
    }
    AxisFrame frame = frameAlong(first);
    const glm::dvec3 v = across - frame.along * glm::dot(across, frame.along);
    if (!(glm::length(v) > 1e-9 * glm::dot(first, first))) return frame;
    frame.v = glm::normalize(v);
    frame.u = glm::cross(frame.v, frame.along);
    return frame;
}

/// Rings along a line, with its radii; `lean`: of the normals.
void sweep(Rings& rings, const LineCourse& course, const std::vector<AxisFrame>& frames,
           const std::vector<double>& radii, double lean) {
    for (std::size_t i = 0; i < course.places.size(); ++i) {
        rings.add(course.places[i], frames[i], radii[i], lean, 1, course.scalars[i]);
        if (i > 0) rings.connect();
    }
}

void addTube(Rings& rings, const LineCourse& course, const std::vector<double>& radii) {
    const std::size_t n = course.places.size();
    const AxisFrame first = frameAlong(course.places[1] - course.places[0]);
    const std::vector<AxisFrame> frames = framesOf(course.places, first);
    rings.face(course.places[0], course.places[0], first, 0, radii.front(), course.scalars[0]);
    sweep(rings, course, frames, radii, 0);
    rings.face(course.places[n - 1], course.places[n - 1], frames.back(), radii.back(), 0, course.scalars[n - 1]);
}

void addBentArrow(Rings& rings, const LineCourse& whole, double radius) {
    const double head = std::min(kHeadLong * radius, kMostOfHead * lengthOf(whole)), width = kHeadWide * radius;
    const PlaceOnLine neck = placeBeforeEnd(whole, head);
    // One line with a vertex at the neck, so that the head goes on with the frames of the shaft.
    LineCourse course = whole;
    const std::size_t at = neck.before + 1;
    course.places.insert(course.places.begin() + std::ptrdiff_t(at), neck.place);
    course.scalars.insert(course.scalars.begin() + std::ptrdiff_t(at), neck.scalar);
    const std::vector<AxisFrame> frames = framesOf(course.places, frameInBend(course));
    const auto part = [&](std::size_t from, std::size_t to) {
        return LineCourse{{course.places.begin() + std::ptrdiff_t(from), course.places.begin() + std::ptrdiff_t(to)},
                          {course.scalars.begin() + std::ptrdiff_t(from), course.scalars.begin() + std::ptrdiff_t(to)}};
    };
    const std::size_t n = course.places.size();
    rings.face(course.places[0], course.places[0], frames[0], 0, radius, course.scalars[0]);
    sweep(rings, part(0, at + 1), {frames.begin(), frames.begin() + std::ptrdiff_t(at) + 1},
          std::vector<double>(at + 1, radius), 0);
    rings.face(neck.place, neck.place, frames[at], radius, width, neck.scalar);
    const LineCourse tip = part(at, n);
    std::vector<double> radii(tip.places.size(), 0);
    const double length = lengthOf(tip);
    double way = 0;
    for (std::size_t i = 0; i < tip.places.size(); ++i) {
        if (i > 0) way += glm::distance(tip.places[i - 1], tip.places[i]);
        radii[i] = i + 1 == tip.places.size() ? 0 : width * (1 - way / length);
    }
    sweep(rings, tip, {frames.begin() + std::ptrdiff_t(at), frames.end()}, radii, width / length);
}

/// A tail that grows from nothing to the radius, and half a ball before it.
void addComet(Rings& rings, const LineCourse& course, double radius) {
    constexpr int kRounds = 4;
    const std::size_t n = course.places.size();
    const AxisFrame first = n > 1 ? frameAlong(course.places[1] - course.places[0]) : frameAlong({1, 0, 0});
    std::vector<AxisFrame> frames{first};
    if (n > 1) {
        frames = framesOf(course.places, first);
        const double length = lengthOf(course);
        std::vector<double> radii(n);
        double way = 0;
        for (std::size_t i = 0; i < n; ++i) {
            if (i > 0) way += glm::distance(course.places[i - 1], course.places[i]);
            radii[i] = radius * way / length;
        }
        sweep(rings, course, frames, radii, -radius / length);
    }
    const double begin = n > 1 ? 0 : -std::numbers::pi / 2; // of one that rests: a ball
    for (int i = 0; i <= kRounds; ++i) {
        const double angle = begin + (std::numbers::pi / 2 - begin) * i / kRounds;
        const double across = i == kRounds || (n == 1 && i == 0) ? 0 : std::cos(angle);
        rings.add(course.places[n - 1] + frames.back().along * (radius * std::sin(angle)), frames.back(),
                  radius * across, std::sin(angle), std::cos(angle), course.scalars[n - 1]);
        if (i > 0) rings.connect();
    }
}

} // namespace

volume::SurfaceMesh tubes(const LineSet& lines, double radius, glm::dvec3 stretch,
                          const std::function<double(glm::dvec3 place)>& width) {
    const double step = colorStep(lines.scalars);
    Rings rings(stretch);
    rings.mesh.origin = lines.origin;
    std::uint32_t begin = 0;
    for (const std::uint32_t end : lines.ends) {
        LineCourse course = courseOf(lines, begin, end, radius * 0.05, stretch);
        if (!width) course = simplified(course, radius * 0.05, step);
        begin = end;
        std::vector<double> radii(course.places.size(), radius);
        for (std::size_t i = 0; width && i < radii.size(); ++i) radii[i] *= width(course.places[i] / stretch);
        if (course.places.size() > 1) addTube(rings, course, radii);
    }
    return std::move(rings.mesh);
}

volume::SurfaceMesh bentArrows(const LineSet& lines, double radius, bool flat, glm::dvec3 stretch) {
    const double step = colorStep(lines.scalars);
    Rings rings(stretch, flat ? kRibbon : 1);
    rings.mesh.origin = lines.origin;
    std::uint32_t begin = 0;
    for (const std::uint32_t end : lines.ends) {
        const LineCourse course = simplified(courseOf(lines, begin, end, radius * 0.05, stretch), radius * 0.05, step);
        begin = end;
        if (course.places.size() > 1 && lengthOf(course) > 1.3 * kHeadLong * radius)
            addBentArrow(rings, course, radius);
    }
    return std::move(rings.mesh);
}

volume::SurfaceMesh comets(const LineSet& lines, double radius, glm::dvec3 stretch) {
    const double step = colorStep(lines.scalars);
    Rings rings(stretch);
    rings.mesh.origin = lines.origin;
    std::uint32_t begin = 0;
    for (const std::uint32_t end : lines.ends) {
        LineCourse course = courseOf(lines, begin, end, radius * 0.05, stretch);
        if (end > begin) { // the head stands at the last vertex, however near the one before is
            course.places.back() = glm::dvec3(lines.positions[end - 1]) * stretch;
            course.scalars.back() = lines.scalars.empty() ? 0 : lines.scalars[end - 1];
            addComet(rings, simplified(course, radius * 0.05, step), radius);
        }
        begin = end;
    }
    return std::move(rings.mesh);
}

void addBand(volume::SurfaceMesh& mesh, std::size_t columns, std::span<const glm::vec3> positions,
             std::span<const float> scalars, glm::dvec3 stretch) {
    const auto first = std::uint32_t(mesh.positions.size());
    const std::size_t rows = columns > 0 ? positions.size() / columns : 0;
    if (rows < 2 || columns < 2) return;
    const auto at = [&](std::size_t row, std::size_t column) {
        return glm::dvec3(positions[row * columns + column]) * stretch;
    };
    for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t column = 0; column < columns; ++column) {
            const glm::dvec3 along = at(row, std::min(column + 1, columns - 1)) - at(row, column > 0 ? column - 1 : 0);
            const glm::dvec3 onward = at(std::min(row + 1, rows - 1), column) - at(row > 0 ? row - 1 : 0, column);
            const glm::dvec3 normal = glm::cross(along, onward) * stretch;
            const double length = glm::length(normal);
            mesh.positions.push_back(positions[row * columns + column]);
            mesh.scalars.push_back(scalars.empty() ? 0 : scalars[row * columns + column]);
            mesh.normals.emplace_back(length > 0 ? normal / length : glm::dvec3(0));
        }
    for (std::uint32_t row = 0; row + 1 < rows; ++row)
        for (std::uint32_t column = 0; column + 1 < columns; ++column) {
            const auto a = first + row * std::uint32_t(columns) + column, b = a + 1, c = a + std::uint32_t(columns),
                       d = c + 1;
            mesh.triangles.push_back({a, b, d});
            mesh.triangles.push_back({a, d, c});
        }
}

void appendMesh(volume::SurfaceMesh& mesh, const volume::SurfaceMesh& other) {
    const auto first = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
    mesh.scalars.insert(mesh.scalars.end(), other.scalars.begin(), other.scalars.end());
    for (const glm::uvec3& triangle : other.triangles) mesh.triangles.push_back(triangle + first);
}

volume::SurfaceMesh arrows(std::span<const Glyph> glyphs, glm::dvec3 stretch) {
    return glyphMesh(glyphs, stretch, true);
}

volume::SurfaceMesh cones(std::span<const Glyph> glyphs, glm::dvec3 stretch) {
    return glyphMesh(glyphs, stretch, false);
}

} // namespace tessera::vis
