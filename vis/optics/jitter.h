#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

/// Jitter of sample positions along rays and, for supersampled frames, of rays within pixels. Twin:
/// vis/shaders/lib/sampling/jitter.glsl.
namespace tessera::vis {

/// Offset of the samples along a ray, in steps, -1/2..1/2: interleaved gradient noise (Jimenez, Next generation
/// post-processing in Call of Duty, 2014), which differs strongly between neighbouring pixels, advanced by the golden
/// ratio per pass: fract(52.9829189 fract(0.06711056 x + 0.00583715 y) + 0.618034 pass). In 32-bit fixed point, so that
/// shader and C++ agree bit for bit.
inline double startJitter(std::uint32_t x, std::uint32_t y, std::uint32_t pass) {
    const std::uint32_t inner = x * 288237660u + y * 25070368u;
    const std::uint32_t outer =
        inner * 52u + std::uint32_t((std::uint64_t(inner) * 4221604530u) >> 32) + pass * 2654435769u;
    return double(outer >> 8) / 16777216.0 - 0.5;
}

/// Position within the pixel for pass 0, 1, ..., each axis -1/2..1/2: first the centre, then the additive sequence of
/// Roberts (The unreasonable effectiveness of quasirandom sequences, 2018).
inline glm::dvec2 pixelJitter(int pass) {
    const double x = 0.5 + pass * 0.7548776662466927, y = 0.5 + pass * 0.5698402909980532;
    return {x - double(long(x)) - 0.5, y - double(long(y)) - 0.5};
}

} // namespace tessera::vis
