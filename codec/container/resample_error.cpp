#include "codec/container/resample_error.h"

#include "volume/resample/resample.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::codec {

namespace {

using volume::Field;
using volume::Lattice;

constexpr std::size_t kWhole = std::size_t(1) << 18; // frames up to this size are examined completely
constexpr int kBlocks = 32, kBlock = 8;              // number of blocks of larger frames, and slices per block
constexpr int kMargin = 4;                           // cells around a block that filters may read

ResampleError compare(const Field& source, const Field& back, bool categorical) {
    ResampleError error;
    double squares = 0;
    for (std::size_t i = 0; i < source.count(); ++i) {
        if (!source.present(i) || !back.present(i)) continue;
        const double apart = source.value(i) - back.value(i);
        if (!std::isfinite(apart)) continue;
        const double counted = categorical ? (apart != 0 ? 1 : 0) : std::abs(apart);
        squares += counted * counted;
        error.largest = std::max(error.largest, counted);
        error.samples += 1;
    }
    error.meanSquare = error.samples > 0 ? squares / error.samples : 0;
    return error;
}

Field backOn(const Lattice& lattice, const Field& stored, bool categorical) {
    const auto filter = categorical ? volume::ResampleFilter::Nearest : volume::ResampleFilter::Cubic;
    return volume::resample(stored, lattice, filter);
}

} // namespace

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

double psnrOf(const ResampleError& error, double extent) {
    return error.meanSquare > 0 ? 10 * std::log10(extent * extent / error.meanSquare)
                                : std::numeric_limits<double>::infinity();
}

ResampleError resampleError(const Field& source, const Field& stored, bool categorical) {
    const auto sliced = [](const Field& field) {
        return [&field](int first, int count) { return volume::slicesOf(field, first, count); };
    };
    return resampleError(source.lattice, sliced(source), stored.lattice, sliced(stored), categorical);
}

ResampleError resampleError(const Lattice& source, const volume::SliceReader& readSource, const Lattice& stored,
                            const volume::SliceReader& readStored, bool categorical) {
    const auto compared = [categorical](const Field& part, const Field& around) {
        return compare(part, backOn(part.lattice, around, categorical), categorical);
    };
    if (source.count() <= kWhole && source.size.z <= kBlocks)
        return compared(readSource(0, source.size.z), readStored(0, stored.size.z));
    const int slices = source.size.z, blocks = std::min(kBlocks, (slices + kBlock - 1) / kBlock);
    ResampleError error;
    int looked = 0;
    for (int b = 0, next = 0; b < blocks; ++b) {
        const int first = std::max(next, int(std::int64_t(slices - kBlock) * b / std::max(blocks - 1, 1)));
        const int count = std::min(kBlock, slices - first);
        if (count <= 0) break;
        const Field part = readSource(first, count);
        // Slices of BCC are half a cell apart; a part of it must begin with an even slice.
        const auto sliceAt = [&](int z) {
            const double position = source.origin.z + source.spacing.z * z;
            return 2 * int(std::floor((position - stored.origin.z) / stored.spacing.z));
        };
        const int begin = std::clamp(sliceAt(first) - 2 * kMargin, 0, (stored.size.z - 1) / 2 * 2);
        const int end = std::clamp(sliceAt(first + count - 1) + 2 * kMargin + 2, begin + 1, stored.size.z);
        const Field around = readStored(begin, end - begin);
        error.add(compared(part, around));
        looked += count;
        next = first + count;
    }
    error.share = double(looked) / double(slices);
    return error;
}

} // namespace tessera::codec
