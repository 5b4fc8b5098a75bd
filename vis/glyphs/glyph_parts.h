#pragma once

#include "vis/scene/glyph_layer.h"
#include "volume/field/dataset.h"

#include <optional>

/// What of a glyph can be moved by parameters.
namespace tessera::vis {

/// Names of all parts of a kind. The first kCommonGlyphParts are those of every kind and are of the whole glyph: size,
/// color, opacity, tilt.
std::span<const std::string_view> glyphPartNames(GlyphKind kind);
inline constexpr std::size_t kCommonGlyphParts = 4;
enum CommonGlyphPart : std::size_t { kSizePart, kColorPart, kOpacityPart, kTiltPart };

/// Index in glyphPartNames().
std::optional<std::size_t> findGlyphPart(GlyphKind kind, std::string_view name);

/// Whether a glyph that lacks the value of a part is left out; of other kinds the part alone is, which leaves a gap.
bool isWholeGlyph(GlyphKind kind, std::size_t part);

/// Colour of its own (sRGB) of a part, by which a legend can name it; nothing for parts in the colour of the glyph.
std::optional<glm::vec3> glyphPartColor(GlyphKind kind, std::size_t part);

/// The channel whose transfer function colours what has no colour of its own: that of the part "color", or of the
/// layer.
const std::string& glyphColorChannel(const GlyphLayer& layer);

/// Whether some of a glyph has the colours of that function: else what has no colour of its own is neutral.
bool glyphShowsColor(const GlyphLayer& layer);

/// Whether a kind lies in a plane, which is turned to where the glyphs face; others stand upright on it.
bool isFlatGlyph(GlyphKind kind);

/// Values of the least and the most of a part: its own range, or that of its parameter if it has none. Nothing where
/// the data have no such parameter.
std::optional<Range> glyphPartRange(const GlyphPart& part, const volume::DatasetInfo& info);

/// The first parameters that vary, as many as a kind has parts of its own but no more than six, for a first picture.
std::vector<GlyphPart> firstGlyphParts(GlyphKind kind, const volume::DatasetInfo& info);

/// The same parameters on the parts of another kind, in order; those without room are left out.
std::vector<GlyphPart> partsOnKind(std::span<const GlyphPart> parts, GlyphKind from, GlyphKind to);

} // namespace tessera::vis
