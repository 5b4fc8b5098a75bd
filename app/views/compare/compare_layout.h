#pragma once

#include "app/pane/legend.h"
#include "app/tools/camera_hand.h"
#include "app/views/compare/compare_pictures.h"

/// Where the pictures of a comparison and their legends are; no legend covers a picture.
namespace tessera::app {

/// The room in a pane for the pictures with their legends, and the heights of what stands below, pixels.
struct CompareRooms {
    ImVec2 pictures;
    float table = 0, questions = 0;
};

/// Shares out the room below the tools of a comparison of so many variants. `figure`: nothing scrolls or is asked
/// there; `bare`: without the table.
CompareRooms compareRooms(const CompareView& view, std::size_t variants, ImVec2 room, bool figure, bool bare);

using CompareLegends = std::vector<std::vector<LegendEntry>>;

struct CompareLayout {
    std::vector<PictureBox> pictures;
    CompareLegends legends;         ///< one list if all variants have the same, else one for each variant
    std::vector<PictureBox> places; ///< of the legends; empty where there is no room or nothing to say
};

/// Places `count` pictures of one size in an area: their legends below each, or all of them below the one picture that
/// shows them. Legends that are equal are placed once, below everything.
CompareLayout compareLayout(CompareLegends legends, int count, ImVec2 at, ImVec2 area);

/// The legends of some variants, as far as their data are open.
CompareLegends variantLegends(const ViewContext& context, const std::vector<std::shared_ptr<CompareCell>>& cells,
                              const std::vector<std::size_t>& shown);

/// Width by height of a picture of the 3D scene in a pane of this size that has not been drawn yet: the least of what
/// it can be, since rows of tools and the legends of data that are not open are not known.
double comparedAspect(const CompareView& view, const Session& session, const volume::DatasetInfo& info, ImVec2 pane);

void drawCompareLegends(ImDrawList& draw, const CompareLayout& layout);

} // namespace tessera::app
