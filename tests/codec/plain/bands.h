#pragma once

#include "tests/codec/plain/wavelet.h"

/// Coefficients in bands (FORMAT.md 4.5).
namespace tessera::codec::plain {

struct Band {
    Box* box = nullptr;
    Size lo{}, hi{};
    int kind = 0; ///< bits of the axes along which it is a high half
    std::vector<std::uint32_t> magnitudes{};
    int size(std::size_t axis) const { return hi[axis] - lo[axis]; }
    std::uint32_t magnitude(int x, int y, int z) const {
        if (x < 0 || y < 0 || z < 0 || x >= size(0) || y >= size(1) || z >= size(2)) return 0;
        return magnitudes[(std::size_t(z) * std::size_t(size(1)) + std::size_t(y)) * std::size_t(size(0)) +
                          std::size_t(x)];
    }
};

void decodeBands(const Octets& bytes, std::vector<Band>& bands, std::size_t level, const Decoder::Model& model);

} // namespace tessera::codec::plain
