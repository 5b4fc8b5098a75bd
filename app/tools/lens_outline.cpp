#include "app/tools/lens_outline.h"

#include "vis/scene/lens_shape.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace tessera::app {

ImU32 lensColor(glm::vec3 color, float alpha) {
    return toColor({color.r, color.g, color.b}, double(alpha));
}

void LensDashes::line(ImVec2 from, ImVec2 to, ImU32 color) {
    if (std::hypot(to.x - from.x, to.y - from.y) > 2e4f) return; // across the eye
    pattern_.line({from.x, from.y}, {to.x, to.y}, [&](glm::dvec2 a, glm::dvec2 b) {
        draw_.AddLine({float(a.x), float(a.y)}, {float(b.x), float(b.y)}, color, width_);
    });
}

std::optional<ImVec2> worldPixel(const SpaceFrame& frame, glm::dvec3 world) {
    return frame.pixel(frame.world.toPhysical(world));
}

void drawLenses(ImDrawList& draw, const SpaceFrame& frame, const Session& session, int active) {
    const double aspect = double(frame.max.x - frame.min.x) / std::max(1.0f, frame.max.y - frame.min.y);
    const vis::Ray middle = vis::cameraRay(session.camera, aspect, {0, 0});
    eachLens(session, frame.world, [&](int index, const vis::Lens& lens, const vis::PlacedLens& placed) {
        const float width = std::max(1.0f, em() * (index == active ? 0.13f : 0.09f));
        const double depth = glm::dot(placed.center, middle.direction);
        LensDashes dashes(draw, width);
        const auto line = [&](glm::dvec3 a, glm::dvec3 b, float strength) {
            const glm::dvec3 from = placed.center + placed.fromUnit * a, to = placed.center + placed.fromUnit * b;
            const auto p = worldPixel(frame, from), q = worldPixel(frame, to);
            if (!p || !q) return;
            const double behind = 0.5 * glm::dot(from + to, middle.direction) - depth;
            const float seen = (behind > 1e-6 && placed.shape != vis::LensShape::Sphere) || strength < 1
                                   ? (behind > 1e-6 ? 0.55f : 1.0f)
                                   : 1.0f;
            dashes.line(*p, *q, lensColor(lens.color, 0.85f * strength * seen));
        };
        const bool perspective = session.camera.projection == vis::Projection::Perspective;
        const glm::dvec3 eye = placed.toUnit * (perspective ? middle.origin - placed.center : -middle.direction);
        vis::lensOutline(placed.shape, eye, perspective, line);
    });
}

} // namespace tessera::app
