#include "vis/scene/strokes.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::vis {

StrokeMap strokeMap(const StrokePicture& picture) {
    const glm::dvec3 right = picture.right / picture.texel, up = picture.up / picture.texel;
    return {glm::dvec4(right, -glm::dot(right, picture.corner)), glm::dvec4(up, -glm::dot(up, picture.corner))};
}

glm::dvec2 sliceStrokes(const StrokePicture& picture, glm::dvec3 place) {
    const StrokeMap map = strokeMap(picture);
    const glm::dvec4 at(place, 1);
    const glm::dvec2 texel = glm::dvec2(glm::dot(map.across, at), glm::dot(map.up, at)) - 0.5, low = glm::floor(texel),
                     share = texel - low;
    const auto read = [&](int i, int j) {
        const glm::ivec2 clamped = glm::clamp(glm::ivec2(low) + glm::ivec2(i, j), glm::ivec2(0), picture.size - 1);
        return glm::dvec2(
            picture.texels[std::size_t(clamped.y) * std::size_t(picture.size.x) + std::size_t(clamped.x)]);
    };
    return glm::mix(glm::mix(read(0, 0), read(1, 0), share.x), glm::mix(read(0, 1), read(1, 1), share.x), share.y);
}

} // namespace tessera::vis
