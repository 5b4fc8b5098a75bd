#pragma once

#include "tests/codec/plain/wavelet.h"

#include <functional>

/// Coefficients in bands (FORMAT.md 4.5).
namespace tessera::codec::plain {

struct Band {
    Box* box = nullptr;
    Size lo{}, hi{};
    int kind = 0; ///< bits of the axes along which it is a high half
    Size step{1, 1, 1};
    std::vector<std::uint32_t> magnitudes{};
    int size(std::size_t axis) const { return (hi[axis] - lo[axis] + step[axis] - 1) / step[axis]; }
    std::uint32_t magnitude(int x, int y, int z) const {
        if (x < 0 || y < 0 || z < 0 || x >= size(0) || y >= size(1) || z >= size(2)) return 0;
        return magnitudes[(std::size_t(z) * std::size_t(size(1)) + std::size_t(y)) * std::size_t(size(0)) +
                          std::size_t(x)];
    }
};

/// The class of a sum.
std::uint32_t classOf(std::uint32_t sum);

/// 4.11: what is known of a sample before it is decoded.
struct Foreseen {
    std::int64_t value = 0;
    std::uint32_t activity = 0;
};
/// Of the sample of a band at a place of its box.
using Foresee = std::function<Foreseen(std::size_t band, const Size& place)>;

/// With `foresee` bands are decoded one after another, as differences from what is foreseen.
void decodeBands(const Octets& bytes, std::vector<Band>& bands, std::size_t level, const Decoder::Model& model,
                 const Foresee& foresee = {});

} // namespace tessera::codec::plain
