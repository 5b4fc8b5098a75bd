#include "codec/wavelet/threshold.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tessera::codec {

namespace {

std::int64_t magnitude(std::int32_t detail) {
    return detail < 0 ? -std::int64_t(detail) : detail;
}

void dropQuantile(std::span<std::int32_t> details, double part) {
    const auto drop = static_cast<std::size_t>(std::floor(std::clamp(part, 0.0, 1.0) * double(details.size())));
    if (drop == 0) return;
    std::vector<std::int64_t> sizes;
    for (const std::int32_t detail : details) sizes.push_back(magnitude(detail));
    const auto last = sizes.begin() + std::ptrdiff_t(drop - 1);
    std::nth_element(sizes.begin(), last, sizes.end());
    const std::int64_t limit = *last;
    auto left = drop - std::size_t(std::count_if(details.begin(), details.end(),
                                                 [&](std::int32_t detail) { return magnitude(detail) < limit; }));
    for (std::int32_t& detail : details) {
        if (magnitude(detail) < limit) {
            detail = 0;
        } else if (magnitude(detail) == limit && left > 0) {
            detail = 0;
            --left;
        }
    }
}

} // namespace

void applyThreshold(std::span<std::int32_t> details, Threshold kind, double value) {
    if (kind == Threshold::Quantile) return dropQuantile(details, value);
    for (std::int32_t& detail : details) {
        const auto size = double(magnitude(detail));
        if (size <= value)
            detail = 0;
        else if (kind == Threshold::Soft)
            detail = static_cast<std::int32_t>(std::lround(std::copysign(size - value, detail)));
    }
}

} // namespace tessera::codec
