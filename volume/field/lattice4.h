#pragma once

#include "volume/field/lattice.h"

#include <glm/vec4.hpp>

/// Where samples lie in space and time.
///
/// CC is a grid repeated at equal distances of time. D4* is two of them, the second moved by half a cell in x, y, z and
/// t: stored as frames, each a CC grid, those of odd number moved by half a cell in x, y and z:
///
///     position = origin + spacing * (i + h, j + h, k + h, frame / 2)   with h = 1/2 for odd frames, else 0   (D4*)
///     position = origin + spacing * (i, j, k, frame)                                                         (CC)
///
/// The densest packing of spheres in the frequency domain: 50 % of the samples of CC carry a signal whose spectrum is a
/// ball. (J. Conway, N. Sloane, Sphere packings, lattices and groups, 1988; Röber 2002, section 4.1.2.)
namespace tessera::volume {

enum class LatticeKind4 : std::uint8_t { CC, D4 };

struct Lattice4 {
    LatticeKind4 kind = LatticeKind4::CC;
    glm::ivec4 size{1};    ///< samples of a frame along x, y, z, and frames
    glm::dvec4 spacing{1}; ///< cell edges of one of the grids: on D4* frames lie half a cell apart in time
    glm::dvec4 origin{0};  ///< position of sample (0, 0, 0) of frame 0
    AxisMaps axes = {};    ///< of space, from the sheet that `spacing` and `origin` are of

    bool operator==(const Lattice4&) const = default;

    std::size_t count() const {
        return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z) * std::size_t(size.w);
    }
    double time(int frame) const { return origin.w + spacing.w * frame * (kind == LatticeKind4::D4 ? 0.5 : 1.0); }
    /// The grid of one frame.
    Lattice grid(int frame) const;
    /// The BCC lattice that an even and an odd frame of D4* form at one time; of CC the grid.
    Lattice atOneTime() const;
    /// Frames of one parity (0 even, 1 odd) of D4*; of CC all are even.
    int framesOf(int parity) const;
};

/// The D4* lattice that takes the place of a CC one at 50 % of its samples, with T = sqrt 2: sizes floor(X / T),
/// floor(Y / T), floor(Z / T), at least 1, centred, and ceil(T (N - 1)) + 3 frames, the second one at the first time,
/// so that both the even and the odd ones begin at or before the first time and end at or after the last. (90 x 90 x 80
/// at 64 times: 63 x 63 x 56 at 93.)
Lattice4 d4For(const Lattice4& cc);

} // namespace tessera::volume
