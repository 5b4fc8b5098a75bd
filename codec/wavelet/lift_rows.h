#pragma once

#include "codec/wavelet/filter.h"
#include "volume/base/cpu.h"

#include <cstddef>
#include <cstdint>
#include <vector>

/// A lifting step of many parallel lines at once, of which samples may be absent.
namespace tessera::codec {

/// Parallel lines: `rows` samples along the line, `lanes` lines, row by row.
struct Rows {
    std::uint32_t* values;
    std::uint8_t* present; ///< null: all present
    int rows, lanes;

    std::uint32_t at(int row, int lane) const { return values[std::ptrdiff_t(row) * lanes + lane]; }
    bool has(int row, int lane) const {
        return row >= 0 && row < rows && (!present || present[std::ptrdiff_t(row) * lanes + lane] != 0);
    }
};

/// Whether applyPairs computes a step: sums of symmetric pairs.
constexpr bool isOfPairs(const LiftStep& step) {
    return step.centre == 0 && step.pairs > 0 && !step.antisymmetric;
}

/// target[i] += sign * the sum of a step, where sign is 1 or 2^32 - 1, by the rules for absent samples
/// (codec/wavelet/lifting.h). `wide`: sums in 64 bits. The result does not depend on `cpu`; `usable` is working memory.
void applyPairs(const LiftStep& step, bool update, const Rows& target, const Rows& source, std::uint32_t sign,
                bool wide, std::vector<std::uint8_t>& usable, Cpu cpu);

} // namespace tessera::codec
