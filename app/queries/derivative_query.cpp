#include "app/queries/derivative_query.h"

#include "volume/bricks/source_at_time.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

/// sRGB byte of a grey of lightness L* (CIE 1976), 0..100.
std::uint8_t greyOf(double lightness) {
    const double f = (lightness + 16) / 116, y = f > 6.0 / 29 ? f * f * f : lightness / 903.3;
    const double s = y <= 0.0031308 ? 12.92 * y : 1.055 * std::pow(y, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(s, 0.0, 1.0)));
}

} // namespace

DerivativeResult readDerivatives(const std::shared_ptr<const volume::BrickSource>& source,
                                 const DerivativesAtTime& query, const Progress& progress) {
    const volume::SourceAtTime shown = volume::sourceAt(source, query.time);
    volume::DerivativeQuery asked = query.query;
    asked.time = shown.time;
    DerivativeResult result;
    result.histogram = volume::derivativeHistogram(*shown.source, asked, progress);
    result.curves = volume::boundaryCurves(result.histogram);
    return result;
}

std::vector<std::uint8_t> derivativeImage(const volume::DerivativeHistogram& histogram, bool dark) {
    const auto width = static_cast<std::size_t>(histogram.valueBins);
    const auto height = static_cast<std::size_t>(histogram.gradientBins);
    std::uint64_t most = 1;
    for (std::uint64_t count : histogram.count) most = std::max(most, count);
    std::vector<std::uint8_t> rgba(width * height * 4);
    for (std::size_t row = 0; row < height; ++row)
        for (std::size_t v = 0; v < width; ++v) {
            const std::uint64_t count = histogram.count[(height - 1 - row) * width + v];
            if (count == 0) continue;
            const double share = std::log1p(double(count)) / std::log1p(double(most));
            const std::uint8_t grey = greyOf(dark ? 28 + 60 * share : 80 - 65 * share);
            std::uint8_t* pixel = &rgba[(row * width + v) * 4];
            pixel[0] = pixel[1] = pixel[2] = grey;
            pixel[3] = 255;
        }
    return rgba;
}

} // namespace tessera::app
