#pragma once

#include "vis/demand/box_lines.h"
#include "vis/packet/packet_renderer.h"

#include <cstdint>
#include <glm/ext/vector_uint3_sized.hpp>
#include <vector>

namespace tessera::vis {

/// Linear light as a colour of a screen, 8 bits for each part.
glm::u8vec3 screenColor(glm::dvec3 linear);

/// A whole picture over its background or paper, with the lines of the box, tone-mapped: RGBA8, sRGB, rows bottom up.
/// Not premultiplied where the scene shows no ground. Twin: vis/shaders/resolve.frag.glsl.
std::vector<std::uint8_t> presented(const packet::PacketPicture& picture, const Scene& scene, const BoxLines& lines);

} // namespace tessera::vis
