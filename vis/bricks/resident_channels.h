#pragma once

#include "vis/bricks/atlas_pool.h"
#include "vis/bricks/resident_channel.h"
#include "vis/bricks/unchanged_bricks.h"

namespace tessera::vis {

/// What is on the GPU of one data set: the channels that views asked for and the atlases of their bricks; who gives way
/// where there is no more room, and who shows the texels of another time.
class ResidentChannels {
public:
    using Map = std::map<ChannelKey, ResidentChannel>;

    /// `say` takes messages.
    ResidentChannels(const RendererOptions& options, const Driver& driver, std::function<void(const std::string&)> say);

    /// Drops everything; what comes has this grid.
    void clear(const volume::BrickGrid& grid);
    /// Bytes of textures. A smaller atlas, or a larger one where bricks had no room, is filled anew: then all channels
    /// in bricks are dropped.
    void setBudget(std::size_t bytes);
    std::size_t budget() const { return budget_; }
    /// Bytes of all textures.
    std::size_t bytes() const;
    /// Throws MachineError where the driver has no memory for so many bytes more.
    void reserve(std::size_t bytes) const;

    Map& all() { return channels_; }
    const Map& all() const { return channels_; }
    /// A channel; null where nobody asked for it.
    ResidentChannel* find(const ChannelKey& key);
    const ResidentChannel* find(const ChannelKey& key) const;
    void drop(const ChannelKey& key);
    /// Drops whole channels that no view wanted lately, the oldest first, while there is too much.
    void evict(std::uint64_t frame);
    /// Drops whole channels that are not wanted in this frame, but for one; false where there were none.
    bool dropUnused(std::uint64_t frame, const ChannelKey& but);
    /// Counts what was dropped.
    std::uint64_t drops() const { return drops_; }

    /// Where a channel's bricks go. Throws MachineError when the driver has no memory for an atlas.
    BrickAtlas& atlasFor(int components) { return atlases_.atlasFor(components); }
    /// Who gives way in a frame; `beyond`: the budget may be exceeded.
    struct Moment {
        std::uint64_t frame = 0;
        bool beyond = false;
        /// What was wanted before this frame may leave.
        std::uint64_t since() const { return beyond ? frame : frame > kFramesInUse ? frame - kFramesInUse : 0; }
    };
    /// A free slot of a channel's atlas for a brick of that priority, made free if need be; nullopt: the atlas is full.
    std::optional<glm::ivec3> slotFor(ChannelTexture& channel, float priority, const Moment& moment);

    /// Shows a channel, or a brick of one, with the texels of another time, if there are any that will do. `level`: the
    /// coarsest that a whole channel may have.
    bool reuseWhole(const ChannelKey& key, ResidentChannel& channel, const Unchanged& unchanged, int level) const;
    bool reuseBrick(const ChannelKey& key, ResidentChannel& channel, const BrickId& id,
                    const Unchanged& unchanged) const;
    /// How another part of the channel is encoded, if one is here: all are alike.
    std::optional<TexelEncoding> encodingOfParts(const ChannelKey& key) const;

private:
    void clearAtlases();
    bool makeRoom(const ChannelTexture& channel, float priority, const Moment& moment);
    bool dropOldest(const ChannelTexture& channel, std::uint64_t since);
    void findCandidates(const BrickAtlas* atlas, const Moment& moment);
    bool grow(const BrickAtlas* atlas, bool beyond);

    std::size_t budget_, driverMemory_;
    volume::BrickGrid grid_;
    AtlasPool atlases_; ///< outlives the channels
    Map channels_;
    std::uint64_t drops_ = 0;
    /// Bricks that could make room in an atlas, the first to go last, as they are in a frame.
    struct Candidate {
        ChannelKey key;
        BrickLevels::Guest brick;
    };
    struct Candidates {
        const BrickAtlas* of = nullptr;
        std::uint64_t frame = 0;
        std::vector<Candidate> bricks;
    };
    Candidates candidates_;
};

} // namespace tessera::vis
