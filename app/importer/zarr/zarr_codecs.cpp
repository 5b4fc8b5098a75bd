#include "app/importer/zarr/zarr_codecs.h"

#include <algorithm>
#include <array>
#include <blosc.h>
#include <bzlib.h>
#include <cstdint>
#include <limits>
#include <lz4.h>
#include <lzma.h>
#include <stdexcept>
#include <zlib.h>
#include <zstd.h>

namespace tessera::importer {

namespace {

[[noreturn]] void damagedChunk(const std::string& what) {
    throw std::runtime_error("has a chunk that " + what);
}

void inflateChunk(const std::vector<char>& chunk, std::vector<char>& out) {
    z_stream stream{};
    constexpr int kZlibOrGzip = 15 + 32;
    if (inflateInit2(&stream, kZlibOrGzip) != Z_OK) damagedChunk("cannot be decompressed");
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(chunk.data()));
    stream.avail_in = uInt(chunk.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = uInt(out.size());
    const int status = inflate(&stream, Z_FINISH);
    const std::size_t left = stream.avail_out;
    inflateEnd(&stream);
    if (status != Z_STREAM_END || left != 0) damagedChunk("is damaged or has another size than stated");
}

void zstdChunk(const std::vector<char>& chunk, std::vector<char>& out) {
    const std::size_t got = ZSTD_decompress(out.data(), out.size(), chunk.data(), chunk.size());
    if (ZSTD_isError(got) != 0 || got != out.size()) damagedChunk("is damaged or has another size than stated");
}

/// A block after its length, a little-endian number of 4 bytes.
void lz4Chunk(const std::vector<char>& chunk, std::vector<char>& out) {
    constexpr std::size_t kHead = 4;
    if (chunk.size() < kHead) damagedChunk("ends early");
    const int got = LZ4_decompress_safe(chunk.data() + kHead, out.data(), int(chunk.size() - kHead), int(out.size()));
    if (got < 0 || std::size_t(got) != out.size()) damagedChunk("is damaged or has another size than stated");
}

void lzmaChunk(const std::vector<char>& chunk, std::vector<char>& out) {
    std::uint64_t memory = std::uint64_t(1) << 30;
    std::size_t from = 0, to = 0;
    const lzma_ret status =
        lzma_stream_buffer_decode(&memory, 0, nullptr, reinterpret_cast<const std::uint8_t*>(chunk.data()), &from,
                                  chunk.size(), reinterpret_cast<std::uint8_t*>(out.data()), &to, out.size());
    if (status != LZMA_OK || to != out.size()) damagedChunk("is damaged or has another size than stated");
}

void bloscChunk(const std::vector<char>& chunk, std::vector<char>& out) {
    std::size_t stated = 0;
    if (blosc_cbuffer_validate(chunk.data(), chunk.size(), &stated) < 0 || stated != out.size())
        damagedChunk("is damaged or has another size than stated");
    const int got = blosc_decompress_ctx(chunk.data(), out.data(), out.size(), 1);
    if (got < 0 || std::size_t(got) != out.size()) damagedChunk("is damaged");
}

void bzip2Chunk(const std::vector<char>& chunk, std::vector<char>& out) {
    auto got = unsigned(out.size());
    const int status =
        BZ2_bzBuffToBuffDecompress(out.data(), &got, const_cast<char*>(chunk.data()), unsigned(chunk.size()), 0, 0);
    if (status != BZ_OK || got != out.size()) damagedChunk("is damaged or has another size than stated");
}

struct Codec {
    const char* name;
    void (*run)(const std::vector<char>& chunk, std::vector<char>& out);
};
constexpr std::array kCodecs = {Codec{"zlib", inflateChunk}, Codec{"gzip", inflateChunk}, Codec{"zstd", zstdChunk},
                                Codec{"lz4", lz4Chunk},      Codec{"lzma", lzmaChunk},    Codec{"bz2", bzip2Chunk},
                                Codec{"blosc", bloscChunk}};

} // namespace

bool knowsCompressor(const std::string& name) {
    return name.empty() || std::ranges::any_of(kCodecs, [&](const Codec& codec) { return name == codec.name; });
}

std::vector<char> decompressed(const std::string& compressor, const std::vector<char>& chunk, std::size_t wanted) {
    if (wanted > std::size_t(std::numeric_limits<int>::max()) ||
        chunk.size() > std::size_t(std::numeric_limits<int>::max()))
        damagedChunk("has more than 2 GiB");
    if (compressor.empty()) {
        if (chunk.size() != wanted) damagedChunk("has another size than stated");
        return chunk;
    }
    std::vector<char> out(wanted);
    for (const Codec& codec : kCodecs)
        if (compressor == codec.name) {
            codec.run(chunk, out);
            return out;
        }
    damagedChunk("is compressed by " + compressor.substr(0, 40) + ", which is not read");
}

} // namespace tessera::importer
