#include "app/tools/lens_outline.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace tessera::app {

namespace {

constexpr int kParts = 64;    ///< of a circle
constexpr int kEdgeParts = 8; ///< of an edge, so that its farther half is faint
constexpr double kPi = 3.14159265358979, kReach = 4;

using Line = std::function<void(glm::dvec3 from, glm::dvec3 to, float strength)>; ///< places in the lens

/// A circle around `middle` through middle + a and middle + b.
void circle(const Line& line, glm::dvec3 middle, glm::dvec3 a, glm::dvec3 b, float strength) {
    const auto at = [&](int i) {
        const double angle = 2 * kPi * i / kParts;
        return middle + std::cos(angle) * a + std::sin(angle) * b;
    };
    for (int i = 0; i < kParts; ++i) line(at(i), at(i + 1), strength);
}

void edge(const Line& line, glm::dvec3 a, glm::dvec3 b) {
    for (int i = 0; i < kEdgeParts; ++i)
        line(glm::mix(a, b, double(i) / kEdgeParts), glm::mix(a, b, double(i + 1) / kEdgeParts), 1);
}

/// The rim of a ball of radius 1 as it is seen from `eye`, or along a direction where that is none.
void rim(const Line& line, glm::dvec3 eye, bool direction) {
    const double distance = glm::length(eye);
    if (!(distance > (direction ? 0 : 1))) return;
    const glm::dvec3 axis = eye / distance;
    const double middle = direction ? 0 : 1 / distance, radius = std::sqrt(1 - middle * middle);
    const glm::dvec3 helper = std::abs(axis.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 a = glm::normalize(glm::cross(axis, helper)), b = glm::cross(axis, a);
    circle(line, middle * axis, radius * a, radius * b, 1);
}

void outline(const vis::PlacedLens& lens, const vis::Ray& middle, bool perspective, const Line& line) {
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    switch (lens.shape) {
    case vis::LensShape::Sphere:
        rim(line, lens.toUnit * (perspective ? middle.origin - lens.center : -middle.direction), !perspective);
        circle(line, {}, x, y, 0.3f);
        circle(line, {}, y, z, 0.3f);
        circle(line, {}, z, x, 0.3f);
        break;
    case vis::LensShape::Box:
        for (const auto& [a, b, c] : {std::tuple(x, y, z), std::tuple(y, z, x), std::tuple(z, x, y)})
            for (const double i : {-1.0, 1.0})
                for (const double k : {-1.0, 1.0}) edge(line, -a + i * b + k * c, a + i * b + k * c);
        break;
    case vis::LensShape::Cylinder:
        circle(line, z, x, y, 1);
        circle(line, -z, x, y, 1);
        for (int i = 0; i < 4; ++i) {
            const glm::dvec3 side = (i & 1 ? x : -x) * (i < 2 ? 1.0 : 0.0) + (i & 1 ? y : -y) * (i < 2 ? 0.0 : 1.0);
            edge(line, side - z, side + z);
        }
        break;
    case vis::LensShape::Disc:
        circle(line, {}, x, y, 1);
        break;
    }
}

ImU32 colorOf(const vis::Lens& lens, float alpha) {
    return toColor({lens.color.r, lens.color.g, lens.color.b}, double(alpha));
}

/// Calls `each(lens, placed)` for the lenses that act.
template <class Each> void eachLens(const Session& session, const vis::WorldFrame& world, const Each& each) {
    const auto placed = vis::placeLenses(session.lenses, world, session.camera, session.cursor);
    std::size_t next = 0;
    for (std::size_t i = 0; i < session.lenses.size() && next < placed.size(); ++i)
        if (session.lenses[i].enabled) each(static_cast<int>(i), session.lenses[i], placed[next++]);
}

} // namespace

std::optional<ImVec2> worldPixel(const SpaceFrame& frame, glm::dvec3 world) {
    return frame.pixel(frame.world.toPhysical(world));
}

void drawLenses(ImDrawList& draw, const SpaceFrame& frame, const Session& session, int active) {
    const double aspect = double(frame.max.x - frame.min.x) / std::max(1.0f, frame.max.y - frame.min.y);
    const vis::Ray middle = vis::cameraRay(session.camera, aspect, {0, 0});
    const bool perspective = session.camera.projection == vis::Projection::Perspective;
    eachLens(session, frame.world, [&](int index, const vis::Lens& lens, const vis::PlacedLens& placed) {
        const float width = std::max(1.0f, em() * (index == active ? 0.13f : 0.09f));
        const double depth = glm::dot(placed.center, middle.direction);
        const Line line = [&](glm::dvec3 a, glm::dvec3 b, float strength) {
            const glm::dvec3 from = placed.center + placed.fromUnit * a, to = placed.center + placed.fromUnit * b;
            const auto p = worldPixel(frame, from), q = worldPixel(frame, to);
            if (!p || !q) return;
            const double behind = 0.5 * glm::dot(from + to, middle.direction) - depth;
            const float seen = (behind > 1e-6 && placed.shape != vis::LensShape::Sphere) || strength < 1
                                   ? (behind > 1e-6 ? 0.55f : 1.0f)
                                   : 1.0f;
            draw.AddLine(*p, *q, colorOf(lens, 0.85f * strength * seen), width);
        };
        outline(placed, middle, perspective, line);
    });
}

std::vector<glm::dvec3> lensSection(const vis::PlacedLens& lens, int right, int up, int normal, double at) {
    // From the middle, moved within the plane to where the lens is deepest.
    glm::dvec3 inside = lens.center;
    inside[normal] = at;
    for (double step = 0.25; step > 1e-4; step /= 2)
        for (int round = 0; round < 4; ++round)
            for (const int axis : {right, up})
                for (const double way : {-step, step}) {
                    glm::dvec3 other = inside;
                    other[axis] += way;
                    if (lens.radius(other) < lens.radius(inside)) inside = other;
                }
    std::vector<glm::dvec3> points;
    if (lens.radius(inside) >= 1) return points;
    for (int i = 0; i < kParts; ++i) {
        glm::dvec3 way(0);
        way[right] = std::cos(2 * kPi * i / kParts);
        way[up] = std::sin(2 * kPi * i / kParts);
        double near = 0, far = kReach;
        for (int k = 0; k < 30; ++k) {
            const double half = 0.5 * (near + far);
            (lens.radius(inside + half * way) < 1 ? near : far) = half;
        }
        points.push_back(inside + near * way);
    }
    return points;
}

void drawLensSections(ImDrawList& draw, const PlotFrame& frame, const Session& session, const volume::DatasetInfo& info,
                      int right, int up, int normal, double at, glm::dvec2 perUnit) {
    const vis::WorldFrame world = vis::worldFrame(info.bounds, session.stretch);
    glm::dvec3 plane(0);
    plane[normal] = at;
    eachLens(session, world, [&](int, const vis::Lens& lens, const vis::PlacedLens& placed) {
        std::vector<ImVec2> outline;
        for (const glm::dvec3& point : lensSection(placed, right, up, normal, world.toWorld(plane)[normal])) {
            const glm::dvec3 physical = world.toPhysical(point);
            outline.push_back(frame.pixel(physical[right] * perUnit.x, physical[up] * perUnit.y));
        }
        if (outline.empty()) return;
        draw.AddPolyline(outline.data(), static_cast<int>(outline.size()), colorOf(lens, 0.9f), ImDrawFlags_Closed,
                         std::max(1.0f, em() * 0.1f));
        const glm::dvec3 middle = world.toPhysical(placed.center);
        draw.AddCircleFilled(frame.pixel(middle[right] * perUnit.x, middle[up] * perUnit.y), em() * 0.28f,
                             colorOf(lens, 0.9f));
    });
}

} // namespace tessera::app
