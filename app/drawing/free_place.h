#pragma once

#include "app/drawing/drawing.h"

#include <optional>
#include <span>

/// Where the list of the series of a plot stands.
namespace tessera::app {

/// The place of a list of `size` within `plot` where it covers none of the marks: one of the corners, else the middle
/// of an edge. Texts and pictures do not count.
std::optional<shapes::PageBox> freePlace(glm::dvec2 size, const shapes::PageBox& plot,
                                         std::span<const shapes::Mark> marks);

} // namespace tessera::app
