#pragma once

#include "vis/bricks/brick_levels.h"
#include "vis/gl/handles.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace tessera::vis {

inline constexpr std::uint64_t kFramesInUse = 2; ///< channels used in the last frames are not evicted

/// One channel at one time on the GPU: a single texture if it is small enough, else bricks in an atlas.
struct ChannelTexture {
    /// Whether missing bricks can be loaded.
    enum class Room {
        Left,
        None, ///< the atlas is full: no more bricks, unless the budget may be exceeded
        Never ///< the driver has no memory for more bricks
    };
    std::shared_ptr<const Texture> texture; ///< may be shared by several times; null for bricked channels
    int level = 0;                          ///< of the texture
    int madeOf = 0;                         ///< the time whose samples it shows
    TexelEncoding encoding;
    glm::ivec3 size{0}; ///< texels with halo
    BlockRanges wholeBlocks;
    std::size_t bytes = 0;
    std::unique_ptr<BrickLevels> bricks; ///< null if a single texture holds the channel
    BrickAtlas* atlas = nullptr;
    Room room = Room::Left;

    /// Texel ranges on blockGrid().
    const BlockRanges& blocks() const { return bricks ? bricks->blocks() : wholeBlocks; }
    /// Missing bricks cannot be loaded; `beyond`: although the budget may be exceeded.
    bool full(bool beyond) const { return room == Room::Never || (room == Room::None && !beyond); }
    /// Something is resident everywhere, or never will be.
    bool drawable() const { return !bricks || bricks->drawable() || room != Room::Left; }
    /// A copy that shares the texture, for another time.
    ChannelTexture sharedWhole() const;
};

/// A requested channel at one time: its resident data and the state of its loading.
struct ResidentChannel {
    enum class Work {
        None,
        Loading, ///< a job for the whole channel, or for its first brick, is running
        Failed   ///< loading failed for good
    };
    Work work = Work::None;
    std::shared_ptr<const ChannelSummary> summary;
    std::optional<ChannelTexture> shown;
    bool coverage = false;                     ///< required because of a damaged brick
    int bricksInFlight = 0;                    ///< running brick jobs
    int finest = 0;                            ///< finest level of a whole channel that fits the driver's memory
    std::uint64_t used = 0;                    ///< last frame in which it was wanted
    std::shared_ptr<const BrickDemand> demand; ///< of the view that requested it last

    /// A job has ended; `failed`: there will be no further results.
    void ended(bool failed) { work = failed || work == Work::Failed ? Work::Failed : Work::None; }
    bool hasBricks() const { return shown && shown->bricks; }
    /// Records the demand of a view in a frame. True if no view had that demand, or if a view dropped its former one.
    bool wantedAnew(const std::shared_ptr<const BrickDemand>& demand, std::uint64_t frame);
    /// Whether no better data will come; `textureLevel`: finest level that fits into one texture (0: whole channels).
    bool settled(int textureLevel, bool beyond) const;
    /// Number of bricks, of `all`, that are drawn coarser than last wanted.
    int missing(int all) const;

private:
    struct Wanted {
        std::shared_ptr<const BrickDemand> demand;
        std::uint64_t frame = 0; ///< last frame in which a view wanted it
    };
    std::vector<Wanted> wanted_; ///< demands of the views in the last frames
};

} // namespace tessera::vis
