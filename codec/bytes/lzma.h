#pragma once

#include "codec/bytes/bytes.h"
#include "codec/bytes/decode_status.h"

/// LZMA: slow, but much smaller than zstd for short data. Raw streams, as in .lzma files after the 13-byte header,
/// without an end marker. (FORMAT.md "Streams", "Compact archives".)
namespace tessera::codec {

inline constexpr int kMostLiteralBits = 4;

/// Compresses `in`; the context of a literal is the `literalBits` high bits of the previous byte.
Bytes encodeLzma(std::span<const std::byte> in, int literalBits);
/// Decompresses `in`, which must contain exactly out.size() bytes.
DecodeStatus decodeLzma(std::span<const std::byte> in, int literalBits, std::span<std::byte> out) noexcept;

/// Longer blocks are never LZMA, since decoding would be slow. Part of the format.
inline constexpr std::size_t kLongBlock = 1 << 16;

/// Codes a text or an index page as an LZMA block: its length, then LZMA with a preset dictionary; or the bytes
/// themselves if they are long, would not become shorter, or `plain` is set.
Bytes encodeBlock(std::span<const std::byte> in, bool plain = false);
/// Decodes an LZMA block; allocates at most in.size() or kLongBlock bytes.
DecodeStatus decodeBlock(std::span<const std::byte> in, Bytes& out);

} // namespace tessera::codec
