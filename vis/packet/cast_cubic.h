#pragma once

#include "vis/lanes/lanes.h"

/// Cubic B-splines from linear reads (vis/shaders/lib/sampling/cubic.glsl). Only for cast_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

/// Two linear reads along an axis give the four samples of a cubic B-spline.
struct CubicReads {
    Ints low, high; ///< their places in cells, times 2^16
    Floats share;   ///< of the second
};
/// At a place in cells, times 2^16, of a volume of so many; places beyond it are moved to its end.
inline CubicReads cubicReads(Ints at, int cells) {
    const Floats third(1.0 / 3), sixth(1.0 / 6), one(1), unit(1 << 16);
    const Floats f = toFloats(at & Ints(0xffff)) * Floats(1.0 / (1 << 16)), g = one - f;
    const Floats first = g * g * g * sixth, last = f * f * f * sixth;
    const Floats second = third + third - f * f * (one - Floats(0.5) * f), share = one - (first + second);
    const Ints whole = (at >> 16) << 16, none(0), end((cells << 16) - 1);
    const auto placed = [&](Floats offset) {
        const Ints place = whole + toInts(offset * unit), most = choose(place < end, place, end);
        return choose(none < most, most, none);
    };
    return {placed(second / (first + second) - one), placed(last / share + one), share};
}

} // namespace tessera::vis::packet::TESSERA_LANES
