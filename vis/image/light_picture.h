#pragma once

#include "vis/optics/light_maps.h"

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

/// Pictures of surroundings that light a scene (Environment::Picture).
namespace tessera::vis {

/// Linear light, rows top down.
struct LightPicture {
    glm::ivec2 size{0};
    std::vector<glm::vec3> rgb;
};

/// Decodes a Radiance picture (.hdr: RGBE, flat or run-length coded, rows top down; G. Ward, Real pixels, Graphics Gems
/// II, 1991) or a PNG of any kind (sRGB). Throws Error naming `name` when it is neither, damaged, or of more than 2^25
/// pixels.
LightPicture decodeLightPicture(std::span<const std::uint8_t> bytes, const std::string& name);

/// The picture on the faces of a cube, each texel the mean of what falls into it. Its shape says how it is laid out:
///   2:1   all around; the middle is what lies behind the data for a viewer at the front (-z), left of it is -x
///   4:3   a cross: left, middle, right and back in a row, above and below the middle the top and the bottom
///   3:4   the same upright: the back below the bottom, upside down
/// Throws Error naming `name` for other shapes.
CubeMap surroundingsOf(const LightPicture& picture, const std::string& name);

/// Both, of a file. Throws Error.
CubeMap readSurroundings(const std::string& path);

} // namespace tessera::vis
