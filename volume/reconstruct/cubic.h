#pragma once

#include "volume/reconstruct/prefilter.h"
#include "volume/reconstruct/reconstruct.h"

#include <array>
#include <span>

/// Reconstruction by cubic B-splines, in double: the judge of the filter "cubic" of pictures.
///
/// On CC the tensor product of cubic B-splines, on BCC the mean of those of both sublattices (B. Csebfalvi,
/// M. Hadwiger, Prefiltered B-spline reconstruction for hardware-accelerated rendering of optimally sampled volumetric
/// data, VMV 2006). The kernel smooths; so samples are replaced by coefficients first, such that cubic polynomials are
/// reproduced.
namespace tessera::volume {

/// Weights of the samples -1, 0, 1 and 2 at a place a `fraction` beyond sample 0.
template <class N> std::array<N, 4> cubicWeights(N fraction) {
    const N f = fraction, g = N(1) - f, third(1.0 / 3), sixth(1.0 / 6);
    return {g * g * g * sixth, N(2) * third - f * f * (N(1) - N(0.5) * f), N(2) * third - g * g * (N(1) - N(0.5) * g),
            f * f * f * sixth};
}

/// Adds `weight` times the tricubic B-spline of one sublattice at a continuous index of it.
template <class Samples>
void addTricubic(Blend& blend, const Samples& samples, glm::dvec3 index, int sublattice, int sliceStep, double weight) {
    const glm::dvec3 base = glm::floor(index), f = index - base;
    const glm::ivec3 first = glm::ivec3(base) - 1;
    const std::array<double, 4> x = cubicWeights(f.x), y = cubicWeights(f.y), z = cubicWeights(f.z);
    Blend sum = blend;
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i) {
                const double w = x[std::size_t(i)] * y[std::size_t(j)] * z[std::size_t(k)];
                if (w == 0) continue;
                sum.add(w * weight,
                        samples(glm::ivec3(first.x + i, first.y + j, (first.z + k) * sliceStep + sublattice)));
            }
    blend = sum;
}

/// CC: the tricubic B-spline. BCC: the mean of those of both sublattices.
template <class Samples> Blend cubic(const LevelGeometry& geometry, const Samples& samples, glm::dvec3 cells) {
    Blend blend;
    if (geometry.kind == LatticeKind::CC) {
        addTricubic(blend, samples, geometry.toSublattice(cells, 0), 0, 1, 1);
    } else {
        addTricubic(blend, samples, geometry.toSublattice(cells, 0), 0, 2, 0.5);
        addTricubic(blend, samples, geometry.toSublattice(cells, 1), 1, 2, 0.5);
    }
    return blend;
}

/// Factors of the steps by which coefficients come from samples: c += factor * (samples - B c), B the kernel at the
/// samples. What is left of a wave that B damps to b is the product of (1 - factor * b): the square of 1 - b, so that
/// cubics are exact, and zeros at b = 1/2 (CC), and at 2/3, 1/2 and 1/4 (BCC, whose kernel damps its shortest waves to
/// nothing, so that no steps could restore them).
std::span<const double> cubicSteps(const LevelGeometry& geometry);

/// Coefficients of the samples of a brick, which has prefilterReach() less of each sublattice on every side. An absent
/// sample counts as the value of the one beside which it is read, and becomes 0.
BrickSamples cubicCoefficients(const BrickSamples& gathered, const LevelGeometry& geometry);

} // namespace tessera::volume
