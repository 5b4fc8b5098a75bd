#pragma once

#include "codec/brick/brick_tally.h"
#include "codec/brick/numbers.h"
#include "codec/container/container.h"
#include "codec/wavelet/lifting.h"
#include "volume/bricks/brick_source.h"

#include <vector>

/// Index of an archive: positions and coding of bricks. (FORMAT.md "Index".)
namespace tessera::codec {

/// A segment of a coded brick; its position follows from the lengths before it.
struct Segment {
    std::uint64_t offset = 0; ///< in the file; not stored
    std::uint32_t length = 0;
    std::uint64_t checksum = 0;
};

/// The mask of one brick; no bytes if all or none of its samples are present.
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
    BrickTally tally;        ///< only with kBrickTallies, and not of repeats
    /// Properties of bricks that archives without kBrickNotes lack.
    struct Notes {
        volume::BrickImportance importance;             ///< stored with 16 bits each
        volume::BrickChange change{kUnknown, kUnknown}; ///< from the frame before; rms is stored as a share of max
        int repeats = 0; ///< above 0: the samples, and the bytes, are those of the frame so many times before
    } notes;

    static constexpr float kUnknown = -1;
};

/// The values as read back from the archive, the change rounded up.
FrameBrick::Notes rounded(const FrameBrick::Notes& notes);

/// One component of one parameter at one time.
struct FrameRecord {
    std::uint32_t time = 0, component = 0; ///< component: counted through all parameters
    std::uint64_t offset = 0, length = 0;
    NumberCoding numbers;
    Wavelet wavelet = Wavelet::W22;
    bool keepsAbsent = false;
    bool bodyCentred = false; ///< only with kBrickNotes
    std::int32_t mask = -1;   ///< index of a MaskRecord, -1: all present
    std::int32_t model = -1;  ///< index of a model, the tables of the coefficient coder; -1: none yet
    int codeBits = 32;        ///< every |code| is below 2^codeBits
    double valueOffset = 0, valueScale = 1;
    std::vector<FrameBrick> bricks;
    std::vector<Segment> segments; ///< [segment * bricks + brick], coarsest level first, as they lie in the file
};

/// What one commit adds to the index.
struct IndexPage {
    Block previousPage, previousMetadata; ///< empty on the first page; previousMetadata also where it still holds
    std::vector<double> times;
    std::vector<Block> models;
    std::vector<MaskRecord> masks;
    std::vector<FrameRecord> frames;
    Bytes tallies; ///< as read: of all frames, in bits
};

struct Index {
    std::vector<double> times;
    std::vector<Block> models;
    std::vector<MaskRecord> masks;
    std::vector<FrameRecord> frames; ///< [time * components + component]
    std::vector<Block> pages;        ///< the first first
    std::vector<Block> retired;      ///< metadata of former commits
    std::uint64_t pageBytes = 0;     ///< of all pages, decoded
};

/// What the metadata says of the shape of an index.
struct IndexShape {
    std::uint64_t components = 0, bricks = 0;
    volume::BrickGrid grid;
};

/// Largest decoded size of all pages of a compact archive, so that a small file cannot request much memory.
constexpr std::uint64_t mostPageBytes(std::uint64_t fileSize) {
    return (std::uint64_t(1) << 22) + 16 * fileSize;
}

/// The bytes of a page, as an LZMA block (codec/bytes/lzma.h) in compact archives. `features`: of the header.
Bytes serialise(const IndexPage& page, std::uint32_t features);

/// Reads and checks the index a header names. Throws Error naming `file` when a checksum or a length is wrong, frames
/// are missing, or chunks, pages and metadata do not fill the file up to header.fileSize exactly, in any order.
Index readIndex(std::span<const std::byte> bytes, const Header& header, const IndexShape& shape,
                const std::string& file);

} // namespace tessera::codec
