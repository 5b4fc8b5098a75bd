#pragma once

#include "vis/bricks/brick_atlas.h"
#include "vis/bricks/brick_demand.h"
#include "vis/bricks/channel_load.h"

namespace tessera::vis {

/// A brick in an atlas: `brickSize` texels a side at level l, so it covers 2^l bricks of full resolution along each
/// axis.
struct BrickId {
    int level = 0;
    glm::ivec3 index{0};
};

/// Residency of the bricks of one channel at all levels, and its page table: every place shows the finest resident
/// brick. The coarsest level is loaded first and never evicted, so there are no holes.
class BrickLevels {
public:
    BrickLevels(const volume::BrickGrid& grid, const ChannelSummary& summary, const TexelEncoding& encoding);

    /// Sets what a view needs now; null: the coarsest level. Replaces the previous demand. At equal distance, more
    /// important bricks are more urgent.
    void want(const BrickDemand* demand, std::uint64_t frame);
    /// Number of wanted bricks that are not resident.
    int missing() const { return missing_; }
    /// The most urgent wanted bricks that have not been requested, at most `count`; marks them as requested.
    std::vector<BrickId> ask(std::size_t count);
    /// Cancels the request of a brick, so that it can be requested again.
    void forget(const BrickId& id);
    /// Cancels all requests.
    void forgetAsked();

    /// Whether a brick is part of the channel and not resident.
    bool lacks(const BrickId& id) const { return at(id).state == State::Away || at(id).state == State::Asked; }
    bool holds(const BrickId& id) const { return at(id).state == State::Here; }
    void put(const BrickId& id, glm::ivec3 slot, const BlockRanges& blocks, int time);
    /// Shares the texels of a brick with another time of the channel where it is resident.
    void putFrom(const BrickId& id, const BrickLevels& other);
    /// The time from which the texels of a resident brick were made.
    int time(const BrickId& id) const { return at(id).time; }
    glm::ivec3 slot(const BrickId& id) const { return at(id).slot; }
    /// Evicts a brick and returns its slot; a coarser brick is shown instead.
    glm::ivec3 take(const BrickId& id);
    /// An eviction candidate: `stale` if no view wanted it since `frame`.
    struct Guest {
        BrickId id;
        bool stale = false;
        std::uint64_t wanted = 0;
        float priority = 0;
    };
    std::vector<Guest> guests(std::uint64_t frame) const;
    /// Bricks of full resolution that were hidden in a view since `frame`, and seen in none.
    int hidden(std::uint64_t since) const;
    float priority(const BrickId& id) const { return at(id).priority; }
    /// Of bricks of full resolution, 0..1; empty: not known.
    const std::vector<float>& importance() const { return importance_; }
    /// Every resident slot, to release or to move.
    template <class Function> void eachSlot(Function&& change) {
        for (Level& level : levels_)
            for (Brick& brick : level.bricks)
                if (brick.state == State::Here) change(brick.slot);
    }
    /// After slots moved.
    void resolveAll();

    /// Whether the coarsest level is complete, so that the channel can be drawn.
    bool drawable() const { return coarsestMissing_ == 0; }
    int resident() const { return resident_; }
    /// The page table with every change in it.
    GLuint pageTexture();
    /// Ranges of blocks of cells at full resolution, of what is shown.
    const BlockRanges& blocks() const { return blocks_; }
    /// Ranges of whole bricks, known before anything is decoded.
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
    /// The last frames in which a brick of full resolution was hidden in a view, and visible in one.
    struct Sight {
        std::uint64_t hidden = 0, seen = 0;
    };
    std::vector<Sight> sight_;
    std::vector<float> importance_; ///< of bricks of full resolution; empty: not known
    std::vector<BrickId> pending_;  ///< wanted and away
    std::uint64_t call_ = 0;
    int missing_ = 0, coarsestMissing_ = 0, resident_ = 0;
    PageTable pages_;
    bool pagesChanged_ = true;
    BlockRanges blocks_, brickRanges_;
    int blocksPerBrick_ = 1;
};

/// The grid that block ranges of every channel are given on: edge 8 at full resolution, more where that would be more
/// than a quarter of a million blocks.
BlockRanges blockGrid(const volume::BrickGrid& grid);
/// Ranges of a coarser level on the grid of full resolution: each block takes those of every block it may touch.
BlockRanges onBlockGrid(const volume::BrickGrid& grid, const BlockRanges& coarse);

} // namespace tessera::vis
