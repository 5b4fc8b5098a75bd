#pragma once

#include "vis/demand/box_lines.h"
#include "vis/packet/packet_renderer.h"

#include <cstdint>
#include <glm/ext/vector_uint3_sized.hpp>
#include <vector>

namespace tessera::vis {

/// Linear light as a colour of a screen, 8 bits for each part.
glm::u8vec3 screenColor(glm::dvec3 linear);

/// Whether a scene is presented pixel by pixel, without what a curve of tones, the grain of paper or blur would change:
/// that is quick.
bool presentsPlainly(const Scene& scene);

/// Pixels of `box` in a picture, of which `picture` holds a part at least (elsewhere nothing is seen), over the
/// background or paper, with the lines of the box, tone-mapped: RGBA8, sRGB, rows bottom up. Not premultiplied where
/// the scene shows no ground. Blur and shadows of depth are left to others.
std::vector<std::uint8_t> presented(const packet::PacketPicture& picture, const packet::PixelBox& box,
                                    const Scene& scene, const BoxLines& lines,
                                    packet::InstructionSet with = packet::instructionSets().back());

} // namespace tessera::vis
