#include "app/views/volume/plane_in_space.h"

#include "app/pane/oblique_plane.h"
#include "app/pane/plot.h"
#include "app/pane/shown_plane.h"
#include "app/ui/time_text.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::app {

namespace {

/// The times at which a plane that moves meets the box, among those of the data.
Range timesInBox(const volume::SpaceTimePlane& plane) {
    Range meets{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (int corner = 0; corner < 8; ++corner) {
        glm::dvec3 at;
        for (int a = 0; a < 3; ++a) at[a] = (corner >> a & 1) != 0 ? plane.hi[a] : plane.lo[a];
        const double time = -(glm::dot(glm::dvec3(plane.normal), at) + plane.e) / plane.normal.w;
        meets = {std::min(meets.lo, time), std::max(meets.hi, time)};
    }
    return {std::max(meets.lo, plane.lo.w), std::min(meets.hi, plane.hi.w)};
}

} // namespace

void drawPlaneInSpace(ImDrawList& draw, const SpaceFrame& space, const Session& session,
                      const volume::DatasetInfo& info) {
    const auto plane = planeShown(session, info);
    const glm::dvec3 normal = plane ? glm::dvec3(plane->normal) : glm::dvec3(0);
    if (!plane || normal == glm::dvec3(0) || plane->normal.w == 0) return;
    const Range times = timesInBox(*plane);
    if (!(times.hi > times.lo)) return;
    for (const double time : {times.lo, times.hi}) {
        const glm::dvec3 at = -(plane->normal.w * time + plane->e) / glm::dot(normal, normal) * normal;
        std::vector<ImVec2> outline;
        for (const glm::dvec3& corner : planeSection({unitNormal(normal), at}, info.bounds))
            if (const auto pixel = space.pixel(corner)) outline.push_back(*pixel);
        if (outline.empty()) continue;
        draw.AddPolyline(outline.data(), static_cast<int>(outline.size()), plotColors().faint, ImDrawFlags_Closed, 1);
        const ImVec2 upper = *std::ranges::min_element(outline, {}, &ImVec2::y);
        addTextWithBackdrop(draw, {upper.x, upper.y - em() * 0.2f}, {0.5f, 1}, plotColors().text,
                            timeText(info, time).c_str());
    }
}

} // namespace tessera::app
