#pragma once

#include "vis/bricks/brick_atlas.h"
#include "vis/bricks/brick_demand.h"
#include "vis/bricks/channel_load.h"

namespace tessera::vis {

/// A brick of an atlas: at level l, `brickSize` texels of that level a side, so it stands for 2^l bricks of full
/// resolution along each axis.
struct BrickId {
    int level = 0;
    glm::ivec3 index{0};
};

/// Which bricks of one channel are resident, at which levels, and what the shader sees of them: every place shows the
/// finest brick that is here. The coarsest level comes first and never leaves, so there is no hole.
class BrickLevels {
public:
    BrickLevels(const volume::BrickGrid& grid, const ChannelSummary& summary, const TexelEncoding& encoding);

    /// Says what a view needs now; null: the coarsest level. Replaces what was said before. Of bricks equally near
    /// those with more to show are more urgent.
    void want(const BrickDemand* demand, std::uint64_t frame);
    /// Wanted bricks that are not here.
    int missing() const { return missing_; }
    /// The most urgent of them that nobody has asked for, at most `count`; they count as asked for.
    std::vector<BrickId> ask(std::size_t count);
    /// A brick that was asked for will not come: it may be asked for again.
    void forget(const BrickId& id);
    /// The same of all that were asked for.
    void forgetAsked();

    /// Whether a brick belongs here and is not here.
    bool lacks(const BrickId& id) const { return at(id).state == State::Away || at(id).state == State::Asked; }
    bool holds(const BrickId& id) const { return at(id).state == State::Here; }
    void put(const BrickId& id, glm::ivec3 slot, const BlockRanges& blocks, int time);
    /// Shows what another time of the channel shows of a brick that is here there.
    void putFrom(const BrickId& id, const BrickLevels& other);
    /// The time that the texels of a brick here were made of.
    int time(const BrickId& id) const { return at(id).time; }
    glm::ivec3 slot(const BrickId& id) const { return at(id).slot; }
    /// Takes a brick away and gives its slot; a coarser one shows in its place.
    glm::ivec3 take(const BrickId& id);
    /// A brick that could make room: `stale` if no view wanted it since `frame`.
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

    /// The coarsest level is complete: something shows everywhere.
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
    /// The last frames in which a brick of full resolution was hidden in a view, and seen in one.
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
