#pragma once

#include "codec/bytes/bytes.h"
#include "codec/bytes/decode_status.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

/// General compression of numbers: zstd or LZMA over byte planes.
namespace tessera::codec {

/// The highest useful zstd level.
inline constexpr int kMostZstdLevel = 19;

/// Working memory of the encoder; one per thread. Its state never affects the output.
class Compressor {
public:
    /// `thorough`: also try LZMA for streams, and use the highest zstd level.
    explicit Compressor(int zstdLevel, bool thorough = false);
    ~Compressor();
    Compressor(Compressor&&) noexcept;
    Compressor& operator=(Compressor&&) noexcept;

    /// Returns a zstd frame of `in`; empty if that would not be smaller than `in`.
    Bytes compress(std::span<const std::byte> in);
    /// Sets the zstd level of the next frames.
    void setLevel(int zstdLevel);
    int level() const;
    bool triesLzma() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Decompresses a zstd frame that must contain exactly out.size() bytes.
DecodeStatus decompress(std::span<const std::byte> in, std::span<std::byte> out) noexcept;

/// Maps signed 32-bit numbers near zero to small ones: 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
constexpr std::uint32_t zigzag(std::uint32_t value) {
    return (value << 1) ^ (0u - (value >> 31));
}
constexpr std::uint32_t unzigzag(std::uint32_t symbol) {
    return (symbol >> 1) ^ (0u - (symbol & 1u));
}

/// Appends a stream of symbols to `out` in the shortest form: all zero, constant, byte planes, byte planes compressed
/// by zstd or LZMA. No symbols: no bytes. (FORMAT.md "Streams".)
void encodeStream(std::span<const std::uint32_t> symbols, Compressor& compressor, Bytes& out);

/// Reads a stream of symbols.size() symbols from the front of `in` and advances it.
DecodeStatus decodeStream(std::span<const std::byte>& in, std::span<std::uint32_t> symbols) noexcept;

} // namespace tessera::codec
