#pragma once

#include "app/drawing/line_pieces.h"
#include "app/pane/axes3d.h"
#include "app/pane/view_context.h"

/// Outlines of lenses in space; their sections with planes are in plane_sections.h.
namespace tessera::app {

/// Pixel of a world point; nothing behind the eye.
std::optional<ImVec2> worldPixel(const SpaceFrame& frame, glm::dvec3 world);

/// Outlines of the enabled lenses, fainter behind their middle; lens `active` (-1: none) is drawn stronger.
void drawLenses(ImDrawList& draw, const SpaceFrame& frame, const Session& session, int active);

/// The colour of a lens's lines.
ImU32 lensColor(glm::vec3 color, float alpha);

/// Joined lines as dashes, so that a lens looks unlike a brush in space, whose lines are whole.
class LensDashes {
public:
    LensDashes(ImDrawList& draw, float width) : draw_(draw), width_(width), pattern_(em() * 0.55, em() * 0.9) {}
    void line(ImVec2 from, ImVec2 to, ImU32 color);

private:
    ImDrawList& draw_;
    float width_;
    DashPattern pattern_;
};

/// Calls `each(index, lens, placed)` for the lenses that act at the time shown and have a place in space.
template <class Each> void eachLens(const Session& session, const vis::WorldFrame& world, const Each& each) {
    const auto placed = vis::placeLenses(session.lenses, world, session.camera, session.cursor, session.time);
    std::size_t next = 0;
    for (std::size_t i = 0; i < session.lenses.size() && next < placed.size(); ++i) {
        const vis::Lens& lens = session.lenses[i];
        if (!vis::activeAt(lens, session.time)) continue;
        if (const vis::PlacedLens& own = placed[next++]; lens.inSpace()) each(static_cast<int>(i), lens, own);
    }
}

} // namespace tessera::app
