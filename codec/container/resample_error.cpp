#include "codec/container/resample_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::codec {

void ResampleError::add(const ResampleError& more) {
    const double all = samples + more.samples;
    if (all > 0) {
        share = (share * samples + more.share * more.samples) / all;
        meanSquare = (meanSquare * samples + more.meanSquare * more.samples) / all;
    }
    largest = std::max(largest, more.largest);
    samples = all;
}

ResampleError joined(const std::optional<ResampleError>& before, const ResampleError& then) {
    if (!before) return then;
    const double rms = std::sqrt(before->meanSquare) + std::sqrt(then.meanSquare);
    return {rms * rms, before->largest + then.largest, then.samples, std::min(before->share, then.share)};
}

ResampleError joined(double bound, const ResampleError& then) {
    return bound > 0 ? joined(ResampleError{bound * bound, bound, then.samples, 1}, then) : then;
}

double psnrOf(const ResampleError& error, double extent) {
    return error.meanSquare > 0 ? 10 * std::log10(extent * extent / error.meanSquare)
                                : std::numeric_limits<double>::infinity();
}

} // namespace tessera::codec
