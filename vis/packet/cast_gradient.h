#pragma once

#include "vis/packet/cast_read.h"

/// Gradients from shared reads. Only for cast_*.cpp.
///
/// The ends of all differences (volume/reconstruct/gradient.h, GradientSpan::Neighbours) lie within three samples along
/// each axis, and interpolation is separable. So the gradient is a sum over 3 x 3 x 3 samples of a sublattice: along x
///   sum d(x) b(y) b(z) f,
/// d the difference between the weights of the upper and the lower end, b the weights of the middle on CC, of both ends
/// on BCC, where a diagonal has one end in each octant. Six reads of a row give these samples, where six (CC) or
/// sixteen (BCC) interpolations would take twelve or thirty-two (opaque layers in 0.9 and 0.8 of the time).
namespace tessera::vis::packet::TESSERA_LANES {

/// Weights of three samples along an axis, the first of which is `first`.
struct Taps {
    Ints first;
    Floats mean[3], difference[3];
};
/// Of a position in cells; `reach` of the differences, at most 1/2.
template <bool Bcc> [[gnu::always_inline]] inline Taps tapsAt(Floats at, double reach) {
    const Floats from = at - Floats(reach), whole = roundDown(from), u = from - whole, none(0);
    const Floats lower0 = Floats(1) - u, upper0 = larger(none, Floats(1 - 2 * reach) - u),
                 upper2 = larger(none, u + Floats(2 * reach - 1));
    Taps taps;
    taps.first = toInts(whole);
    taps.difference[0] = upper0 - lower0;
    taps.difference[2] = upper2;
    taps.difference[1] = -(taps.difference[0] + upper2); // their sum is 0 however they are rounded
    taps.mean[0] = Bcc ? (upper0 + lower0) * Floats(0.5) : larger(none, Floats(0.5) - u);
    taps.mean[2] = Bcc ? upper2 * Floats(0.5) : larger(none, u - Floats(0.5));
    taps.mean[1] = Floats(1) - (taps.mean[0] + taps.mean[2]);
    return taps;
}

/// Three weights as 15-bit numbers for two pairs of samples that share the middle one.
struct PairTaps {
    Ints low, high;
};
/// They sum to `sum` exactly.
inline PairTaps pairTaps(const Floats* weights, int sum) {
    const auto rounded = [](Floats weight) {
        return toInts(roundDown(multiplyAdd(weight, Floats(kQuantum), Floats(0.5))));
    };
    const Ints first = rounded(weights[0]), last = rounded(weights[2]), middle = Ints(sum) - first - last;
    return {(first & Ints(0xffff)) | middle << 16, last << 16};
}

/// Adds the gradient of one sublattice, per cell and axis, times kQuantum. All samples must be present.
template <bool Bcc>
[[gnu::always_inline]] inline void addGradient(const VolumeView& volume, const Vec& cells, int offset, double reach,
                                               Mask lanes, Vec& sum) {
    const Taps x = tapsAt<Bcc>(cells.x, reach), y = tapsAt<Bcc>(cells.y, reach), z = tapsAt<Bcc>(cells.z, reach);
    const PairTaps mean = pairTaps(y.mean, kQuantum), difference = pairTaps(y.difference, 0);
    const Spread<false> place = spread(pairAt(volume, {x.first << 16, y.first << 16, z.first << 16}), lanes);
    for (int slice = 0; slice < 3; ++slice) {
        const std::int16_t* const from = volume.shorts + 2 * (offset + slice * kSlice);
        const IntQuad low = loadQuads<4>(from, place, lanes), high = loadQuads<4>(from + 2 * kRow, place, lanes);
        Floats meanXy(0), alongX(0), alongY(0);
        for (int column = 0; column < 3; ++column) {
            const auto along = [&](const PairTaps& taps) {
                return toFloats(dotPairs(low.each[column], taps.low) + dotPairs(high.each[column], taps.high));
            };
            const Floats own = along(mean);
            meanXy = multiplyAdd(x.mean[column], own, meanXy);
            alongX = multiplyAdd(x.difference[column], own, alongX);
            alongY = multiplyAdd(x.mean[column], along(difference), alongY);
        }
        sum.x = multiplyAdd(z.mean[slice], alongX, sum.x);
        sum.y = multiplyAdd(z.mean[slice], alongY, sum.y);
        sum.z = multiplyAdd(z.difference[slice], meanXy, sum.z);
    }
}

/// Whether sharedGradient() is that of a stencil.
inline bool sharesReads(const volume::GradientStencil& stencil, bool bcc) {
    return stencil.diagonal == bcc && stencil.reach <= 0.5;
}
/// The gradient of a volume of 15-bit samples, per cell and axis, as volume::gradientOf() has it.
template <bool Bcc>
[[gnu::noinline]] Vec sharedGradient(const VolumeView& volume, const Vec& cells, double reach, Mask lanes) {
    Vec sum(Floats(0), Floats(0), Floats(0));
    addGradient<Bcc>(volume, cells, 0, reach, lanes, sum);
    if constexpr (Bcc) addGradient<Bcc>(volume, cells - Floats(0.5), volume.oddOffset, reach, lanes, sum);
    return sum * Floats(1.0 / kQuantum);
}

} // namespace tessera::vis::packet::TESSERA_LANES
