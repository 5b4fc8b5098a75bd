#pragma once

#include "codec/bytes/entropy.h"
#include "volume/system/file_bytes.h"

#include <bit>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

/// The container of a .tsr file. (FORMAT.md "File".)
///
///     0        80             160                                                              fileSize
///     | header | header again | chunks, metadata, page | chunks, metadata, page | ... | last page | unfinished ...
///
/// Bytes are only appended beyond fileSize; then both headers, one after the other, are set to the new end. Thus one of
/// them describes a complete archive at any time.
namespace tessera::codec {

inline constexpr std::uint32_t kFormatVersion = 3;
inline constexpr std::size_t kHeaderBytes = 80;
/// Position of the first chunk, after the two headers.
inline constexpr std::uint64_t kFirstChunk = 2 * kHeaderBytes;
/// Feature: the index has importance, change and repeats of bricks; frames can be body-centred and integers quantised.
inline constexpr std::uint32_t kBrickNotes = 1;
/// Feature: metadata and index pages are LZMA blocks (codec/bytes/lzma.h), streams can be LZMA, and models can be
/// empty.
inline constexpr std::uint32_t kCompact = 2;
/// Feature: models can have contexts by band.
inline constexpr std::uint32_t kBandContexts = 4;
/// Feature: the index has mean and histogram of each brick.
inline constexpr std::uint32_t kBrickStatistics = 8;
/// Feature: numbers of frames can be of kind Stepped. Only set once one is.
inline constexpr std::uint32_t kSteppedBricks = 16;
/// Feature: frames can be subsampled. Only set once one is.
inline constexpr std::uint32_t kSubsamples = 32;
/// Feature: frames can be predicted from the time before. Only set once one is.
inline constexpr std::uint32_t kPredictedFrames = 64;
/// Feature: models can have fitted predictions. Only set once one has.
inline constexpr std::uint32_t kFittedModels = 128;
/// Feature: bricks can be mixed. Only set once one is.
inline constexpr std::uint32_t kMixedBricks = 256;
/// Feature: the metadata name archives of corrections inside the file. Only set once there is one.
inline constexpr std::uint32_t kCorrections = 512;
/// Feature: parts of a frame can be transformed apart. Only set once they are.
inline constexpr std::uint32_t kPartedFrames = 2048;
/// Feature: frames of integers can be of kind Stepped. Only set once one is.
inline constexpr std::uint32_t kSteppedIntegers = 4096;
/// Feature: the metadata name blocks of numbers of regions. Only set once there is one.
inline constexpr std::uint32_t kRegionNumbers = 8192;
/// Feature: the lattice has axes of uneven spacing. Only set where it has.
inline constexpr std::uint32_t kUnevenAxes = 16384;
/// Features that are only set once they are used.
inline constexpr std::uint32_t kSetWhenUsed = kSteppedBricks | kSubsamples | kPredictedFrames | kFittedModels |
                                              kMixedBricks | kCorrections | kPartedFrames | kSteppedIntegers |
                                              kRegionNumbers | kUnevenAxes;
inline constexpr std::uint32_t kUsualFeatures = kBrickNotes | kCompact | kBandContexts | kBrickStatistics,
                               kKnownFeatures = kUsualFeatures | kSetWhenUsed;

/// xxh3, 64 bits, seed 0.
std::uint64_t checksum(std::span<const std::byte> bytes);

/// A range of the file with a checksum.
struct Block {
    std::uint64_t offset = 0, length = 0, checksum = 0;
    bool operator==(const Block&) const = default;
};

/// The bytes of a block. If their checksum is wrong and they came from a cache, they are fetched once more. Nothing if
/// it is wrong then. Throws ReadError naming `path` when the file cannot be read or has been replaced.
std::optional<FilePart> wholePart(const FileBytes& file, const Block& block, const std::string& path);

struct Header {
    std::uint32_t version = kFormatVersion;
    std::uint32_t features = kUsualFeatures; ///< flags that a reader must know
    std::uint64_t fileSize = 0;              ///< bytes beyond belong to an unfinished append
    Block metadata, index;                   ///< index: its last page
    bool operator==(const Header&) const = default;
};

struct HeaderState {
    Header header;
    bool damaged = false; ///< one of the two copies is invalid
};

Bytes serialise(const Header& header);
/// The valid header of the two copies at the start of a file of `fileBytes` bytes; if both are valid, that of the
/// larger complete archive. Checks magic, version, features, checksum and positions; throws Error naming `file`.
HeaderState parseHeaders(std::span<const std::byte> bytes, std::uint64_t fileBytes, const std::string& file);

/// Appends little-endian numbers.
class ByteWriter {
public:
    template <class T> void put(T value) {
        if constexpr (std::same_as<T, double>)
            put(std::bit_cast<std::uint64_t>(value));
        else if constexpr (std::same_as<T, float>)
            put(std::bit_cast<std::uint32_t>(value));
        else
            for (std::size_t i = 0; i < sizeof(T); ++i)
                bytes.push_back(static_cast<std::byte>(static_cast<std::uint64_t>(value) >> (8 * i)));
    }
    void put(const Block& block) {
        put(block.offset);
        put(block.length);
        put(block.checksum);
    }
    Bytes bytes;
};

/// Reads little-endian numbers; the caller has checked that there are enough bytes.
class ByteReader {
public:
    explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
    std::size_t left() const { return bytes_.size(); }
    std::span<const std::byte> rest() const { return bytes_; }
    template <class T> T get() {
        if constexpr (std::same_as<T, double>)
            return std::bit_cast<double>(get<std::uint64_t>());
        else if constexpr (std::same_as<T, float>)
            return std::bit_cast<float>(get<std::uint32_t>());
        else if constexpr (std::same_as<T, Block>) {
            const auto offset = get<std::uint64_t>(), length = get<std::uint64_t>();
            return {offset, length, get<std::uint64_t>()};
        } else {
            std::uint64_t value = 0;
            for (std::size_t i = 0; i < sizeof(T); ++i) value |= static_cast<std::uint64_t>(bytes_[i]) << (8 * i);
            bytes_ = bytes_.subspan(sizeof(T));
            return static_cast<T>(value);
        }
    }

private:
    std::span<const std::byte> bytes_;
};

} // namespace tessera::codec
