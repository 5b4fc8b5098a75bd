#pragma once

#include "app/pane/glyph_legend.h"
#include "app/pane/plot.h"
#include "app/values/plot.h"
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

/// One colour bar, one swatch with a value (an iso-surface), the names of a label, or a glyph with its parts.
struct LegendEntry {
    std::string title, unit;
    vis::TransferFunction function;
    Range range;                   ///< values at the ends of the bar
    Range data;                    ///< of the channel; beyond `range` there are arrow heads at the ends
    std::optional<double> marker;  ///< value at the linked cursor
    bool swatch = false;           ///< only `color` and `value`
    std::array<double, 3> color{}; ///< sRGB of a swatch
    double value = 0;
    std::vector<NamedColor> names = {};    ///< of a label: in place of a bar
    bool opacity = false;                  ///< the bar shows the function's opacity and not its colours
    bool regions = false;                  ///< the bar shows the colours of regions; bare where none has the value
    std::optional<GlyphLegend> glyph = {}; ///< in place of a bar; its title is `title`
    bool operator==(const LegendEntry&) const = default;
};

/// A horizontal strip of a colour map between two pixels, left = lowest value; opacity over a chequered ground if
/// wanted. `range`: of the values, which the colours of labels follow.
void drawColorStrip(ImDrawList& draw, ImVec2 min, ImVec2 max, const vis::TransferFunction& function,
                    bool withOpacity = false, Range range = {0, 1});

/// The same in the colours of the function's regions; bare where none has the value.
void drawRegionStrip(ImDrawList& draw, ImVec2 min, ImVec2 max, const vis::TransferFunction& function);

/// The same of the opacity alone, as parts of the greatest: regions count with their most at any gradient.
void drawOpacityStrip(ImDrawList& draw, ImVec2 min, ImVec2 max, const vis::TransferFunction& function);

/// One legend, whole; returns its height.
float drawLegend(ImDrawList& draw, ImVec2 min, float width, const LegendEntry& entry);
float legendHeight(const LegendEntry& entry);

/// The strip of a bar alone: its colours, or what else it shows; and a line at the value of the cross-hair.
void drawLegendStrip(ImDrawList& draw, ImVec2 lo, ImVec2 hi, const LegendEntry& entry);
void drawLegendMarker(ImDrawList& draw, const PlotFrame& frame, const LegendEntry& entry);
/// Arrow heads at its ends where the data extend beyond it, at the low or the high end; so far do they reach.
bool beyondLegend(const LegendEntry& entry, bool high);
void drawLegendArrows(ImDrawList& draw, ImVec2 lo, ImVec2 hi, const LegendEntry& entry);
float legendArrow();
float legendStripHeight();

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
float legendColumnWidth(const LegendEntry& entry);

/// The same for the plot of a picture in the colours of a function.
PlotColorKey colorKey(const vis::TransferFunction& function, Range range);

} // namespace tessera::app
