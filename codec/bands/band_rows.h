#pragma once

#include "codec/bands/band.h"
#include "codec/bands/rans_model.h"
#include "codec/bytes/octaves.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <glm/common.hpp>
#include <vector>

/// Shared by the encoder and decoder of bands: contexts, and the order of rows.
namespace tessera::codec {

inline constexpr int kLanes = 16, kMostGroups = 4;
inline constexpr std::uint32_t kLowestState = 1u << 16;
inline constexpr std::uint32_t kLargestMagnitude = 4095; // twelve times this fits into 16 bits

/// Magnitudes of the two latest slices of a band, padded with zeros:
///
///     per slice: a row of zeros, size.y rows, a row of zeros; per row: kPad zeros, size.x rounded up to kPad
///
/// Rows are 64-byte aligned.
struct Magnitudes {
    static constexpr int kPad = 32;
    std::size_t pitch = 0, slice = 0, first = 0;
    std::vector<std::uint16_t> values;

    explicit Magnitudes(glm::ivec3 size)
        : pitch(std::size_t(kPad + (size.x + kPad - 1) / kPad * kPad)), slice(pitch * std::size_t(size.y + 2)),
          values(2 * slice + 3 * kPad) {
        const std::size_t beyond = reinterpret_cast<std::uintptr_t>(values.data()) % (2 * kPad);
        first = kPad + (2 * kPad - beyond) % (2 * kPad) / sizeof(std::uint16_t);
    }
    std::uint16_t* row(int z, int y) {
        return values.data() + first + std::size_t(z & 1) * slice + std::size_t(y + 1) * pitch;
    }
};

/// The rows that the contexts of a row depend on.
struct Neighbours {
    const std::uint16_t *north, *before, *beforeNorth, *beforeSouth;
    Neighbours(Magnitudes& magnitudes, int z, int y)
        : north(magnitudes.row(z, y - 1)), before(magnitudes.row(z - 1, y)), beforeNorth(magnitudes.row(z - 1, y - 1)),
          beforeSouth(magnitudes.row(z - 1, y + 1)) {}
    TESSERA_INLINE std::uint32_t sum(int x, bool byBand) const {
        const std::uint32_t near = std::uint32_t(north[x - 1]) + std::uint32_t(north[x + 1]) + 2u * north[x] +
                                   2u * before[x] + beforeNorth[x] + beforeSouth[x];
        return byBand ? near + north[x] + before[x] + before[x - 1] + before[x + 1] : near;
    }
};

TESSERA_INLINE std::uint16_t magnitudeOf(std::int32_t value, int shift) {
    const std::uint32_t sign = static_cast<std::uint32_t>(value >> 31);
    const std::uint32_t size = ((static_cast<std::uint32_t>(value) ^ sign) - sign) >> shift;
    return static_cast<std::uint16_t>(size < kLargestMagnitude ? size : kLargestMagnitude);
}

/// Number of chunks of the bands, the widest row, and the resulting number of groups of coder states.
struct Lanes {
    std::size_t chunks = 0;
    int groups = 1, used = 0; ///< used: number of stored states

    template <class AnyBand> explicit Lanes(std::span<const AnyBand> bands) {
        int widest = 0;
        for (const AnyBand& band : bands) {
            if (band.size.x < 1 || band.size.y < 1 || band.size.z < 1) continue;
            chunks +=
                std::size_t((band.size.x + kLanes - 1) / kLanes) * std::size_t(band.size.y) * std::size_t(band.size.z);
            widest = std::max(widest, band.size.x);
        }
        groups = chunks >= 8192 ? 4 : chunks >= 1024 ? 2 : 1;
        used = groups > 1 ? groups * kLanes : std::min(kLanes, widest);
    }
};

/// Calls `visit(band index, z, y)` for every row in coding order, alternating between the bands of the same turn. Bands
/// are sorted by their turns.
template <class AnyBand, class Visit> TESSERA_INLINE bool forBandRows(std::span<const AnyBand> bands, Visit&& visit) {
    for (std::size_t begin = 0, end = 0; begin < bands.size(); begin = end) {
        glm::ivec3 most(0);
        for (end = begin; end < bands.size() && bands[end].turn == bands[begin].turn; ++end)
            if (bands[end].size.x > 0) most = glm::max(most, bands[end].size);
        for (int z = 0; z < most.z; ++z)
            for (int y = 0; y < most.y; ++y)
                for (std::size_t b = begin; b < end; ++b)
                    if (bands[b].size.x > 0 && y < bands[b].size.y && z < bands[b].size.z)
                        if (!visit(b, z, y)) return false;
    }
    return true;
}

/// Buffers for a set of bands. Slices are overwritten completely before they are read again, so only the initial
/// content, zeros, is visible in the first two slices.
inline std::vector<Magnitudes> magnitudesFor(auto bands) {
    std::vector<Magnitudes> all;
    all.reserve(bands.size());
    for (const auto& band : bands) all.emplace_back(glm::max(band.size, glm::ivec3(0)));
    return all;
}

} // namespace tessera::codec
