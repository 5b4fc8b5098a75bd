#pragma once

#include "codec/archive/frame_coding.h"
#include "codec/bytes/entropy.h"
#include "volume/system/scratch_file.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace tessera::codec {

/// Number of bricks of this size to code per batch: several per core, few enough to hold in memory.
constexpr std::size_t batchOf(std::size_t brickBytes) {
    constexpr std::size_t kBytes = std::size_t(16) << 20, kLeast = 8, kMost = 64;
    const std::size_t fit = kBytes / (brickBytes > 0 ? brickBytes : 1);
    return fit < kLeast ? kLeast : fit > kMost ? kMost : fit;
}

/// Buffers the coded segments of a frame's bricks, since the file stores them segment by segment.
class CodedBricks {
public:
    /// `folder`: directory for a scratch file; null: segments are kept in memory.
    CodedBricks(std::size_t bricks, std::size_t segments, const std::string* folder);

    /// Forgets all of them, since the bricks are coded again.
    void clear();
    /// Stores the segments of a brick. Not thread-safe.
    void put(std::size_t brick, std::vector<Bytes> segments);
    /// Returns a segment; call once for each.
    Bytes take(std::size_t brick, std::size_t segment);

private:
    struct Place {
        std::uint64_t offset = 0;
        std::uint32_t size = 0;
    };
    std::size_t segments_;
    std::unique_ptr<volume::ScratchFile> file_;
    std::uint64_t end_ = 0;
    std::vector<Place> places_;             ///< in the scratch file, by brick, then segment
    std::vector<std::vector<Bytes>> bytes_; ///< in memory
};

/// How streams of bytes are compressed.
struct ZstdUse {
    int level = 3;
    bool thorough = false; ///< as of Compressor
};

/// Codes every brick of a frame; true if no token was coded. In a team each process codes some slabs; the one that
/// writes gets the segments of all of them, and every process the properties of their bricks.
bool codeBricks(FrameCoding& coding, const FrameSamples& samples, const ZstdUse& zstd, CodedBricks& coded,
                const Progress& progress);

} // namespace tessera::codec
