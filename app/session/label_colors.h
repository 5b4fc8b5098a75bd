#pragma once

#include "vis/transfer/transfer_function.h"
#include "volume/field/dataset.h"

#include <glm/vec3.hpp>
#include <optional>
#include <string>

namespace tessera::app {

/// Colour (sRGB, 0..1) of a label value: the one the data state, else that of the colour map "labels".
glm::vec3 labelColor(const volume::Parameter& label, int value);

/// Steps of colour along a range that give every label value its colour; none where the data state no colours: then the
/// colour map "labels" has them all.
std::vector<vis::ColorStop> labelStops(const volume::Parameter& label, Range range);

/// "#e07b39" as a colour; nothing where the text is none.
std::optional<glm::vec3> parsedColor(const std::string& text);
std::string colorText(glm::vec3 color);

} // namespace tessera::app
