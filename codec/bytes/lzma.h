#pragma once

#include "codec/bytes/decode_status.h"
#include "codec/bytes/entropy.h"

/// LZMA: slow, and a good deal shorter than zstd where bytes are few. Raw streams, as they stand in .lzma files behind
/// 13 bytes of header, without an end marker. (FORMAT.md "Streams", "Pieces".)
namespace tessera::codec {

inline constexpr int kMostLiteralBits = 4;

/// Literals are coded in the context of the `literalBits` high bits of the byte before.
Bytes encodeLzma(std::span<const std::byte> in, int literalBits);
/// Decodes all of `in`, which must give exactly out.size() bytes.
DecodeStatus decodeLzma(std::span<const std::byte> in, int literalBits, std::span<std::byte> out) noexcept;

/// Longer pieces are not worth the time that decoding them would take; none of them is LZMA. Part of the format.
inline constexpr std::size_t kLongPiece = 1 << 16;

/// Text or a page of the index: its length, then LZMA that goes on from a fixed dictionary; of what is long or would
/// not become shorter, or if it is to be plain, the bytes themselves.
Bytes encodePiece(std::span<const std::byte> in, bool plain = false);
/// Undoes encodePiece; never allocates more than the bytes of `in` or kLongPiece.
DecodeStatus decodePiece(std::span<const std::byte> in, Bytes& out);

} // namespace tessera::codec
