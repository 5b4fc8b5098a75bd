#include "app/views/volume/plane_in_space.h"

#include "app/pane/plot.h"
#include "app/pane/shown_plane.h"
#include "app/ui/time_text.h"

#include <algorithm>

namespace tessera::app {

void drawPlaneInSpace(ImDrawList& draw, const SpaceFrame& space, const Session& session,
                      const volume::DatasetInfo& info) {
    const auto plane = planeShown(session, info);
    if (!plane || plane->normal.w == 0) return;
    const Range times = timesMet(*plane);
    if (!(times.hi > times.lo)) return;
    for (const double time : {times.lo, times.hi}) {
        std::vector<ImVec2> outline;
        for (const glm::dvec3& corner : sectionAtTime(*plane, time, info.bounds))
            if (const auto pixel = space.pixel(corner)) outline.push_back(*pixel);
        if (outline.empty()) continue;
        draw.AddPolyline(outline.data(), static_cast<int>(outline.size()), plotColors().faint, ImDrawFlags_Closed, 1);
        const ImVec2 upper = *std::ranges::min_element(outline, {}, &ImVec2::y);
        addTextWithBackdrop(draw, {upper.x, upper.y - em() * 0.2f}, {0.5f, 1}, plotColors().text,
                            timeText(info, time).c_str());
    }
}

} // namespace tessera::app
