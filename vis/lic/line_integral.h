#pragma once

#include "vis/scene/strokes.h"
#include "volume/base/progress.h"

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

/// Line integral convolution: B. Cabral, L. C. Leedom: Imaging vector fields using line integral convolution,
/// SIGGRAPH 1993.
namespace tessera::vis {

/// Vectors of a plane in square texels, row by row.
struct PlaneField {
    glm::ivec2 size{0};
    std::vector<glm::vec2> vectors;        ///< along rows and columns, any unit; NaN: absent
    std::vector<std::uint16_t> parts = {}; ///< numbers of parts that lines do not leave; empty: all are one

    std::size_t index(glm::ivec2 at) const { return std::size_t(at.y) * std::size_t(size.x) + std::size_t(at.x); }
    bool present(glm::ivec2 at) const;
    /// The direction, of length 1, at a place in texels (the middle of the first is at 0.5), linear between those
    /// texels that are present and of the part; length 0 where the vector vanishes.
    glm::dvec2 direction(glm::dvec2 at, std::uint16_t part) const;
};

/// Noise of a plane in [-1, 1) with even distribution: random at every `grain`-th texel, linear between. `first`:
/// number of the first texel, so that a texel of one number has one value in every rectangle; `seed`: as numbers of
/// generators.
std::vector<float> planeNoise(glm::ivec2 size, glm::ivec2 first, int grain, std::uint32_t seed);

/// Random in [-1, 1) by the corner of a grid.
double noiseAt(glm::ivec3 corner, std::uint32_t seed);

/// Weight at a share of half the length of the kernel, 1 in its middle.
double kernelWeight(double share, StrokeKernel kernel);

/// Stretches values to mean 0 and the deviation kStrokeDeviation, clipped at -1 and 1; NaNs are left out and stay.
void stretchContrast(std::vector<float>& values);

struct LineIntegralSettings {
    double length = 40; ///< of the kernel, texels; half of it to each side
    StrokeKernel kernel = StrokeKernel::Hann;
};

/// The mean of the noise along the line through the middle of each texel, weighted by the kernel, over the root of the
/// sum of squared weights, so that contrast does not depend on how far a line comes. Lines go in steps of one texel
/// (the last one is shorter) by the rule of the midpoint with vectors of length 1; they end where the field is absent,
/// of another part, at the border, or 0. Where the vector is 0 the noise itself; absent texels are NaN. `noise`: one
/// number per texel. Lightness of the whole is then stretched to mean 0 and the deviation kStrokeDeviation, and clipped
/// at -1 and 1. The result does not depend on the number of threads. Throws Cancelled.
std::vector<float> lineIntegralConvolution(const PlaneField& field, std::span<const float> noise,
                                           const LineIntegralSettings& settings, const Progress& progress = {});
inline constexpr double kStrokeDeviation = 0.45;

} // namespace tessera::vis
