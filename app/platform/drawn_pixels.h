#pragma once

#include "vis/image/image_io.h"

#include <glm/vec2.hpp>
#include <imgui.h>

/// What ImGui draws in a frame as pixels, without OpenGL: its triangles, as its back end for OpenGL draws them.
namespace tessera::app {

/// Draws the triangles of a command over an image, whose first pixel is pixel `lo` of the frame. Textures are
/// addresses (vis::MemoryTexture).
void drawPixels(const ImDrawList& list, const ImDrawCmd& command, glm::ivec2 lo, vis::Image& image);

} // namespace tessera::app
