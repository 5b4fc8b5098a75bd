#include "vis/processor/anaglyph.h"

#include "vis/formulas/anaglyph.h"
#include "vis/optics/ray_setup.h"
#include "vis/processor/presented.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <array>

namespace tessera::vis {

MemoryTexture anaglyphOf(const MemoryTexture& left, const MemoryTexture& right) {
    std::array<double, 256> linear{};
    for (std::size_t i = 0; i < linear.size(); ++i) linear[i] = linearFromSrgb(glm::dvec3(double(i) / 255)).x;
    MemoryTexture out{.size = left.size, .rgba = std::vector<std::uint8_t>(left.rgba.size())};
    const auto colorAt = [&](const MemoryTexture& picture, std::size_t at) {
        if (at + 3 >= picture.rgba.size()) return glm::dvec3(0);
        return glm::dvec3(linear[picture.rgba[at]], linear[picture.rgba[at + 1]], linear[picture.rgba[at + 2]]);
    };
    const std::size_t row = std::size_t(std::max(left.size.x, 0)) * 4;
    parallelFor(std::size_t(std::max(left.size.y, 0)), [&](std::size_t y) {
        for (std::size_t at = y * row; at < (y + 1) * row; at += 4) {
            const glm::u8vec3 color = screenColor(anaglyphColor<double>(colorAt(left, at), colorAt(right, at)));
            for (int c = 0; c < 3; ++c) out.rgba[at + std::size_t(c)] = color[c];
            out.rgba[at + 3] =
                std::max(left.rgba[at + 3], at + 3 < right.rgba.size() ? right.rgba[at + 3] : std::uint8_t(0));
        }
    });
    return out;
}

} // namespace tessera::vis
