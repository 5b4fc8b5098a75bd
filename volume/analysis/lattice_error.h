#pragma once

#include "volume/field/lattice4.h"
#include "volume/reconstruct/gradient.h"

#include <cstddef>
#include <functional>
#include <string_view>

namespace tessera::volume {

/// Filters of volume/reconstruct/reconstruct.h: `linear` on unfiltered samples, and on prefiltered ones (quasi); for
/// BCC also `tetrahedral`, `cosineWeighted`, and `quinticBox` on prefiltered samples; `cubic` on coefficients.
/// Resampled, Corrected: quasi, of samples that come from those of the CC grid with a cell shorter by sqrt 2, as
/// toBcc() resamples them (volume/resample/resample.h), and as pictures are made of them (toCentred(),
/// volume/sources/centred_field.h).
enum class LatticeFilter { Linear, Quasi, Tetrahedral, Cosine, Quintic, Cubic, Resampled, Corrected };
inline constexpr std::string_view kLatticeFilterNames[] = {"linear",  "quasi", "tetrahedral", "cosine",
                                                           "quintic", "cubic", "resampled",   "corrected"};

struct LatticeError {
    double rms = 0, max = 0;
    double samples = 0; ///< of the lattice per box: its volume over the volume per sample
};

/// Reconstruction error of a lattice with a filter: the signal is sampled without rounding, reconstructed at `points`
/// random positions of the box (uniform, from `seed`) and compared with itself. The lattice starts at `box.lo` and
/// continues beyond the box, so borders have no influence. `spacing` is the cell edge (of one sublattice on BCC).
LatticeError latticeError(const std::function<double(glm::dvec3)>& signal, LatticeKind kind, double spacing,
                          LatticeFilter filter, const Box& box, std::size_t points = 60000, unsigned seed = 1);

/// The same for a signal of two regions, one value of which is never mixed with the other's: signal(p, region), region
/// 1 where border(p), the distance to the border, is above 0, else 0. Over points up to `reach` from the border where
/// samples of the point's own region have at least half of the weight, as pictures show it. LatticeError::samples is
/// the number of these points.
LatticeError latticeErrorOfRegions(const std::function<double(glm::dvec3, int)>& signal,
                                   const std::function<double(glm::dvec3)>& border, LatticeKind kind, double spacing,
                                   LatticeFilter filter, const Box& box, double reach, std::size_t points = 60000,
                                   unsigned seed = 1);

/// Mean angle, in degrees, between reconstructed gradients and `slope`, the gradient of the signal, over the same
/// points, each weighted by the length of its slope.
double latticeGradientError(const std::function<double(glm::dvec3)>& signal,
                            const std::function<glm::dvec3(glm::dvec3)>& slope, LatticeKind kind, double spacing,
                            LatticeFilter filter, GradientSpan span, const Box& box, std::size_t points = 20000,
                            unsigned seed = 1);

/// Filters in space and time (volume/resample/series.h): linear between frames and samples, on D4* as the mean of both
/// grids; the same of samples that are prefiltered in space and time; and as views draw an archive: cubic between
/// frames, then prefiltered in space.
enum class LatticeFilter4 { Linear, Quasi, Drawn };

/// The error of latticeError() in space and time, for a signal on the unit cube of space and time. `spacing` is the
/// cell edge of one grid along all four axes. Points lie a quarter inside the cube.
LatticeError latticeError4(const std::function<double(glm::dvec4)>& signal, LatticeKind4 kind, double spacing,
                           LatticeFilter4 filter, std::size_t points = 60000, unsigned seed = 1);

} // namespace tessera::volume
