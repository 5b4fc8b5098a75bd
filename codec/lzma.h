#pragma once

#include "codec/decode_status.h"
#include "codec/entropy.h"

/// LZMA: slow, and a good deal shorter than zstd where bytes are few. Raw streams, as they stand in .lzma files behind
/// 13 bytes of header, without an end marker. (FORMAT.md "Streams", "Pieces".)
namespace tessera::codec {

inline constexpr int kMostLiteralBits = 4;

/// Literals are coded in the context of the `literalBits` high bits of the byte before.
Bytes encodeLzma(std::span<const std::byte> in, int literalBits);
/// Decodes all of `in`, which must give exactly out.size() bytes.
DecodeStatus decodeLzma(std::span<const std::byte> in, int literalBits, std::span<std::byte> out) noexcept;

/// Text or a page of the index: its length, then LZMA that goes on from a fixed dictionary; of what is long or would
/// not become shorter the bytes themselves.
Bytes encodePiece(std::span<const std::byte> in);
/// Undoes encodePiece; never allocates more than 4096 times the bytes of `in`.
DecodeStatus decodePiece(std::span<const std::byte> in, Bytes& out);

} // namespace tessera::codec
