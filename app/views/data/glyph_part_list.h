#pragma once

#include "app/ui/widgets.h"
#include "vis/scene/glyph_layer.h"

/// The parts of a glyph in the settings of its layer.
namespace tessera::app {

/// The payload of a parameter that is dragged: its name, as text.
inline constexpr const char* kParameterPayload = "tessera-parameter";

/// A picture of the glyph, and for each part of the kind a choice of the parameter that moves it, onto which one can be
/// dragged; of those that are moved the values of the least and the most. True, as it draws the whole member.
bool drawGlyphParts(const WidgetContext& widgets, vis::GlyphLayer& layer);

/// Sets the parameter of a part; "": at rest. Another parameter has its own range.
void setGlyphPart(vis::GlyphLayer& layer, std::string_view part, const std::string& channel);

} // namespace tessera::app
