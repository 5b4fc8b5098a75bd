#pragma once

#include "app/drawing/drawing.h"
#include "app/ui/theme.h"

#include <functional>
#include <glm/vec2.hpp>
#include <imgui.h>
#include <vector>

/// What ImGui draws in a frame as a page of vector graphics. Texts stay texts and shapes stay shapes; what has a
/// texture or a gradient becomes a raster picture.
namespace tessera::app {

/// Some triangles of a draw list.
struct DrawnPart {
    ImDrawList* list = nullptr;
    ImDrawCmd command; ///< of these triangles only
};

/// Draws parts over each other on a transparent ground: the pixels from `lo` to before `hi`, row 0 at the top.
using RasterizeParts = std::function<vis::Image(const std::vector<DrawnPart>& parts, glm::ivec2 lo, glm::ivec2 hi)>;

/// The page of a frame drawn without antialiasing, whose soft edges would be shapes as well. `points`: of the page per
/// pixel. `fonts` are those that the frame used.
VectorPage pageOf(const ImDrawData& frame, const Fonts& fonts, double points, const RasterizeParts& rasterize);

} // namespace tessera::app
