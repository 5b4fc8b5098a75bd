#pragma once

#include "codec/brick/numbers.h"
#include "codec/container/brick_histogram.h"
#include "codec/container/container.h"
#include "codec/wavelet/lifting.h"
#include "codec/wavelet/subbands.h"
#include "volume/bricks/brick_grid.h"
#include "volume/bricks/brick_stats.h"

#include <cstdint>
#include <string>
#include <vector>

/// Index of an archive: positions and coding parameters of bricks. (FORMAT.md "Index".)
namespace tessera::codec {

/// A segment of a coded brick; its position follows from the lengths of those before it.
struct Segment {
    std::uint64_t offset = 0; ///< position in the file; not stored
    std::uint32_t length = 0;
    std::uint64_t checksum = 0;
};

/// The mask of one brick; no bytes if all or no samples are present.
struct MaskBrick {
    Segment segment;
    std::uint32_t present = 0; ///< number of present samples
};

struct MaskRecord {
    std::uint64_t offset = 0, length = 0;
    std::vector<MaskBrick> bricks;
};

struct FrameBrick {
    float min = 0, max = -1;  ///< physical values of present samples; min > max: none
    BrickHistogram histogram; ///< with kBrickStatistics only, and not for repeats
    /// Properties that archives without kBrickNotes lack.
    struct Notes {
        volume::BrickImportance importance;             ///< stored with 16 bits each
        volume::BrickChange change{kUnknown, kUnknown}; ///< since the previous frame; rms is stored relative to max
        int repeats = 0; ///< above 0: samples and bytes are those of the frame this many times before
    } notes;

    static constexpr float kUnknown = -1;
};

/// The values as read back from the archive, with the change rounded up.
FrameBrick::Notes rounded(const FrameBrick::Notes& notes);

/// One component of one parameter at one time.
struct FrameRecord {
    std::uint32_t time = 0, component = 0; ///< component: counted through all parameters
    std::uint64_t offset = 0, length = 0;
    NumberCoding numbers;
    Wavelet wavelet = Wavelet::W22;
    bool keepsAbsent = false;
    bool bodyCentred = false; ///< with kBrickNotes only
    bool subsampled = false;  ///< with kSubsamples only: samples of level 0 in segment 0
    bool predicted = false;   ///< with kPredictedFrames only: its bricks may be differences (predicted_brick.h)
    bool parted = false;      ///< with kPartedFrames only: its parts are transformed apart (stepped_brick.h)
    bool mixed = false;       ///< with kMixedBricks only: its bricks may be mixed (codec/bytes/mixed_symbols.h)
    std::int32_t mask = -1;   ///< index of a MaskRecord; -1: all present
    std::int32_t model = -1;  ///< index of a model of the coefficient coder, or of steps; -1: none yet
    StepChoice steps;         ///< for numbers of kind Stepped; stored in place of a model
    int codeBits = 32;        ///< every |code| is below 2^codeBits
    double valueOffset = 0, valueScale = 1;
    std::vector<FrameBrick> bricks;
    std::vector<Segment> segments; ///< [segment * bricks + brick], coarsest level first, in file order
};

/// The additions of one commit to the index.
struct IndexPage {
    Block previousPage, previousMetadata; ///< empty on the first page; previousMetadata also if it is unchanged
    std::vector<double> times;
    std::vector<Block> models;
    std::vector<MaskRecord> masks;
    std::vector<FrameRecord> frames;
    Bytes statistics; ///< undecoded bit stream of all frames' statistics
};

struct Index {
    std::vector<double> times;
    std::vector<Block> models;
    std::vector<MaskRecord> masks;
    std::vector<FrameRecord> frames; ///< [time * components + component]
    std::vector<Block> pages;        ///< oldest first
    std::vector<Block> retired;      ///< metadata of former commits
    std::uint64_t pageBytes = 0;     ///< of all pages, decompressed
};

/// Adds models, masks and frames of a page to an index, frames in the order of the page.
void add(const IndexPage& page, Index& index);

/// The shape of an index, from the metadata.
struct IndexShape {
    std::uint64_t components = 0, bricks = 0;
    volume::BrickGrid grid;
    std::vector<FileRange> corrections = {}; ///< archives inside the file
    std::vector<FileRange> numbers = {};     ///< blocks of numbers of regions
};

/// Limit of the decompressed size of all pages of a compact archive, so that a small file cannot request much memory.
constexpr std::uint64_t mostPageBytes(std::uint64_t fileSize) {
    return (std::uint64_t(1) << 22) + 16 * fileSize;
}

/// Serialises a page, in compact archives as an LZMA block (codec/bytes/lzma.h). `features`: of the header.
Bytes serialise(const IndexPage& page, std::uint32_t features);

/// Reads and checks the index that a header names. Throws Error naming `file` when a checksum or a length is wrong,
/// frames are missing, or chunks, pages and metadata do not fill the file up to header.fileSize exactly, in any order.
Index readIndex(const FileBytes& bytes, const Header& header, const IndexShape& shape, const std::string& file);

} // namespace tessera::codec
