#include "codec/container/container.h"

#include "volume/base/error.h"

#include <array>
#include <cstring>
#include <optional>
#include <xxhash.h>

namespace tessera::codec {

namespace {

// Starts with a non-text byte and contains line ends, to detect text-mode conversions.
constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'T', 'S', 'R', 0x0d, 0x0a, 0x1a, 0x0a};

/// Parses one copy of the header at position `at`, the front of `bytes`.
Header parseHeader(std::span<const std::byte> bytes, std::size_t at, std::uint64_t fileBytes, const std::string& file) {
    const auto place = [at](std::size_t offset) { return "byte " + std::to_string(at + offset); };
    if (bytes.size() < kMagic.size() || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
        throw Error("not a Tessera archive", file, place(0));
    if (bytes.size() < kHeaderBytes) throw Error("the header is truncated", file, place(0));
    ByteReader in(bytes.subspan(kMagic.size(), kHeaderBytes - kMagic.size()));
    Header header;
    header.version = in.get<std::uint32_t>();
    header.features = in.get<std::uint32_t>();
    header.fileSize = in.get<std::uint64_t>();
    header.metadata = in.get<Block>();
    header.index = in.get<Block>();
    if (in.get<std::uint64_t>() != checksum(bytes.first(kHeaderBytes - 8)))
        throw Error("the header is damaged (checksum)", file, place(0));
    const std::string version = "archive version " + std::to_string(header.version);
    if (header.version > kFormatVersion)
        throw Error("written by a newer version of Tessera (" + version + ", this one reads version " +
                        std::to_string(kFormatVersion) + ")",
                    file, place(8));
    if (header.version < kFormatVersion)
        throw Error("written by an early version of Tessera (" + version +
                        "), which is no longer read: pack the data again",
                    file, place(8));
    if ((header.features & ~kKnownFeatures) != 0)
        throw Error("the archive needs features this program does not know", file, place(12));
    if (header.fileSize > fileBytes)
        throw Error("the file has " + std::to_string(fileBytes) + " bytes, but its header says " +
                        std::to_string(header.fileSize),
                    file, place(16));
    const std::uint64_t end = header.fileSize;
    const auto inside = [&](const Block& block) {
        return block.offset >= kFirstChunk && block.offset <= end && block.length <= end - block.offset;
    };
    const bool whole = inside(header.metadata) && inside(header.index) &&
                       header.index.offset + header.index.length == end &&
                       header.metadata.offset + header.metadata.length <= header.index.offset;
    if (!whole) throw Error("the parts of the archive do not fill the file", file, place(24));
    return header;
}

} // namespace

std::uint64_t checksum(std::span<const std::byte> bytes) {
    return XXH3_64bits(bytes.data(), bytes.size());
}

std::optional<FilePart> wholePart(const FileBytes& file, const Block& block, const std::string& path) {
    const FileRange range{block.offset, block.length};
    std::optional<FilePart> part = file.part(range);
    if (checksum(part->bytes()) == block.checksum) return part;
    part = file.freshPart(range);
    if (part && checksum(part->bytes()) == block.checksum) return part;
    if (file.hasChanged()) throw ReadError("the file has changed since it was opened: open it again", path);
    return std::nullopt;
}

Bytes serialise(const Header& header) {
    ByteWriter out;
    for (const std::uint8_t byte : kMagic) out.put(byte);
    out.put(header.version);
    out.put(header.features);
    out.put(header.fileSize);
    out.put(header.metadata);
    out.put(header.index);
    out.put(checksum(out.bytes));
    return out.bytes;
}

HeaderState parseHeaders(std::span<const std::byte> bytes, std::uint64_t fileBytes, const std::string& file) {
    std::optional<Header> first, second;
    std::optional<Error> problem;
    try {
        first = parseHeader(bytes, 0, fileBytes, file);
    } catch (const Error& error) {
        problem = error;
    }
    if (bytes.size() >= 2 * kHeaderBytes) try {
            second = parseHeader(bytes.subspan(kHeaderBytes), kHeaderBytes, fileBytes, file);
        } catch (const Error&) { // use the first copy
        }
    if (!first && !second) throw Error(*problem);
    const bool damaged = !first || !second;
    if (!first || (second && second->fileSize > first->fileSize)) first = second;
    return {*first, damaged};
}

} // namespace tessera::codec
