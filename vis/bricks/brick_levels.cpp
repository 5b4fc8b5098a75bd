#include "vis/bricks/brick_levels.h"

#include <algorithm>
#include <limits>

namespace tessera::vis {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kPlain =
    1.5f; ///< distance factor of a brick of importance 0; the factor of the most important ones is 1 less
constexpr std::size_t kMostBlocks = std::size_t(1) << 18;

std::size_t volumeOf(glm::ivec3 size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

std::size_t linear(glm::ivec3 at, glm::ivec3 count) {
    return (std::size_t(at.z) * std::size_t(count.y) + std::size_t(at.y)) * std::size_t(count.x) + std::size_t(at.x);
}

template <class Function> void eachIndex(glm::ivec3 begin, glm::ivec3 end, Function&& function) {
    for (int z = begin.z; z < end.z; ++z)
        for (int y = begin.y; y < end.y; ++y)
            for (int x = begin.x; x < end.x; ++x) function(glm::ivec3(x, y, z));
}

/// Value ranges of bricks including their neighbours, in texel units, widened by the overshoot of the prefilter.
BlockRanges rangesOfBricks(const volume::BrickGrid& grid, const ChannelSummary& summary,
                           const TexelEncoding& encoding) {
    BlockRanges out;
    out.count = grid.count();
    out.edge = grid.brickSize;
    const double overshoot = volume::prefilterOvershoot(encoding.prefilter);
    eachIndex(glm::ivec3(0), out.count, [&](glm::ivec3 brick) {
        double min = kInfinity, max = -min;
        eachIndex(glm::max(brick - 1, glm::ivec3(0)), glm::min(brick + 2, out.count), [&](glm::ivec3 near) {
            const volume::BrickStats& stats = summary.bricks[linear(near, out.count)];
            if (stats.presentFraction <= 0) return;
            min = std::min(min, double(stats.min));
            max = std::max(max, double(stats.max));
        });
        const double margin = (max - min) * overshoot;
        const auto texel = [&](double value) { return float((value - encoding.offset) / encoding.scale); };
        out.min.push_back(min <= max ? texel(min - margin) : kInfinity);
        out.max.push_back(min <= max ? texel(max + margin) : -kInfinity);
    });
    return out;
}

} // namespace

BlockRanges blockGrid(const volume::BrickGrid& grid) {
    BlockRanges blocks;
    const glm::ivec3 texels = levelTexels(grid, 0);
    blocks.edge = std::min(kBlockTexels, grid.brickSize);
    const auto count = [&] { return (texels + blocks.edge - 1) / blocks.edge; };
    while (volumeOf(count()) > kMostBlocks && blocks.edge < grid.brickSize) blocks.edge *= 2;
    blocks.count = count();
    blocks.min.assign(volumeOf(blocks.count), kInfinity);
    blocks.max.assign(volumeOf(blocks.count), -kInfinity);
    return blocks;
}

BlockRanges onBlockGrid(const volume::BrickGrid& grid, const BlockRanges& coarse) {
    BlockRanges out = blockGrid(grid);
    const double edge = double(coarse.edge) * (1 << coarse.level), phase = grid.levelPhase(coarse.level);
    // Interpolation of coarse samples reads one coarse texel beyond a block; the range of a coarse block already
    // includes it.
    eachIndex(glm::ivec3(0), out.count, [&](glm::ivec3 block) {
        const glm::dvec3 lo = (glm::dvec3(block * out.edge) - phase) / edge,
                         hi = (glm::dvec3((block + 1) * out.edge) - phase) / edge;
        const glm::ivec3 last = coarse.count - 1;
        const std::size_t to = linear(block, out.count);
        eachIndex(glm::clamp(glm::ivec3(glm::floor(lo)), glm::ivec3(0), last),
                  glm::clamp(glm::ivec3(glm::floor(hi)), glm::ivec3(0), last) + 1, [&](glm::ivec3 from) {
                      const std::size_t i = linear(from, coarse.count);
                      out.min[to] = std::min(out.min[to], coarse.min[i]);
                      out.max[to] = std::max(out.max[to], coarse.max[i]);
                  });
    });
    return out;
}

BrickLevels::BrickLevels(const volume::BrickGrid& grid, const ChannelSummary& summary, const TexelEncoding& encoding)
    : grid_(grid), importance_(summary.importance), pages_(grid.count()), blocks_(blockGrid(grid)),
      brickRanges_(rangesOfBricks(grid, summary, encoding)), blocksPerBrick_(grid.brickSize / blocks_.edge) {
    for (int level = 0; level < grid.levels; ++level) {
        Level& made = levels_.emplace_back();
        made.count = (levelTexels(grid, level) + grid.brickSize - 1) / grid.brickSize;
        made.bricks.resize(volumeOf(made.count), {State::Absent});
    }
    sight_.resize(volumeOf(grid.count()));
    // A brick is absent if neither it nor any neighbour has a present sample.
    eachIndex(glm::ivec3(0), grid.count(), [&](glm::ivec3 brick) {
        const std::size_t i = linear(brick, grid.count());
        if (brickRanges_.min[i] <= brickRanges_.max[i])
            for (int level = 0; level < grid.levels; ++level) at({level, brick >> level}).state = State::Away;
    });
    for (const Brick& brick : levels_.back().bricks) coarsestMissing_ += brick.state == State::Away;
    resolveAll();
}

std::size_t BrickLevels::place(const BrickId& id) const {
    return linear(id.index, levels_[std::size_t(id.level)].count);
}

void BrickLevels::demand(const BrickId& id, float priority, std::uint64_t frame) {
    Brick& brick = at(id);
    if (brick.state == State::Absent) return;
    const bool first = brick.call != call_;
    brick.priority = first && brick.wanted != frame ? priority : std::min(brick.priority, priority);
    brick.wanted = frame;
    brick.call = call_;
    if (!first || brick.state == State::Here) return;
    ++missing_;
    if (brick.state == State::Away) pending_.push_back(id);
}

void BrickLevels::want(const BrickDemand* wanted, std::uint64_t frame) {
    ++call_;
    missing_ = 0;
    pending_.clear();
    const int coarsest = grid_.levels - 1;
    if (coarsestMissing_ > 0)
        eachIndex(glm::ivec3(0), levels_.back().count, [&](glm::ivec3 index) {
            demand({coarsest, index}, -1e6f, frame);
        });
    if (!wanted) return;
    std::size_t i = 0;
    eachIndex(glm::ivec3(0), grid_.count(), [&](glm::ivec3 brick) {
        const int level = wanted->level[i];
        if (wanted->hidden[i] != 0)
            sight_[i].hidden = frame;
        else if (level != BrickDemand::kNotWanted)
            sight_[i].seen = frame;
        float priority = wanted->priority[i];
        if (!importance_.empty() && priority > 0) priority *= kPlain - importance_[i];
        ++i;
        if (level == BrickDemand::kNotWanted || pages_.pages[i - 1].w == PageTable::kAbsent) return;
        demand({level, brick >> level}, priority, frame);
    });
}

int BrickLevels::hidden(std::uint64_t since) const {
    return int(std::ranges::count_if(sight_, [&](const Sight& at) { return at.hidden >= since && at.seen < since; }));
}

std::vector<BrickId> BrickLevels::ask(std::size_t count) {
    count = std::min(count, pending_.size());
    std::partial_sort(pending_.begin(), pending_.begin() + std::ptrdiff_t(count), pending_.end(),
                      [&](const BrickId& a, const BrickId& b) { return at(a).priority < at(b).priority; });
    std::vector<BrickId> asked(pending_.begin(), pending_.begin() + std::ptrdiff_t(count));
    pending_.erase(pending_.begin(), pending_.begin() + std::ptrdiff_t(count));
    for (const BrickId& id : asked) at(id).state = State::Asked;
    return asked;
}

void BrickLevels::forget(const BrickId& id) {
    if (at(id).state == State::Asked) at(id).state = State::Away;
}

void BrickLevels::forgetAsked() {
    for (Level& level : levels_)
        for (Brick& brick : level.bricks)
            if (brick.state == State::Asked) brick.state = State::Away;
}

void BrickLevels::arrive(const BrickId& id, glm::ivec3 slot, int time) {
    Brick& brick = at(id);
    brick.state = State::Here;
    brick.slot = slot;
    brick.time = time;
    ++resident_;
    if (brick.call == call_) missing_ = std::max(0, missing_ - 1);
    if (id.level == grid_.levels - 1) --coarsestMissing_;
    resolve(id);
}

void BrickLevels::put(const BrickId& id, glm::ivec3 slot, const BlockRanges& blocks, int time) {
    arrive(id, slot, time);
    if (id.level == 0) setBlocks(id.index, &blocks);
}

void BrickLevels::putFrom(const BrickId& id, const BrickLevels& other) {
    arrive(id, other.slot(id), other.time(id));
    if (id.level != 0) return;
    const glm::ivec3 first = id.index * blocksPerBrick_;
    eachIndex(first, glm::min(first + blocksPerBrick_, blocks_.count), [&](glm::ivec3 block) {
        const std::size_t i = linear(block, blocks_.count);
        blocks_.min[i] = other.blocks_.min[i];
        blocks_.max[i] = other.blocks_.max[i];
    });
}

glm::ivec3 BrickLevels::take(const BrickId& id) {
    Brick& brick = at(id);
    brick.state = State::Away;
    --resident_;
    if (brick.call == call_) ++missing_;
    if (id.level == grid_.levels - 1) ++coarsestMissing_;
    resolve(id);
    if (id.level == 0) setBlocks(id.index, nullptr);
    return brick.slot;
}

std::vector<BrickLevels::EvictionCandidate> BrickLevels::evictionCandidates(std::uint64_t frame) const {
    std::vector<EvictionCandidate> out;
    for (int level = 0; level + 1 < grid_.levels; ++level) {
        const Level& from = levels_[std::size_t(level)];
        eachIndex(glm::ivec3(0), from.count, [&](glm::ivec3 index) {
            const Brick& brick = from.bricks[linear(index, from.count)];
            if (brick.state == State::Here)
                out.push_back({{level, index}, brick.wanted < frame, brick.wanted, brick.priority});
        });
    }
    return out;
}

/// Updates the pages of all full-resolution bricks within `covered`.
void BrickLevels::resolve(const BrickId& covered) {
    const glm::ivec3 first = covered.index << covered.level;
    eachIndex(first, glm::min(first + (1 << covered.level), grid_.count()),
              [&](glm::ivec3 brick) { resolveFine(brick); });
}

void BrickLevels::resolveAll() {
    eachIndex(glm::ivec3(0), grid_.count(), [&](glm::ivec3 brick) {
        resolveFine(brick);
        if (pages_.pages[linear(brick, grid_.count())].w != 0) setBlocks(brick, nullptr);
    });
}

void BrickLevels::resolveFine(glm::ivec3 brick) {
    glm::u16vec4& page = pages_.pages[linear(brick, grid_.count())];
    page = {0, 0, 0, PageTable::kAbsent};
    const std::size_t i = linear(brick, grid_.count());
    pagesChanged_ = true;
    if (!(brickRanges_.min[i] <= brickRanges_.max[i])) return;
    page.w = PageTable::kNowhere;
    for (int level = 0; level < grid_.levels; ++level) {
        const BrickId id{level, brick >> level};
        const Brick& found = at(id);
        if (found.state != State::Here) continue;
        // First texel of the fine brick within the coarse one.
        const glm::ivec3 inside = (brick - (id.index << level)) * (grid_.brickSize >> level);
        page = glm::u16vec4(found.slot + inside, level);
        return;
    }
}

/// Sets the block ranges of one brick: from its texels, or, if it has none, from the statistics known before decoding.
void BrickLevels::setBlocks(glm::ivec3 brick, const BlockRanges* from) {
    const std::size_t whole = linear(brick, grid_.count());
    const glm::ivec3 first = brick * blocksPerBrick_;
    eachIndex(first, glm::min(first + blocksPerBrick_, blocks_.count), [&](glm::ivec3 block) {
        float min = from ? kInfinity : brickRanges_.min[whole], max = from ? -kInfinity : brickRanges_.max[whole];
        if (from) {
            const glm::ivec3 lo = (block - first) * blocks_.edge / from->edge,
                             hi = ((block - first + 1) * blocks_.edge - 1) / from->edge + 1;
            eachIndex(lo, glm::min(hi, from->count), [&](glm::ivec3 part) {
                min = std::min(min, from->min[linear(part, from->count)]);
                max = std::max(max, from->max[linear(part, from->count)]);
            });
        }
        blocks_.min[linear(block, blocks_.count)] = min;
        blocks_.max[linear(block, blocks_.count)] = max;
    });
}

GLuint BrickLevels::pageTexture() {
    if (pagesChanged_) pages_.upload();
    pagesChanged_ = false;
    return pages_.texture.name();
}

} // namespace tessera::vis
