#pragma once

#include "app/pane/plot.h"
#include "vis/transfer/transfer_function.h"

#include <optional>
#include <string>
#include <vector>

/// Colour legends, painted from the same function that fills the renderer's lookup tables.
namespace tessera::app {

/// A label value as legends show it.
struct NamedColor {
    std::string name;
    glm::vec3 color{0}; ///< sRGB
    bool operator==(const NamedColor&) const = default;
};

/// One colour bar, one swatch with a value (an iso-surface), or the names of a label.
struct LegendEntry {
    std::string title, unit;
    vis::TransferFunction function;
    Range range;                   ///< values at the ends of the bar
    Range data;                    ///< of the channel; beyond `range` there are arrow heads at the ends
    std::optional<double> marker;  ///< value at the linked cursor
    bool swatch = false;           ///< only `color` and `value`
    std::array<double, 3> color{}; ///< sRGB of a swatch
    double value = 0;
    std::vector<NamedColor> names = {}; ///< of a label: in place of a bar
    bool opacity = false;               ///< the bar shows the function's opacity and not its colours
    bool regions = false;               ///< the bar shows the colours of regions; bare where none has the value
    bool operator==(const LegendEntry&) const = default;
};

/// A horizontal strip of a colour map between two pixels, left = lowest value; opacity over a chequered ground if
/// wanted.
void drawColorStrip(ImDrawList& draw, ImVec2 min, ImVec2 max, const vis::TransferFunction& function,
                    bool withOpacity = false);

/// The same in the colours of the function's regions; bare where none has the value.
void drawRegionStrip(ImDrawList& draw, ImVec2 min, ImVec2 max, const vis::TransferFunction& function);

/// The same of the opacity alone, as parts of the greatest: regions count with their most at any gradient.
void drawOpacityStrip(ImDrawList& draw, ImVec2 min, ImVec2 max, const vis::TransferFunction& function);

/// Whether legends that would be `height` pixels high together are one line each, to leave the object of a picture of
/// `room` pixels in sight.
bool legendsAsLines(float height, float room);

/// Legends stacked in a corner of a rectangle, at most as many as fit; returns the pixels they cover. `whole`: never
/// one line each.
struct LegendArea {
    ImVec2 min, max;
};
enum class LegendCorner { BottomRight, TopRight, TopLeft };
/// The pixels that drawLegends() covers.
LegendArea legendArea(const std::vector<LegendEntry>& entries, ImVec2 min, ImVec2 max, LegendCorner corner,
                      bool whole = false);
LegendArea drawLegends(ImDrawList& draw, const std::vector<LegendEntry>& entries, ImVec2 min, ImVec2 max,
                       LegendCorner corner = LegendCorner::BottomRight, bool whole = false);

/// Legends side by side in rows, as they are placed below a picture; those that do not fit into `most` are dropped.
/// Returns the height, 0 if there are none.
float legendRowsHeight(const std::vector<LegendEntry>& entries, float width, float most);
void drawLegendRows(ImDrawList& draw, const std::vector<LegendEntry>& entries, ImVec2 min, float width, float most);

/// One horizontal bar with ticks and title below in the given width; returns its height.
float drawLegendBar(ImDrawList& draw, ImVec2 min, float width, const LegendEntry& entry);
float legendBarHeight();
/// The same as an item of the window, at most 20 em wide; where it is not `shown` its room stays empty.
void legendBarItem(const LegendEntry& entry, bool shown);

/// One narrow upright bar, highest value on top, with the values of its ends at its right; about five em wide.
void drawLegendColumn(ImDrawList& draw, ImVec2 min, float height, const LegendEntry& entry);

} // namespace tessera::app
