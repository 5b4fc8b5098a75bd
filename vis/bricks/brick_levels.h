#pragma once

#include "vis/bricks/brick_atlas.h"
#include "vis/bricks/brick_demand.h"
#include "vis/bricks/channel_load.h"

namespace tessera::vis {

/// A brick in an atlas: `brickSize` texels a side at level l, hence the extent of 2^l full-resolution bricks along each
/// axis.
struct BrickId {
    int level = 0;
    glm::ivec3 index{0};
};

/// Residency of the bricks of one channel at all levels, and its page table. Every position is drawn from the finest
/// resident brick. The coarsest level is loaded first and never evicted, so there are no holes.
class BrickLevels {
public:
    BrickLevels(const volume::BrickGrid& grid, const ChannelSummary& summary, const TexelEncoding& encoding);

    /// Replaces the demand of a view; null: the coarsest level. Among bricks at the same distance, more important ones
    /// are more urgent.
    void want(const BrickDemand* demand, std::uint64_t frame);
    /// Number of wanted bricks that are not resident.
    int missing() const { return missing_; }
    /// The most urgent wanted bricks that have not been requested, at most `count`; marks them as requested.
    std::vector<BrickId> ask(std::size_t count);
    /// Cancels the request of a brick, so that it can be requested again.
    void forget(const BrickId& id);
    /// Cancels all requests.
    void forgetAsked();

    /// Whether a brick belongs to the channel and is not resident.
    bool lacks(const BrickId& id) const { return at(id).state == State::Away || at(id).state == State::Asked; }
    bool holds(const BrickId& id) const { return at(id).state == State::Here; }
    void put(const BrickId& id, glm::ivec3 slot, const BlockRanges& blocks, int time);
    /// Shares the texels of a brick that is resident for another time of the channel.
    void putFrom(const BrickId& id, const BrickLevels& other);
    /// The time whose texels a resident brick shows.
    int time(const BrickId& id) const { return at(id).time; }
    glm::ivec3 slot(const BrickId& id) const { return at(id).slot; }
    /// Evicts a brick and returns its slot; the next coarser resident brick is drawn instead.
    glm::ivec3 take(const BrickId& id);
    /// An eviction candidate: `stale` if no view wanted it since `frame`.
    struct EvictionCandidate {
        BrickId id;
        bool stale = false;
        std::uint64_t wanted = 0;
        float priority = 0;
    };
    std::vector<EvictionCandidate> evictionCandidates(std::uint64_t frame) const;
    /// Number of full-resolution bricks that were occluded in some view since `frame` and visible in none.
    int hidden(std::uint64_t since) const;
    float priority(const BrickId& id) const { return at(id).priority; }
    /// Importance per full-resolution brick, 0..1; empty: unknown.
    const std::vector<float>& importance() const { return importance_; }
    /// Calls `change` for every resident slot, to release or move it.
    template <class Function> void eachSlot(Function&& change) {
        for (Level& level : levels_)
            for (Brick& brick : level.bricks)
                if (brick.state == State::Here) change(brick.slot);
    }
    /// Rebuilds the page table after slots were moved.
    void resolveAll();

    /// Whether the coarsest level is complete, so that the channel can be drawn.
    bool drawable() const { return coarsestMissing_ == 0; }
    int resident() const { return resident_; }
    /// The page table, with all changes uploaded.
    GLuint pageTexture();
    /// Value ranges of the full-resolution blocks, from the bricks drawn.
    const BlockRanges& blocks() const { return blocks_; }
    /// Value ranges of whole bricks, known before decoding.
    const BlockRanges& brickRanges() const { return brickRanges_; }

private:
    enum class State : std::uint8_t { Away, Asked, Here, Absent };
    struct Brick {
        State state = State::Away;
        glm::ivec3 slot{0};
        float priority = 0;
        std::uint64_t wanted = 0, call = 0;
        int time = 0;
    };
    struct Level {
        glm::ivec3 count{0};
        std::vector<Brick> bricks;
    };
    std::size_t place(const BrickId& id) const;
    Brick& at(const BrickId& id) { return levels_[std::size_t(id.level)].bricks[place(id)]; }
    const Brick& at(const BrickId& id) const { return levels_[std::size_t(id.level)].bricks[place(id)]; }
    void demand(const BrickId& id, float priority, std::uint64_t frame);
    void arrive(const BrickId& id, glm::ivec3 slot, int time);
    void resolve(const BrickId& covered);
    void resolveFine(glm::ivec3 brick);
    void setBlocks(glm::ivec3 brick, const BlockRanges* from);

    volume::BrickGrid grid_;
    std::vector<Level> levels_;
    /// The last frames in which a full-resolution brick was occluded in some view, and visible in some view.
    struct Sight {
        std::uint64_t hidden = 0, seen = 0;
    };
    std::vector<Sight> sight_;
    std::vector<float> importance_; ///< per full-resolution brick; empty: unknown
    std::vector<BrickId> pending_;  ///< wanted, not resident
    std::uint64_t call_ = 0;
    int missing_ = 0, coarsestMissing_ = 0, resident_ = 0;
    PageTable pages_;
    bool pagesChanged_ = true;
    BlockRanges blocks_, brickRanges_;
    int blocksPerBrick_ = 1;
};

/// The grid of the block ranges of all channels: blocks of 8 cells at full resolution, larger if there would be more
/// than a quarter of a million.
BlockRanges blockGrid(const volume::BrickGrid& grid);
/// Maps ranges of a coarser level to the full-resolution grid: each block takes the union of the coarse blocks it may
/// touch.
BlockRanges onBlockGrid(const volume::BrickGrid& grid, const BlockRanges& coarse);

} // namespace tessera::vis
