#pragma once

#include "codec/brick/brick_codec.h"

namespace tessera::codec {

/// decodeBrick for bricks of version 1 archives.
DecodeStatus decodeBrickV1(const BrickFormat& format, std::span<const std::span<const std::byte>> segments, int level,
                           std::span<const std::uint8_t> present, DecodedBrick& out);

} // namespace tessera::codec
