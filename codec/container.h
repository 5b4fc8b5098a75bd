#pragma once

#include "codec/entropy.h"
#include "codec/lifting.h"
#include "codec/numbers.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// The byte layout of a .tsr file: header, chunks, metadata, index, without gaps. (FORMAT.md "File".)
///
///     0        80                     metadataOffset     indexOffset      fileSize
///     | header | mask and frame chunks | metadata (JSON) | index          |
namespace tessera::codec {

/// Version 1 knew neither models nor bands; it is read, never written.
inline constexpr std::uint32_t kFormatVersion = 2, kOldestVersion = 1;
inline constexpr std::size_t kHeaderBytes = 80;

/// xxh3, 64 bits, seed 0.
std::uint64_t checksum(std::span<const std::byte> bytes);

struct Header {
    std::uint32_t version = kFormatVersion;
    std::uint32_t features = 0; ///< bits a reader must know; none yet
    std::uint64_t fileSize = 0;
    std::uint64_t metadataOffset = 0, metadataLength = 0, metadataChecksum = 0;
    std::uint64_t indexOffset = 0, indexLength = 0, indexChecksum = 0;
};

Bytes serialise(const Header& header);
/// Checks magic, version, features, checksum and that the parts fill `fileSize` bytes; throws Error naming `file`.
Header parseHeader(std::span<const std::byte> bytes, std::uint64_t fileSize, const std::string& file);

/// A coded piece of a brick; where it lies follows from the lengths before it.
struct Segment {
    std::uint64_t offset = 0; ///< in the file; not stored
    std::uint32_t length = 0;
    std::uint64_t checksum = 0;
};

/// The flags of one brick; no bytes when all or none are present.
struct MaskBrick {
    Segment segment;
    std::uint32_t present = 0; ///< how many samples are
};

struct MaskRecord {
    std::uint64_t offset = 0, length = 0;
    std::vector<MaskBrick> bricks;
};

struct FrameBrick {
    float min = 0, max = -1; ///< physical values of present samples; min > max: none
};

/// The tables of the coefficient coder for a frame, or for several.
struct ModelRecord {
    std::uint64_t offset = 0, length = 0, checksum = 0;
};

/// One component of one parameter at one time.
struct FrameRecord {
    std::uint64_t offset = 0, length = 0;
    NumberCoding numbers;
    Wavelet wavelet = Wavelet::W22;
    bool keepsAbsent = false;
    std::int32_t mask = -1;  ///< index of a MaskRecord, -1: all present
    std::int32_t model = -1; ///< index of a ModelRecord; -1 in version 1
    int codeBits = 32;       ///< every |code| is below 2^codeBits
    double valueOffset = 0, valueScale = 1;
    std::vector<FrameBrick> bricks;
    std::vector<Segment> segments; ///< [segment * bricks + brick], coarsest level first, as they lie in the file
};

struct Index {
    std::vector<MaskRecord> masks;
    std::vector<ModelRecord> models;
    std::vector<FrameRecord> frames; ///< [time * components + component]
};

Bytes serialise(const Index& index);
/// Parses and checks an index whose shape follows from the metadata. Throws Error naming `file` when a length is
/// impossible or the chunks do not fill [kHeaderBytes, chunksEnd) exactly, in any order.
Index parseIndex(std::span<const std::byte> bytes, std::uint32_t version, std::uint64_t frames, std::uint64_t bricks,
                 int levels, std::uint64_t chunksEnd, const std::string& file);

} // namespace tessera::codec
