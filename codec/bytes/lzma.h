#pragma once

#include "codec/bytes/bytes.h"
#include "codec/bytes/decode_status.h"

/// LZMA: slow, and much smaller than zstd for few bytes. Raw streams, as in .lzma files after the 13-byte header,
/// without an end marker. (FORMAT.md "Streams", "Pieces".)
namespace tessera::codec {

inline constexpr int kMostLiteralBits = 4;

/// Literals are coded in the context of the `literalBits` high bits of the byte before.
Bytes encodeLzma(std::span<const std::byte> in, int literalBits);
/// Decodes all of `in`, which must give exactly out.size() bytes.
DecodeStatus decodeLzma(std::span<const std::byte> in, int literalBits, std::span<std::byte> out) noexcept;

/// Longer blocks are never LZMA, since decoding would take too long. Part of the format.
inline constexpr std::size_t kLongPiece = 1 << 16;

/// Codes text or an index page: its length, then LZMA with a fixed dictionary; if it is long, would not become shorter,
/// or `plain` is set, the bytes themselves.
Bytes encodePiece(std::span<const std::byte> in, bool plain = false);
/// Undoes encodePiece; never allocates more than the bytes of `in` or kLongPiece.
DecodeStatus decodePiece(std::span<const std::byte> in, Bytes& out);

} // namespace tessera::codec
