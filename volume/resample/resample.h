#pragma once

#include "volume/base/describe.h"
#include "volume/base/progress.h"
#include "volume/field/field.h"

#include <cstdint>

namespace tessera::volume {

/// Kernels between samples of a CC grid. Cubic: Catmull-Rom. BSpline3, BSpline5: interpolating splines of degree 3 and
/// 5, the samples prefiltered (volume/resample/spline_prefilter.h). Lagrange: the polynomial through `order` + 1
/// samples around. Sinc: Lanczos-windowed over `order` samples on either side, weights normalised.
enum class ResampleFilter : std::uint8_t { Nearest, Linear, Cubic, BSpline3, BSpline5, Lagrange, Sinc };
inline constexpr std::string_view kResampleFilterNames[] = {"nearest",  "linear",   "cubic", "bspline3",
                                                            "bspline5", "lagrange", "sinc"};

/// When edges are enhanced: the source, or the result.
enum class SharpenWhen : std::uint8_t { Before, After };
inline constexpr std::string_view kSharpenWhenNames[] = {"before", "after"};

/// Bounds of ResampleOptions::order.
inline constexpr int kLeastOrder = 1, kMostOrder = 8;

struct ResampleOptions {
    ResampleFilter filter = ResampleFilter::Cubic;
    int order = 5;
    double sharpen = 0;
    SharpenWhen sharpenWhen = SharpenWhen::Before;

    bool operator==(const ResampleOptions&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.filter, FieldInfo{.key = "filter",
                                     .unit = "",
                                     .doc = "Kernel between the samples of a regular grid; labels take the nearest",
                                     .names = kResampleFilterNames});
        visit(self.order, FieldInfo{.key = "order",
                                    .unit = "",
                                    .doc = "Of lagrange: degree of the polynomial; of sinc: samples on either side",
                                    .range = Range{kLeastOrder, kMostOrder}});
        visit(self.sharpen, FieldInfo{.key = "sharpen",
                                      .unit = "",
                                      .doc = "Edge enhancement: share of the difference to the mean of the nearest "
                                             "neighbours that is added; 0 = none",
                                      .range = Range{0, 4}});
        visit(self.sharpenWhen, FieldInfo{.key = "sharpenWhen",
                                          .unit = "",
                                          .doc = "Enhance edges of the source or of the result",
                                          .names = kSharpenWhenNames});
    }
};

/// Samples a field on another lattice. CC sources use the kernels above; BCC sources nearest or the prefiltered average
/// (all other filters; volume/reconstruct/reconstruct.h). Positions outside the box of the source samples take the
/// value of its nearest face; inside, kernels continue the data beyond a face by point reflection (sample -i is 2 *
/// sample 0 - sample i), so that all but nearest and sinc reproduce linear functions up to the last sample; Lagrange
/// moves its samples inside and reproduces its degree everywhere.
///
/// Absent samples take no part, nor do those of other parts where the mask says parts (volume/field/part_masks.h): a
/// target sample is absent where the nearest source sample is, else of the part of that one, and where the kernel meets
/// any others Catmull-Rom's takes its place (of the linear one itself), with the part continued beyond its border from
/// its own samples (volume/reconstruct/continued.h). B-splines treat every run of samples of one part along an axis as
/// a signal of its own. From CC to BCC a gap of one absent sample along an axis stays a gap: where a sublattice would
/// step over it, its sample nearer to the gap is absent too.
///
/// Results stay within the range of the source's present samples of their part, integer types round; a same-lattice
/// target without edge enhancement is the identity. Deterministic on any number of threads. Throws Cancelled.
Field resample(const Field& source, const Lattice& target, const ResampleOptions& options,
               const Progress& progress = {});
inline Field resample(const Field& source, const Lattice& target, ResampleFilter filter,
                      const Progress& progress = {}) {
    return resample(source, target, ResampleOptions{.filter = filter}, progress);
}

/// Edge enhancement: adds `amount` times the difference of every present sample to the mean of its nearest neighbours
/// (6 on CC, 8 on BCC), within the range of its part. Where one of two opposite neighbours is absent or of another
/// part, both count as the sample itself.
Field sharpened(const Field& source, double amount);

/// How samples of a parameter are resampled: labels to the nearest.
inline ResampleOptions optionsFor(bool categorical, const ResampleOptions& options) {
    return categorical ? ResampleOptions{.filter = ResampleFilter::Nearest} : options;
}

/// The field on bccFor(its lattice); nearest for categorical parameters.
Field toBcc(const Field& source, bool categorical, const ResampleOptions& options, const Progress& progress = {});
inline Field toBcc(const Field& source, bool categorical, const Progress& progress = {}) {
    return toBcc(source, categorical, ResampleOptions{}, progress);
}

} // namespace tessera::volume
