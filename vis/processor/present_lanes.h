#pragma once

#include "vis/lanes/lanes.h"
#include "vis/processor/present_rows.h"

/// Pixels in the lanes. Only for present_rows_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

inline void presentPixels(const PresentedWith& with, const PixelRow& row) {
    for (int first = 0; first < row.count; first += kLanes) {
        const int count = row.count - first < kLanes ? row.count - first : kLanes;
        float parts[4][kLanes] = {}, lines[2][kLanes] = {};
        for (int i = 0; i < count; ++i)
            for (int part = 0; part < 4; ++part) parts[part][i] = row.rgba[4 * (first + i) + part];
        __builtin_memcpy(lines[0], row.behind + first, std::size_t(count) * sizeof(float));
        __builtin_memcpy(lines[1], row.before + first, std::size_t(count) * sizeof(float));
        const glm::vec<4, Floats> shown =
            presentedPixel<Floats>(with, {Floats::load(parts[0]), Floats::load(parts[1]), Floats::load(parts[2])},
                                   Floats::load(parts[3]), Floats::load(lines[0]), Floats::load(lines[1]), Floats(1));
        const auto encoded = [](Floats linear) { return toInts(screenLevel(linear)); };
        const Ints pixels =
            encoded(shown.x) | (encoded(shown.y) << 8) | (encoded(shown.z) << 16) | (toInts(levelOf(shown.w)) << 24);
        __builtin_memcpy(row.out + std::size_t(4) * std::size_t(first), &pixels.v, std::size_t(count) * 4);
    }
}

} // namespace tessera::vis::packet::TESSERA_LANES
