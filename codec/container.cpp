#include "codec/container.h"

#include "volume/error.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <xxhash.h>

namespace tessera::codec {

namespace {

// Not text, and damaged by every well-meant conversion of line ends.
constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'T', 'S', 'R', 0x0d, 0x0a, 0x1a, 0x0a};

constexpr std::size_t kMaskRecordBytes = 16, kMaskBrickBytes = 16, kModelRecordBytes = 24, kFrameRecordBytes = 56,
                      kFrameBrickBytes = 8, kSegmentBytes = 12;

/// Little-endian numbers, appended.
class Out {
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
    Bytes bytes;
};

/// The same, read from the front; the caller has checked that there are enough bytes.
class In {
public:
    explicit In(std::span<const std::byte> bytes) : bytes_(bytes) {}
    std::size_t left() const { return bytes_.size(); }
    template <class T> T get() {
        if constexpr (std::same_as<T, double>)
            return std::bit_cast<double>(get<std::uint64_t>());
        else if constexpr (std::same_as<T, float>)
            return std::bit_cast<float>(get<std::uint32_t>());
        else {
            std::uint64_t value = 0;
            for (std::size_t i = 0; i < sizeof(T); ++i) value |= static_cast<std::uint64_t>(bytes_[i]) << (8 * i);
            bytes_ = bytes_.subspan(sizeof(T));
            return static_cast<T>(value);
        }
    }

private:
    std::span<const std::byte> bytes_;
};

void require(bool condition, const char* what, const std::string& file) {
    if (!condition) throw Error(what, file, "index");
}

} // namespace

std::uint64_t checksum(std::span<const std::byte> bytes) {
    return XXH3_64bits(bytes.data(), bytes.size());
}

Bytes serialise(const Header& header) {
    Out out;
    for (const std::uint8_t byte : kMagic) out.put(byte);
    out.put(header.version);
    out.put(header.features);
    out.put(header.fileSize);
    out.put(header.metadataOffset);
    out.put(header.metadataLength);
    out.put(header.metadataChecksum);
    out.put(header.indexOffset);
    out.put(header.indexLength);
    out.put(header.indexChecksum);
    out.put(checksum(out.bytes));
    return out.bytes;
}

