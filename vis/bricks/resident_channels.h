#pragma once

#include "vis/bricks/atlas_pool.h"
#include "vis/bricks/resident_channel.h"
#include "vis/bricks/unchanged_bricks.h"

namespace tessera::vis {

/// The resident channels of one data set and the atlases of their bricks; decides what is evicted and which texels are
/// shared between times.
class ResidentChannels {
public:
    using Map = std::map<ChannelKey, ResidentChannel>;

    /// `say` receives messages.
    ResidentChannels(const RendererOptions& options, const Driver& driver, std::function<void(const std::string&)> say);

    /// Drops everything; later channels have this grid.
    void clear(const volume::BrickGrid& grid);
    /// Sets the texture budget in bytes. If an atlas must shrink, or can grow because bricks had no room, all bricked
    /// channels are dropped and loaded again.
    void setBudget(std::size_t bytes);
    std::size_t budget() const { return budget_; }
    /// Bytes of all textures.
    std::size_t bytes() const;
    /// Throws MachineError if the driver has no memory for that many more bytes.
    void reserve(std::size_t bytes) const;

    Map& all() { return channels_; }
    const Map& all() const { return channels_; }
    /// Finds a channel; null if it was never requested.
    ResidentChannel* find(const ChannelKey& key);
    const ResidentChannel* find(const ChannelKey& key) const;
    void drop(const ChannelKey& key);
    /// Drops whole channels that no view wanted lately, the oldest first, until the budget is met.
    void evict(std::uint64_t frame);
    /// Drops whole channels that are not wanted in this frame, except one; false if there were none.
    bool dropUnused(std::uint64_t frame, const ChannelKey& but);
    /// Number of drops so far.
    std::uint64_t drops() const { return drops_; }

    /// The atlas for a channel's bricks. Throws MachineError if the driver has no memory for one.
    BrickAtlas& atlasFor(int components) { return atlases_.atlasFor(components); }
    /// Eviction rules of a frame; `beyond`: the budget may be exceeded.
    struct Moment {
        std::uint64_t frame = 0;
        bool beyond = false;
        /// Whatever was last wanted before this frame may be evicted.
        std::uint64_t since() const { return beyond ? frame : frame > kFramesInUse ? frame - kFramesInUse : 0; }
    };
    /// A free slot of a channel's atlas for a brick of that priority, by eviction if necessary; nullopt: the atlas is
    /// full.
    std::optional<glm::ivec3> slotFor(ChannelTexture& channel, float priority, const Moment& moment);

    /// Reuses the texels of another time for a channel, or for a brick of one, if they changed little enough. `level`:
    /// the coarsest level accepted for a whole channel.
    bool reuseWhole(const ChannelKey& key, ResidentChannel& channel, const Unchanged& unchanged, int level) const;
    bool reuseBrick(const ChannelKey& key, ResidentChannel& channel, const BrickId& id,
                    const Unchanged& unchanged) const;
    /// The encoding of another resident part of the channel, if any; all parts have the same one.
    std::optional<TexelEncoding> encodingOfParts(const ChannelKey& key) const;

private:
    void clearAtlases();
    bool makeRoom(const ChannelTexture& channel, float priority, const Moment& moment);
    bool dropOldest(const ChannelTexture& channel, std::uint64_t since);
    void findCandidates(const BrickAtlas* atlas, const Moment& moment);
    bool grow(const BrickAtlas* atlas, bool beyond);

    std::size_t budget_, driverMemory_;
    volume::BrickGrid grid_;
    AtlasPool atlases_; ///< destroyed after the channels
    Map channels_;
    std::uint64_t drops_ = 0;
    /// Eviction candidates of an atlas in one frame; the first to be evicted comes last.
    struct Candidate {
        ChannelKey key;
        BrickLevels::EvictionCandidate brick;
    };
    struct Candidates {
        const BrickAtlas* of = nullptr;
        std::uint64_t frame = 0;
        std::vector<Candidate> bricks;
    };
    Candidates candidates_;
};

} // namespace tessera::vis
