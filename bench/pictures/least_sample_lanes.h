#pragma once

#include "vis/packet/cast_read.h"

/// Reading and interpolating, and nothing else. Only for least_sample_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

template <bool Bcc> float readBrick(const VolumeView& volume, int rounds, long& taken) {
    constexpr int kAhead = 4; // as SingleCaster
    constexpr int kSteps = 12;
    static_assert(kMargin + kSteps < kBrick);
    const Reader<Bcc, false> read{volume, false};
    float x[kLanes], y[kLanes];
    for (int i = 0; i < kLanes; ++i) {
        const int column = i % kColumns, row = i / kColumns;
        x[i] = float(kMargin + 1 + column) + 0.3f;
        y[i] = float(kMargin + 1 + row) + 0.6f;
    }
    const Fixed first = fixedOf({Floats::load(x), Floats::load(y), Floats(kMargin + 0.2f)});
    const Fixed way = fixedOf({Floats(0.31f), Floats(0.22f), Floats(0.93f)});
    const Mask all = maskOf(kLanes == 32 ? ~0u : (1u << kLanes) - 1);
    Mask lanes[kAhead];
    for (Mask& each : lanes) each = all;
    Floats sum(0);
    for (int round = 0; round < rounds; ++round) {
        Fixed at = first;
        for (int n = 0; n < kSteps; n += kAhead) {
            Found found[kAhead];
            read.template row<kAhead>(at, way, lanes, found);
            for (const Found& each : found) sum += each.value;
        }
    }
    taken += long(rounds) * kSteps * kLanes;
    float out[kLanes], total = 0;
    sum.store(out);
    for (const float each : out) total += each;
    return total;
}

inline float readFirstBrick(const VolumeView& volume, int rounds, long& taken) {
    return volume.bcc ? readBrick<true>(volume, rounds, taken) : readBrick<false>(volume, rounds, taken);
}

} // namespace tessera::vis::packet::TESSERA_LANES
