#pragma once

#include "vis/bricks/brick_levels.h"
#include "vis/gl/handles.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace tessera::vis {

inline constexpr std::uint64_t kFramesInUse = 2; ///< what one of the last frames used stays

/// One channel at one time on the GPU: a texture of the whole where that is small enough, else bricks in an atlas.
struct ChannelTexture {
    /// For bricks that are missing.
    enum class Room {
        Left,
        None, ///< the atlas is full: they stay missing, unless the budget may be exceeded
        Never ///< the driver has no memory for them either
    };
    std::shared_ptr<const Texture> texture; ///< several times may share it; null where there are bricks
    int level = 0;                          ///< of the texture
    int madeOf = 0;                         ///< time that it shows
    TexelEncoding encoding;
    glm::ivec3 size{0}; ///< texels with halo
    BlockRanges wholeBlocks;
    std::size_t bytes = 0;
    std::unique_ptr<BrickLevels> bricks; ///< null where the texture is all there is
    BrickAtlas* atlas = nullptr;
    Room room = Room::Left;

    /// Texel ranges on blockGrid().
    const BlockRanges& blocks() const { return bricks ? bricks->blocks() : wholeBlocks; }
    /// Missing bricks stay so; `beyond`: though the budget may be exceeded.
    bool full(bool beyond) const { return room == Room::Never || (room == Room::None && !beyond); }
    /// Something shows everywhere, or never will.
    bool drawable() const { return !bricks || bricks->drawable() || room != Room::Left; }
    /// Shows the texture of another time.
    ChannelTexture sharedWhole() const;
};

/// A channel at one time that views asked for: what is here of it and what is done for it.
struct ResidentChannel {
    enum class Work {
        None,
        Loading, ///< a job for the whole channel, or its first brick, is under way
        Failed   ///< nothing more will come
    };
    Work work = Work::None;
    std::shared_ptr<const ChannelSummary> summary;
    std::optional<ChannelTexture> shown;
    bool coverage = false;                     ///< a damaged brick asks for it
    int bricksInFlight = 0;                    ///< jobs for bricks
    int finest = 0;                            ///< level of a whole channel for which the driver has memory
    std::uint64_t used = 0;                    ///< last frame that wanted it
    std::shared_ptr<const BrickDemand> demand; ///< of the view that asked last

    /// A job has ended; `failed`: nothing more will come.
    void ended(bool failed) { work = failed || work == Work::Failed ? Work::Failed : Work::None; }
    bool hasBricks() const { return shown && shown->bricks; }
    /// Notes in a frame what a view wants of the bricks. True where no view wanted that so far, or where one wants no
    /// more what it wanted.
    bool wantedAnew(const std::shared_ptr<const BrickDemand>& demand, std::uint64_t frame);
    /// Nothing better will come of a channel of which level `finest` fits into one texture (0 or more: a whole one).
    bool settled(int textureLevel, bool beyond) const;
    /// Bricks still shown coarser than they were wanted last, of `all`.
    int missing(int all) const;

private:
    struct Wanted {
        std::shared_ptr<const BrickDemand> demand;
        std::uint64_t frame = 0; ///< in which a view wanted it last
    };
    std::vector<Wanted> wanted_; ///< of the views of the last frames
};

} // namespace tessera::vis
