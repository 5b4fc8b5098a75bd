#pragma once

#include "app/pane/plot.h"
#include "vis/transfer/transfer_function.h"

#include <vector>

/// Regions of a transfer function as shapes that the mouse moves. Places are those of the regions: value and gradient
/// magnitude, 0..1 each.
namespace tessera::app {

enum RegionEdge { kRegionLeft = 1, kRegionRight = 2, kRegionLow = 4, kRegionHigh = 8 };

/// A region and which of its edges, bits of RegionEdge; 0 = its inside. -1: none.
struct RegionHit {
    int region = -1, edges = 0;
    bool operator==(const RegionHit&) const = default;
};
/// What lies under a place, `reach` from edges; the selected region lies on top, then the last made.
RegionHit hitRegion(const std::vector<vis::TransferRegion>& regions, glm::vec2 place, glm::vec2 reach, int selected);

/// The region with the held edges moved, or all of it; never thinner than 0.01, its middle stays in the plane.
vis::TransferRegion draggedRegion(const vis::TransferRegion& original, int edges, glm::vec2 by);

/// What the mouse holds; one per view.
struct RegionDrag {
    int selected = -1; ///< region whose settings are shown
    bool active = false;
    int edges = 0;
    glm::vec2 start{0};
    vis::TransferRegion original;
};

/// Mouse on the plot whose InvisibleButton (left and right) was the last item: a drag moves a region or its edges, or
/// makes one on an empty place; a right click removes the one there. Returns true when the regions changed.
bool editRegions(RegionDrag& drag, std::vector<vis::TransferRegion>& regions, const PlotFrame& plane);

/// Regions with their colour and opacity; `function` gives the colour of those without their own.
void drawRegions(ImDrawList& draw, const vis::TransferFunction& function, const PlotFrame& plane, int selected);

} // namespace tessera::app
