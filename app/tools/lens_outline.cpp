#include "app/tools/lens_outline.h"

#include "vis/scene/lens_shape.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace tessera::app {

namespace {

constexpr int kOutlineParts = 64; ///< of an outline in a plane
constexpr double kPi = 3.14159265358979, kReach = 4;

ImU32 colorOf(const vis::Lens& lens, float alpha) {
    return toColor({lens.color.r, lens.color.g, lens.color.b}, double(alpha));
}

/// Joined lines as dashes, so that a lens looks unlike a brush in space, whose lines are whole.
class Dashes {
public:
    Dashes(ImDrawList& draw, float width) : draw_(draw), width_(width) {}
    void line(ImVec2 from, ImVec2 to, ImU32 color) {
        const float length = std::hypot(to.x - from.x, to.y - from.y);
        const float dash = em() * 0.55f, period = em() * 0.9f;
        if (!(length > 0) || length > 2e4f) return;
        const auto at = [&](float way) {
            return ImVec2{from.x + (to.x - from.x) * way / length, from.y + (to.y - from.y) * way / length};
        };
        for (float way = 0; way < length;) {
            const float within = std::fmod(phase_ + way, period);
            const float end = std::min(length, way + (within < dash ? dash : period) - within + 0.01f);
            if (within < dash) draw_.AddLine(at(way), at(end), color, width_);
            way = end;
        }
        phase_ = std::fmod(phase_ + length, period);
    }

private:
    ImDrawList& draw_;
    float width_, phase_ = 0;
};

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
    eachLens(session, frame.world, [&](int index, const vis::Lens& lens, const vis::PlacedLens& placed) {
        const float width = std::max(1.0f, em() * (index == active ? 0.13f : 0.09f));
        const double depth = glm::dot(placed.center, middle.direction);
        Dashes dashes(draw, width);
        const auto line = [&](glm::dvec3 a, glm::dvec3 b, float strength) {
            const glm::dvec3 from = placed.center + placed.fromUnit * a, to = placed.center + placed.fromUnit * b;
            const auto p = worldPixel(frame, from), q = worldPixel(frame, to);
            if (!p || !q) return;
            const double behind = 0.5 * glm::dot(from + to, middle.direction) - depth;
            const float seen = (behind > 1e-6 && placed.shape != vis::LensShape::Sphere) || strength < 1
                                   ? (behind > 1e-6 ? 0.55f : 1.0f)
                                   : 1.0f;
            dashes.line(*p, *q, colorOf(lens, 0.85f * strength * seen));
        };
        const bool perspective = session.camera.projection == vis::Projection::Perspective;
        const glm::dvec3 eye = placed.toUnit * (perspective ? middle.origin - placed.center : -middle.direction);
        vis::lensOutline(placed.shape, eye, perspective, line);
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
    for (int i = 0; i < kOutlineParts; ++i) {
        glm::dvec3 way(0);
        way[right] = std::cos(2 * kPi * i / kOutlineParts);
        way[up] = std::sin(2 * kPi * i / kOutlineParts);
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
        Dashes dashes(draw, std::max(1.0f, em() * 0.1f));
        for (std::size_t i = 0; i < outline.size(); ++i)
            dashes.line(outline[i], outline[(i + 1) % outline.size()], colorOf(lens, 0.9f));
        const glm::dvec3 middle = world.toPhysical(placed.center);
        draw.AddCircleFilled(frame.pixel(middle[right] * perUnit.x, middle[up] * perUnit.y), em() * 0.28f,
                             colorOf(lens, 0.9f));
    });
}

} // namespace tessera::app
