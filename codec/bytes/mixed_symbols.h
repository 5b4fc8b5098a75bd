#pragma once

#include "codec/bytes/bytes.h"
#include "codec/bytes/decode_status.h"

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

/// Coding of a brick sample by sample: several contexts and an earlier part of the brick that agrees so far each
/// foresee every bit, and what they say is mixed with weights that are learnt. Small, but slow in both directions.
/// (FORMAT.md "Mixed bricks".)
namespace tessera::codec {

/// Larger bricks are never mixed, since decoding would be slow. Part of the format.
inline constexpr std::size_t kMostMixed = std::size_t(1) << 19;

struct MixedShape {
    glm::ivec3 size{1}; ///< samples, all present
    int sublattices = 1;

    std::size_t count() const { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); }
};

/// Codes symbols below `colours` (2..256), x fastest.
Bytes encodeMixed(const MixedShape& shape, int colours, std::span<const std::uint8_t> symbols);
/// Decodes shape.count() symbols; `in` must end with them.
DecodeStatus decodeMixed(const MixedShape& shape, int colours, std::span<const std::byte> in,
                         std::span<std::uint8_t> symbols);

} // namespace tessera::codec
