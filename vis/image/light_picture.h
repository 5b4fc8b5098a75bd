#pragma once

#include "vis/optics/light_maps.h"

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

/// Environment pictures that light a scene (Environment::Picture).
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

/// Resamples a picture to the faces of a cube; each texel is the mean of the pixels in it. The aspect ratio tells the
/// projection:
///   2:1   equirectangular; the centre is what lies behind the data for a viewer at the front (-z), left of it is -x
///   4:3   a cross: left, centre, right and back in a row, top and bottom above and below the centre
///   3:4   an upright cross: the back is below the bottom, upside down
/// Throws Error naming `name` for other aspect ratios.
CubeMap surroundingsOf(const LightPicture& picture, const std::string& name);

/// Decodes and resamples a file. Throws Error.
CubeMap readSurroundings(const std::string& path);

} // namespace tessera::vis
