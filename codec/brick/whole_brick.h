#pragma once

#include "codec/bytes/decode_status.h"
#include "codec/bytes/entropy.h"
#include "codec/bytes/mixed_symbols.h"

#include <optional>
#include <span>

/// Coding of a brick as one stream of codes: for constants, labels, sparse volumes, repeated slices. (FORMAT.md "Whole
/// bricks".)
namespace tessera::codec {

/// Whether this is the first byte of a segment from encodeWhole or encodeWholeMixed.
bool isWhole(std::byte mode);
/// Whether it is of one from encodeWholeMixed.
bool isMixed(std::byte mode);

/// Codes mode and stream of the codes or, if they have few distinct values, of indices into a palette.
Bytes encodeWhole(std::span<const std::uint32_t> codes, Compressor& compressor);

/// The same as a mixed brick, of which all samples are present; empty if it cannot be one.
Bytes encodeWholeMixed(std::span<const std::uint32_t> codes, const MixedShape& shape, Compressor& compressor);

/// The single code of all samples, if the bytes represent a constant.
std::optional<std::uint32_t> onlyCode(std::span<const std::byte> in);

/// Decodes `codes`; `in` must end with them, and its mode must satisfy isWhole(). `mixed`: the shape of the brick, if
/// it may be mixed.
DecodeStatus decodeWhole(std::span<const std::byte> in, std::span<std::uint32_t> codes,
                         const std::optional<MixedShape>& mixed = std::nullopt);

} // namespace tessera::codec
