#pragma once

#include "vis/scene/look.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <gtest/gtest.h>
#include <vector>

/// What is known of a translucent ball's silhouette, by rays and as polygons.
namespace tessera::vis {

inline constexpr float kSilhouetteOpacity = 0.3f; ///< of the surface
inline const SilhouetteEnhancement kSilhouette{.retained = 0.1f, .strength = 2.5f, .exponent = 2};

/// Expects front and back of a ball, each a' = 0.3 (0.1 + 2.5 (1 - |n.v|)^2), seen from afar; `place(x, y)`: of a
/// pixel, in radii from the middle.
template <class Place>
void expectSilhouette(const std::vector<glm::vec4>& picture, glm::ivec2 size, const Place& place) {
    int rim = 0, inner = 0;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const double r = glm::length(place(x, y)), alpha = double(picture[std::size_t(y * size.x + x)].a);
            if (r > 1.03) {
                EXPECT_EQ(alpha, 0);
            }
            if (r > 0.95) continue;
            const double own = 0.3 * (0.1 + 2.5 * std::pow(1 - std::sqrt(1 - r * r), 2));
            EXPECT_NEAR(alpha, 1 - (1 - own) * (1 - own), 0.02) << r;
            rim += r > 0.9 && alpha > 0.3;
            inner += r < 0.5 && alpha < 0.1;
        }
    EXPECT_GT(rim, 50);
    EXPECT_GT(inner, 500);
}

} // namespace tessera::vis
