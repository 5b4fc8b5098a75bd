#include "app/tools/plane_sections.h"

#include "app/drawing/line_pieces.h"
#include "app/tools/brush_edit.h"
#include "app/tools/lens_outline.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tessera::app {

namespace {

constexpr int kLensParts = 64, kBallParts = 48; ///< of an outline
constexpr double kLensReach = 4;                ///< world units: no lens is larger

} // namespace

// In the space where it is round, a circle around the place nearest to its middle.
std::vector<glm::dvec3> ballSection(const vis::SheetBox& ball, const PicturePlane& plane) {
    const glm::dvec3 first = glm::normalize(plane.right / ball.radius);
    const glm::dvec3 slant = plane.up / ball.radius, second = glm::normalize(slant - first * glm::dot(slant, first));
    const glm::dvec3 to = (plane.at - ball.center) / ball.radius;
    const glm::dvec3 middle = to - first * glm::dot(to, first) - second * glm::dot(to, second);
    const double left = 1 - glm::dot(middle, middle);
    std::vector<glm::dvec3> points;
    if (left < 0) return points;
    for (int i = 0; i < kBallParts; ++i) {
        const double angle = 2 * std::numbers::pi * (i + 0.5) / kBallParts;
        points.push_back(ball.center + ball.radius * (middle + std::sqrt(left) * (first * std::cos(angle) +
                                                                                  second * std::sin(angle))));
    }
    return points;
}

std::vector<glm::dvec3> lensSection(const vis::PlacedLens& lens, glm::dvec3 at, glm::dvec3 right, glm::dvec3 up) {
    const glm::dvec3 normal = glm::cross(right, up);
    // From the middle, moved within the plane to where the lens is deepest.
    glm::dvec3 inside = lens.center - normal * glm::dot(lens.center - at, normal);
    for (double step = 0.25; step > 1e-4; step /= 2)
        for (int round = 0; round < 4; ++round)
            for (const glm::dvec3& way : {right, up})
                for (const double by : {-step, step})
                    if (const glm::dvec3 other = inside + way * by; lens.radius(other) < lens.radius(inside))
                        inside = other;
    std::vector<glm::dvec3> points;
    if (lens.radius(inside) >= 1) return points;
    for (int i = 0; i < kLensParts; ++i) {
        const double angle = 2 * std::numbers::pi * i / kLensParts;
        const glm::dvec3 way = right * std::cos(angle) + up * std::sin(angle);
        double near = 0, far = kLensReach;
        for (int k = 0; k < 30; ++k) {
            const double half = 0.5 * (near + far);
            (lens.radius(inside + half * way) < 1 ? near : far) = half;
        }
        points.push_back(inside + near * way);
    }
    return points;
}

std::vector<PlaneSection> planeSections(const Session& session, const volume::DatasetInfo& info,
                                        const PicturePlane& plane) {
    std::vector<PlaneSection> sections;
    const auto add = [&](const std::vector<glm::dvec3>& points) -> PlaneSection* {
        if (points.empty()) return nullptr;
        PlaneSection& section = sections.emplace_back();
        for (const glm::dvec3& point : points) section.outline.push_back(plane.along(point));
        return &section;
    };
    const volume::AxisMaps& axes = info.lattice.axes;
    for (const vis::Brush& brush : session.selection.brushes) {
        PlaneSection* made = nullptr;
        if (const auto* ball = std::get_if<vis::SphereRegion>(&brush.region))
            made = add(ballSection(vis::sheetBox(*ball, axes), plane));
        if (const auto* box = std::get_if<vis::BoxRegion>(&brush.region)) {
            const vis::SheetBox drawn = vis::sheetBox(*box, axes);
            made = add(planeSection(plane.plane(), {drawn.center - drawn.radius, drawn.center + drawn.radius}));
        }
        if (!made) continue;
        made->color = brush.color;
        made->faint = !brush.enabled;
    }
    const vis::WorldFrame world = vis::worldFrame(info, session.stretch);
    const glm::dvec3 right = glm::normalize(plane.right * world.scale), up = glm::normalize(plane.up * world.scale);
    eachLens(session, world, [&](int, const vis::Lens& lens, const vis::PlacedLens& placed) {
        std::vector<glm::dvec3> points = lensSection(placed, world.sheetToWorld(plane.at), right, up);
        for (glm::dvec3& point : points) point = world.worldToSheet(point);
        PlaneSection* const made = add(points);
        if (!made) return;
        made->color = lens.color;
        made->dashed = true;
        made->middle = plane.along(world.worldToSheet(placed.center));
    });
    return sections;
}

void drawPlaneSections(ImDrawList& draw, const PlaneFrame& frame, const std::vector<PlaneSection>& sections) {
    const float width = std::max(1.0f, em() * 0.1f);
    for (const PlaneSection& section : sections) {
        std::vector<ImVec2> outline;
        for (const glm::dvec2& point : section.outline) outline.push_back(frame.pixel(point));
        if (!section.dashed) {
            draw.AddPolyline(outline.data(), static_cast<int>(outline.size()),
                             brushColor(section.color, section.faint ? 0.35f : 0.9f), ImDrawFlags_Closed, width);
            continue;
        }
        const ImU32 color = lensColor(section.color, 0.9f);
        LensDashes dashes(draw, width);
        for (std::size_t i = 0; i < outline.size(); ++i)
            dashes.line(outline[i], outline[(i + 1) % outline.size()], color);
        if (section.middle) draw.AddCircleFilled(frame.pixel(*section.middle), em() * 0.28f, color);
    }
}

} // namespace tessera::app
