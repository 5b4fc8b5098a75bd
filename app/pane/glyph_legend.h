#pragma once

#include "vis/scene/glyph_layer.h"
#include "volume/field/dataset.h"

#include <array>
#include <imgui.h>
#include <optional>
#include <string>
#include <vector>

/// The legend of a layer of glyphs: a picture of one, and what its parts show.
namespace tessera::app {

struct GlyphLegend {
    struct Part {
        std::string part, channel, unit;
        Range range;                                     ///< values of the least and the most of the part
        std::optional<std::array<double, 3>> color = {}; ///< sRGB, of parts with a colour of their own
        std::optional<double> value = {};                ///< at the cross-hair
        bool operator==(const Part&) const = default;
    };
    vis::GlyphKind kind = vis::GlyphKind::Star;
    std::vector<Part> parts; ///< those that a parameter of the data moves
    bool atCursor = false;   ///< the values at the cross-hair are known; one that is missing is absent there
    bool operator==(const GlyphLegend&) const = default;
};

/// The parts of a layer that parameters of the data move, without values.
GlyphLegend glyphLegendOf(const vis::GlyphLayer& layer, const volume::DatasetInfo& info);

/// "Star glyphs".
std::string glyphKindTitle(vis::GlyphKind kind);

/// A glyph in a square of the given size around its middle; `shares`: as vis::makeGlyphShape takes them.
void drawGlyphPicture(ImDrawList& draw, ImVec2 middle, float size, vis::GlyphKind kind,
                      const std::vector<double>& shares);

/// The title, the picture of a glyph whose parts are at their most, or of that at the cross-hair where its values are
/// known, and a line for each part: name, range and unit. Returns the height.
float drawGlyphLegend(ImDrawList& draw, ImVec2 min, float width, const std::string& title, const GlyphLegend& legend);
float glyphLegendHeight(const GlyphLegend& legend);

} // namespace tessera::app
