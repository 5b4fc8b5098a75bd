#pragma once

#include "tests/codec/plain/wavelet.h"

/// Mixed bricks (FORMAT.md 4.12).
namespace tessera::codec::plain {

/// Reads the palette indices, below `colours`, of a brick of `size` samples in storage order.
std::vector<std::uint32_t> readMixed(const Octets& bytes, const Size& size, bool bcc, int colours);

} // namespace tessera::codec::plain
