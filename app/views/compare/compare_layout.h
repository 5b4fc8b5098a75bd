#pragma once

#include "app/pane/legend.h"
#include "app/tools/camera_controller.h"
#include "app/views/compare/compare_pictures.h"

/// Where the pictures of a comparison and their legends are; no legend covers a picture.
namespace tessera::app {

using CompareLegends = std::vector<std::vector<LegendEntry>>;

struct CompareLayout {
    std::vector<PictureBox> pictures;
    CompareLegends legends; ///< one list if all variants have the same, else one for each variant or for neighbours
    std::vector<PictureBox> places; ///< of the legends; empty where there is no room or nothing to say
};

/// Places `count` pictures of one size in an area: their legends below each, or all of them below the one picture that
/// shows them. Legends that are equal are placed once, below everything, or below neighbours that share them. Bars of a
/// parameter in both of two files that have the same colours over the same range become equal.
CompareLayout compareLayout(CompareLegends legends, int count, ImVec2 at, ImVec2 area);

/// The legends of some variants; while the data of one are opened, with the ranges of the session's, so that pictures
/// mostly stay where they are.
CompareLegends variantLegends(const ViewContext& context, const std::vector<std::shared_ptr<CompareCell>>& cells,
                              const std::vector<std::size_t>& shown);

void drawCompareLegends(ImDrawList& draw, const CompareLayout& layout);

} // namespace tessera::app
