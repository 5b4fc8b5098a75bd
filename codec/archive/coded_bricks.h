#pragma once

#include "codec/bytes/entropy.h"
#include "volume/system/scratch_file.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace tessera::codec {

/// Number of bricks of this many bytes to code before their bytes are stored: several for every core, few enough to
/// hold in memory.
constexpr std::size_t batchOf(std::size_t brickBytes) {
    constexpr std::size_t kBytes = std::size_t(16) << 20, kLeast = 8, kMost = 64;
    const std::size_t fit = kBytes / (brickBytes > 0 ? brickBytes : 1);
    return fit < kLeast ? kLeast : fit > kMost ? kMost : fit;
}

/// Collects the coded segments of the bricks of a frame, since a file stores them segment by segment, not brick by
/// brick.
class CodedBricks {
public:
    /// `folder`: where to create a scratch file for them; null: keep them in memory.
    CodedBricks(std::size_t bricks, std::size_t segments, const std::string* folder);

    /// Stores the segments of a brick; one call at a time.
    void put(std::size_t brick, std::vector<Bytes> segments);
    /// Returns a segment; once each.
    Bytes take(std::size_t brick, std::size_t segment);

private:
    struct Place {
        std::uint64_t offset = 0;
        std::uint32_t size = 0;
    };
    std::size_t segments_;
    std::unique_ptr<volume::ScratchFile> file_;
    std::uint64_t end_ = 0;
    std::vector<Place> places_;             ///< with a file: by brick, then segment
    std::vector<std::vector<Bytes>> bytes_; ///< without
};

} // namespace tessera::codec