Header parseHeader(std::span<const std::byte> bytes, std::uint64_t fileSize, const std::string& file) {
    if (bytes.size() < kMagic.size() || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
        throw Error("not a Tessera archive", file, "byte 0");
    if (bytes.size() < kHeaderBytes) throw Error("the header is truncated", file, "byte 0");
    In in(bytes.subspan(kMagic.size(), kHeaderBytes - kMagic.size()));
    Header header;
    header.version = in.get<std::uint32_t>();
    header.features = in.get<std::uint32_t>();
    header.fileSize = in.get<std::uint64_t>();
    header.metadataOffset = in.get<std::uint64_t>();
    header.metadataLength = in.get<std::uint64_t>();
    header.metadataChecksum = in.get<std::uint64_t>();
    header.indexOffset = in.get<std::uint64_t>();
    header.indexLength = in.get<std::uint64_t>();
    header.indexChecksum = in.get<std::uint64_t>();
    if (in.get<std::uint64_t>() != checksum(bytes.first(kHeaderBytes - 8)))
        throw Error("the header is damaged (checksum)", file, "byte 0");
    if (header.version < kOldestVersion || header.version > kFormatVersion)
        throw Error("archive version " + std::to_string(header.version) + ", this program reads versions up to " +
                        std::to_string(kFormatVersion),
                    file, "byte 8");
    if (header.features != 0) throw Error("the archive needs features this program does not know", file, "byte 12");
    if (header.fileSize != fileSize)
        throw Error("the file has " + std::to_string(fileSize) + " bytes, its header says " +
                        std::to_string(header.fileSize),
                    file, "byte 16");
    const bool whole = header.metadataOffset >= kHeaderBytes && header.metadataOffset <= fileSize &&
                       header.metadataLength <= fileSize - header.metadataOffset &&
                       header.indexOffset == header.metadataOffset + header.metadataLength &&
                       header.indexLength == fileSize - header.indexOffset;
    if (!whole) throw Error("the parts of the archive do not fill the file", file, "byte 24");
    return header;
}

Bytes serialise(const Index& index) {
    Out out;
    out.put(static_cast<std::uint32_t>(index.masks.size()));
    out.put(static_cast<std::uint32_t>(index.frames.size()));
    out.put(static_cast<std::uint32_t>(index.models.size()));
    for (const ModelRecord& model : index.models) {
        out.put(model.offset);
        out.put(model.length);
        out.put(model.checksum);
    }
    for (const MaskRecord& mask : index.masks) {
        out.put(mask.offset);
        out.put(mask.length);
        for (const MaskBrick& brick : mask.bricks) {
            out.put(brick.segment.length);
            out.put(brick.present);
            out.put(brick.segment.checksum);
        }
    }
    for (const FrameRecord& frame : index.frames) {
        out.put(frame.offset);
        out.put(frame.length);
        out.put(static_cast<std::uint8_t>(frame.numbers.kind));
        out.put(static_cast<std::uint8_t>(frame.wavelet));
        out.put(static_cast<std::uint8_t>(frame.keepsAbsent ? 1 : 0));
        out.put(static_cast<std::uint8_t>(frame.codeBits));
        out.put(frame.mask);
        out.put(frame.model);
        out.put(frame.numbers.origin);
        out.put(frame.numbers.step);
        out.put(frame.valueOffset);
        out.put(frame.valueScale);
        for (const FrameBrick& brick : frame.bricks) {
            out.put(brick.min);
            out.put(brick.max);
        }
        for (const Segment& segment : frame.segments) {
            out.put(segment.length);
            out.put(segment.checksum);
        }
    }
    return out.bytes;
}

Index parseIndex(std::span<const std::byte> bytes, std::uint32_t version, std::uint64_t frames, std::uint64_t bricks,
                 int levels, std::uint64_t chunksEnd, const std::string& file) {
    In in(bytes);
    const bool hasModels = version > 1;
    const std::uint64_t headBytes = hasModels ? 12 : 8;
    require(in.left() >= headBytes, "the index is truncated", file);
    const std::uint64_t maskCount = in.get<std::uint32_t>(), frameCount = in.get<std::uint32_t>();
    const std::uint64_t modelCount = hasModels ? in.get<std::uint32_t>() : 0;
    // No number here exceeds what the bytes of the index can hold, so nothing below overflows or allocates much.
    const std::uint64_t room = bytes.size();
    require(frameCount == frames, "the index and the metadata disagree on the number of frames", file);
    require(bricks <= room && frameCount <= room && maskCount <= room && modelCount <= room, "the index is too short",
            file);
    const std::uint64_t maskBytes = kMaskRecordBytes + bricks * kMaskBrickBytes;
    const std::uint64_t frameBytes = kFrameRecordBytes + (hasModels ? 4 : 0) +
                                     bricks * (kFrameBrickBytes + static_cast<std::uint64_t>(levels) * kSegmentBytes);
    require(maskBytes <= room && frameBytes <= room, "the index is too short", file);
    require(maskCount <= room / maskBytes && frameCount <= room / frameBytes &&
                modelCount <= room / kModelRecordBytes &&
                headBytes + modelCount * kModelRecordBytes + maskCount * maskBytes + frameCount * frameBytes == room,
            "the index has the wrong length", file);

    Index index;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> chunks;
    const auto place = [&](Segment& segment, std::uint64_t& at, std::uint64_t end) {
        require(segment.length <= end - at, "a brick does not fit its chunk", file);
        segment.offset = at;
        at += segment.length;
    };
    const auto startChunk = [&](std::uint64_t offset, std::uint64_t length) {
        require(offset >= kHeaderBytes && offset <= chunksEnd && length <= chunksEnd - offset,
                "a chunk lies outside the file", file);
        chunks.emplace_back(offset, offset + length);
    };
    for (std::uint64_t m = 0; m < modelCount; ++m) {
        ModelRecord& model = index.models.emplace_back();
        model.offset = in.get<std::uint64_t>();
        model.length = in.get<std::uint64_t>();
        model.checksum = in.get<std::uint64_t>();
        startChunk(model.offset, model.length);
    }
    for (std::uint64_t m = 0; m < maskCount; ++m) {
        MaskRecord& mask = index.masks.emplace_back();
        mask.offset = in.get<std::uint64_t>();
        mask.length = in.get<std::uint64_t>();
        startChunk(mask.offset, mask.length);
        std::uint64_t at = mask.offset;
        mask.bricks.resize(bricks);
        for (MaskBrick& brick : mask.bricks) {
            brick.segment.length = in.get<std::uint32_t>();
            brick.present = in.get<std::uint32_t>();
            brick.segment.checksum = in.get<std::uint64_t>();
            place(brick.segment, at, mask.offset + mask.length);
        }
        require(at == mask.offset + mask.length, "the bricks of a mask do not fill its chunk", file);
    }
    for (std::uint64_t f = 0; f < frameCount; ++f) {
        FrameRecord& frame = index.frames.emplace_back();
        frame.offset = in.get<std::uint64_t>();
        frame.length = in.get<std::uint64_t>();
        startChunk(frame.offset, frame.length);
        const auto kind = in.get<std::uint8_t>(), wavelet = in.get<std::uint8_t>(), keeps = in.get<std::uint8_t>();
        const auto codeBits = in.get<std::uint8_t>();
        constexpr std::size_t kWaveletsOfVersion1 = 8;
        require(kind <= static_cast<std::uint8_t>(NumberKind::Quantised), "an unknown coding of numbers", file);
        require(wavelet < (hasModels ? std::size(kWaveletNames) : kWaveletsOfVersion1), "an unknown wavelet", file);
        require(keeps <= 1, "an unknown flag of a frame", file);
        require(hasModels ? codeBits >= 1 && codeBits <= 32 : codeBits == 0, "an impossible width of codes", file);
        frame.numbers.kind = static_cast<NumberKind>(kind);
        frame.wavelet = static_cast<Wavelet>(wavelet);
        frame.keepsAbsent = keeps == 1;
        frame.codeBits = hasModels ? codeBits : 32;
        frame.mask = in.get<std::int32_t>();
        if (hasModels) frame.model = in.get<std::int32_t>();
        require(frame.mask >= -1 && frame.mask < static_cast<std::int64_t>(maskCount), "a mask is missing", file);
        require(!hasModels || (frame.model >= 0 && frame.model < static_cast<std::int64_t>(modelCount)),
                "a model is missing", file);
        frame.numbers.origin = in.get<double>();
        frame.numbers.step = in.get<double>();
        frame.valueOffset = in.get<double>();
        frame.valueScale = in.get<double>();
        frame.bricks.resize(bricks);
        for (FrameBrick& brick : frame.bricks) {
            brick.min = in.get<float>();
            brick.max = in.get<float>();
        }
        std::uint64_t at = frame.offset;
        frame.segments.resize(bricks * static_cast<std::uint64_t>(levels));
        for (Segment& segment : frame.segments) {
            segment.length = in.get<std::uint32_t>();
            segment.checksum = in.get<std::uint64_t>();
            place(segment, at, frame.offset + frame.length);
        }
        require(at == frame.offset + frame.length, "the bricks of a frame do not fill its chunk", file);
    }
    std::sort(chunks.begin(), chunks.end());
    std::uint64_t at = kHeaderBytes;
    for (const auto& [begin, end] : chunks) {
        require(begin == at, "the chunks do not fill the file", file);
        at = end;
    }
    require(at == chunksEnd, "the chunks do not fill the file", file);
    return index;
}

} // namespace tessera::codec
