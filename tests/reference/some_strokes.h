#pragma once

#include "vis/scene/strokes.h"

#include <memory>

/// Strokes of few and large texels, some without any, in a plane through the middle of the world.
namespace tessera::vis::reference {

inline std::shared_ptr<const StrokePicture> someStrokes(glm::dvec3 right, glm::dvec3 up) {
    auto made = std::make_shared<StrokePicture>();
    made->size = {17, 13};
    made->right = right;
    made->up = up;
    made->texel = 0.05;
    made->corner = -right * 0.4 - up * 0.3; // beyond it the outermost texels go on
    std::uint32_t random = 1;
    for (int i = 0; i < made->size.x * made->size.y; ++i) {
        random = random * 1664525u + 1013904223u;
        const bool there = (random >> 9) % 5 != 0;
        made->texels.emplace_back(there ? float(random >> 8) / 8388608.0f - 1 : 0.0f, there ? 1 : 0);
    }
    return made;
}

} // namespace tessera::vis::reference
