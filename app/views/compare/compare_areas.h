#pragma once

#include "app/session/session.h"

#include <imgui.h>

/// How the room of a comparison's pane is shared out, also before it is drawn.
namespace tessera::app {

/// The room in a pane for the pictures with their legends, and the heights of what stands below, pixels.
struct CompareAreas {
    ImVec2 pictures;
    float table = 0, questions = 0;
};

/// Shares out the room below the tools of a comparison of so many variants. `figure`: nothing scrolls or is asked
/// there; `bare`: without the table.
CompareAreas compareAreas(const CompareView& view, std::size_t variants, ImVec2 room, bool figure, bool bare);

/// Width by height of a picture of the 3D scene in a pane of this size that has not been drawn yet: the least of what
/// it can be, since rows of tools and the legends of data that are not open are not known.
double comparedAspect(const CompareView& view, const Session& session, const volume::DatasetInfo& info, ImVec2 pane);

} // namespace tessera::app
