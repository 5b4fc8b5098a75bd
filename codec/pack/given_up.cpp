#include "codec/pack/given_up.h"

#include "codec/archive/brick_access.h"
#include "volume/bricks/brick_importance.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace tessera::codec {

Thresholded giveUp(FrameSamples& samples, const volume::BrickGrid& grid, const FrameOptions& frame,
                   const ThresholdOptions& options, double extent) {
    std::vector<float> strength(grid.brickCount(), 1);
    if (options.byImportance) {
        const auto importance = importanceOfBricks(grid, samples, frame.range, frame.categorical, frame.importance);
        float most = 0;
        for (const volume::BrickImportance& brick : importance) most = std::max(most, brick.importance);
        for (std::size_t b = 0; b < strength.size() && most > 0; ++b) strength[b] = 1 - importance[b].importance / most;
    }
    const auto kind = static_cast<Threshold>(static_cast<int>(options.kind) - 1);
    const double value =
        kind == Threshold::Quantile ? options.value : options.value * extent / std::abs(samples.scale());
    return giveUpDetails(grid, samples, frame.wavelet.value_or(Wavelet::W22), kind, value, strength, frame.maxError);
}

void leaveOut(FrameSamples& samples, const volume::BrickGrid& grid, const std::vector<std::uint8_t>& discarded) {
    if (std::find(discarded.begin(), discarded.end(), std::uint8_t(1)) == discarded.end()) return;
    samples.change([&](volume::Field& part, Slab slab) {
        const volume::BrickGrid own = slab.grid(grid);
        const auto [first, end] = slab.bricks(grid);
        volume::Mask mask = part.mask ? *part.mask : volume::Mask(part.count(), 1);
        for (std::size_t b = first; b < end; ++b)
            if (discarded[b] != 0)
                forBrickRows(own, own.indexOf(b - first), [&](std::size_t from, std::size_t, std::size_t n) {
                    std::fill_n(mask.begin() + std::ptrdiff_t(from), n, std::uint8_t(0));
                });
        part.mask = std::make_shared<const volume::Mask>(std::move(mask));
    });
}

} // namespace tessera::codec
