#pragma once

#include "volume/base/describe.h"

#include <cstdint>
#include <string_view>

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
                                     .doc = "Filter for resampling a regular grid; labels take the nearest sample",
                                     .names = kResampleFilterNames});
        visit(self.order,
              FieldInfo{.key = "order",
                        .doc = "For lagrange: degree of the polynomial; for sinc: number of samples on either side",
                        .range = Range{kLeastOrder, kMostOrder}});
        visit(
            self.sharpen,
            FieldInfo{
                .key = "sharpen",
                .doc =
                    "Sharpening: share of the difference to the mean of the nearest neighbours that is added; 0 = none",
                .range = Range{0, 4}});
        visit(self.sharpenWhen,
              FieldInfo{.key = "sharpenWhen", .doc = "Sharpen the source or the result", .names = kSharpenWhenNames});
    }
};

/// How samples of a parameter are resampled: labels to the nearest.
inline ResampleOptions optionsFor(bool categorical, const ResampleOptions& options) {
    return categorical ? ResampleOptions{.filter = ResampleFilter::Nearest} : options;
}

/// Throws Error for an order no filter has.
void checkOrder(const ResampleOptions& options);

} // namespace tessera::volume
