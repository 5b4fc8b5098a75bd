#include "app/tools/profile_line.h"

#include <algorithm>
#include <glm/common.hpp>

namespace tessera::app {

namespace {

constexpr int kBentParts = 128; ///< of a line that uneven axes may bend

/// Lines of all profiles through `pixel(position)`; they are straight in space, and bent where axes are uneven.
template <class Pixel>
void drawLines(ImDrawList& draw, const Session& session, const volume::AxisMaps& axes, const Pixel& pixel) {
    const PlotColors colors = plotColors();
    for (const auto& [pane, view] : session.views) {
        const auto* profile = std::get_if<ProfileView>(&view);
        if (!profile || profile->points.size() < 2) continue;
        std::optional<ImVec2> last;
        for (std::size_t i = 0; i < profile->points.size(); ++i) {
            const int parts = i == 0 || axes.isEven() ? 1 : kBentParts;
            std::optional<ImVec2> at;
            for (int k = 1; k <= parts; ++k) {
                const glm::dvec3 to = profile->points[i];
                at = pixel(k == parts ? to : glm::mix(profile->points[i - 1], to, static_cast<double>(k) / parts));
                if (last && at) draw.AddLine(*last, *at, colors.text, std::max(1.0f, em() * 0.12f));
                last = at;
            }
            if (at) draw.AddCircleFilled(*at, em() * (i == 0 ? 0.3f : 0.2f), colors.text);
        }
    }
}

} // namespace

std::vector<glm::dvec3> profileCorners(const ProfileView& view, const Session& session, const volume::Box& bounds) {
    if (view.points.size() >= 2) return view.points;
    const glm::dvec3 size = bounds.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    glm::dvec3 from = glm::clamp(session.cursor, bounds.lo, bounds.hi), to = from;
    from[axis] = bounds.lo[axis];
    to[axis] = bounds.hi[axis];
    return {from, to};
}

void drawProfileLines(ImDrawList& draw, const SpaceFrame& frame, const Session& session) {
    drawLines(draw, session, frame.world.axes, [&](glm::dvec3 at) { return frame.pixel(at); });
}

void drawProfileLines(ImDrawList& draw, const PlaneFrame& frame, const Session& session) {
    drawLines(draw, session, frame.world.axes, [&](glm::dvec3 at) { return std::optional(frame.pixel(at)); });
}

} // namespace tessera::app
