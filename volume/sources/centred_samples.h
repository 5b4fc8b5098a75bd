#pragma once

#include "volume/field/lattice.h"
#include "volume/resample/resample_taps.h"
#include "volume/sources/sampled_box.h"

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

/// Samples that pictures are made of: those of a regular grid on the body-centred lattice, corrected once by what the
/// pictures' own filter leaves of the grid's samples.
///
///     c  = K s                  s: samples of the grid, K: Catmull-Rom, as in volume/resample/resample.h
///     c += K (s - R c)          R: the average of both sublattices' trilinear interpolations of prefiltered samples
///
/// The first step of the Landweber iteration for R c = s, with K in place of the transpose of R. R is the filter of
/// volume/reconstruct/reconstruct.h, of the samples of one part alone, as pictures read them. At absent samples, at
/// those of other parts and where R has less than half of its weight (kPresentCoverage) the residual is 0. Labels and
/// coarser levels are not corrected. Samples that are not finite count as absent.
///
/// Values are physical. Each is held within the range of its part's samples that K reads, widened by kCentredHeadroom
/// of its width to either side: so nothing of the grid but what lies near decides on a sample, and bricks give what the
/// whole grid gives.
namespace tessera::volume {

/// How far beyond the samples around it a corrected sample may lie, as a share of their range.
inline constexpr double kCentredHeadroom = 0.25;

/// How much further apart two corrected samples of whole parts can be than the samples they are made of.
inline constexpr double kCentredGain = 4;

/// Samples along an axis: sample i lies at first + i * step, in cells of the grid.
struct LevelAxis {
    double first = 0, step = 1;
    int count = 1;
};

/// A level of a regular grid, and one of the body-centred lattice that takes its place.
struct CentredLevel {
    std::array<LevelAxis, 3> grid;
    std::array<std::array<LevelAxis, 3>, 2> sublattices; ///< even, odd
    bool finest = true;                                  ///< at full resolution: corrected, and gaps are kept
};

/// The level of full resolution of a regular grid and of bccFor() of it.
CentredLevel finestCentred(const Lattice& grid);

/// The level of the lattice, box by box. Const functions may be called from any thread.
class CentredGrid {
public:
    CentredGrid(const CentredLevel& level, bool categorical);
    /// The samples of the grid that decide on presence, part and range of the samples in a box of texels.
    IndexBox near(const IndexBox& texels) const;
    /// All that they are made of. `mixed`: some of them may be absent, or of several parts.
    IndexBox needed(const IndexBox& texels, bool mixed) const;
    /// Both sublattices in a box of texels, from the samples of `needed` or more. Beyond the lattice the nearest sample
    /// of the sublattice is repeated.
    std::array<SampledBox, 2> make(SampledBox grid, const IndexBox& texels) const;

private:
    using Taps = std::array<std::vector<Tap>, 3>; ///< of every sample along each axis

    const Tap& tapOf(int sublattice, int axis, int texel) const;
    IndexBox texelsAround(const IndexBox& grid) const;
    bool inGap(int sublattice, glm::ivec3 at, const SampledBox& grid) const;
    SampledBox labels(int sublattice, const SampledBox& grid, const IndexBox& texels) const;
    SampledBox resampled(int sublattice, const SampledBox& grid, const IndexBox& texels) const;
    std::optional<double> ofPart(const std::array<SampledBox, 2>& filtered, glm::ivec3 at, std::uint8_t number) const;
    SampledBox residual(const SampledBox& grid, const std::array<SampledBox, 2>& centred, const IndexBox& of) const;
    SampledBox corrected(int sublattice, const SampledBox& grid, const SampledBox& residual, const SampledBox& centred,
                         const IndexBox& texels) const;

    CentredLevel level_;
    bool categorical_;
    std::array<Taps, 2> kernel_;  ///< K, of each sublattice
    std::array<Taps, 2> between_; ///< R: the two texels of each sublattice around samples of the grid
};

} // namespace tessera::volume
