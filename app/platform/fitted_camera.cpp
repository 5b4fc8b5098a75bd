#include "app/platform/fitted_camera.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace tessera::app {

std::optional<SeenExtent> seenExtent(const vis::Image& scene) {
    constexpr int kSeen = 10; // of 255
    const auto pixel = [&](int x, int y) {
        return &scene.rgba[(std::size_t(y) * std::size_t(scene.size.x) + std::size_t(x)) * 4];
    };
    if (scene.size.x < 2 || scene.size.y < 2) return {};
    const int right = scene.size.x - 1, bottom = scene.size.y - 1;
    const std::array corners{pixel(0, 0), pixel(right, 0), pixel(0, bottom), pixel(right, bottom)};
    const auto isGround = [&](const std::uint8_t* at) {
        return std::ranges::any_of(corners, [&](const std::uint8_t* corner) {
            return std::abs(at[0] - corner[0]) <= kSeen && std::abs(at[1] - corner[1]) <= kSeen &&
                   std::abs(at[2] - corner[2]) <= kSeen;
        });
    };
    glm::ivec2 lo(scene.size), hi(-1);
    for (int y = 0; y <= bottom; ++y)
        for (int x = 0; x <= right; ++x)
            if (!isGround(pixel(x, y))) {
                lo = glm::min(lo, glm::ivec2(x, y));
                hi = glm::max(hi, glm::ivec2(x, y) + 1);
            }
    if (hi.x < 0) return {};
    const glm::dvec2 size(scene.size);
    const auto across = [&](int x) { return 2 * x / size.x - 1; };
    const auto up = [&](int y) { return 1 - 2 * y / size.y; };
    return SeenExtent{{across(lo.x), up(hi.y)}, {across(hi.x), up(lo.y)}};
}

void fitToSeen(vis::Camera& camera, const SeenExtent& seen, double aspect) {
    constexpr double kFilled = 0.9; // of the picture
    const glm::dvec2 middle = (seen.lo + seen.hi) / 2.0, half = (seen.hi - seen.lo) / 2.0;
    vis::pan(camera, glm::vec2(-middle), float(aspect));
    vis::zoom(camera, float(kFilled / std::max({half.x, half.y, 1e-3})));
}

} // namespace tessera::app
