#include "volume/bricks/brick_layout.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <queue>
#include <tuple>

namespace tessera::volume {

namespace {

constexpr int kNobody = -1;

std::size_t linear(glm::ivec3 at, glm::ivec3 count) {
    return (std::size_t(at.z) * std::size_t(count.y) + std::size_t(at.y)) * std::size_t(count.x) + std::size_t(at.x);
}

template <class Visit> void forBox(glm::ivec3 begin, glm::ivec3 end, Visit&& visit) {
    for (int z = begin.z; z < end.z; ++z)
        for (int y = begin.y; y < end.y; ++y)
            for (int x = begin.x; x < end.x; ++x) visit(glm::ivec3(x, y, z));
}

struct Spread {
    float lo = 2, hi = -1;
    void add(float value) { lo = std::min(lo, value), hi = std::max(hi, value); }
    void add(const Spread& other) { lo = std::min(lo, other.lo), hi = std::max(hi, other.hi); }
    double width() const { return double(hi) - double(lo); }
};

/// The bricks of a grid, and which of them are not yet part of a box.
struct OpenBricks {
    glm::ivec3 count;
    std::span<const float> importance;
    double alike;
    std::vector<std::uint8_t> open;

    OpenBricks(glm::ivec3 grid, std::span<const float> values, const MergeOptions& options)
        : count(grid), importance(values), alike(options.alike), open(values.size()) {
        for (std::size_t i = 0; i < open.size(); ++i) open[i] = double(values[i]) >= options.discardBelow ? 1 : 0;
    }
    /// Adds a box to a spread if all its bricks are open and alike.
    bool join(glm::ivec3 begin, glm::ivec3 end, Spread& spread) const {
        if (glm::any(glm::greaterThan(end, count))) return false;
        Spread all = spread;
        bool whole = true;
        forBox(begin, end, [&](glm::ivec3 at) {
            const std::size_t i = linear(at, count);
            whole = whole && open[i] != 0;
            all.add(importance[i]);
        });
        if (!whole || all.width() > alike) return false;
        spread = all;
        return true;
    }
    void close(glm::ivec3 begin, glm::ivec3 end) {
        forBox(begin, end, [&](glm::ivec3 at) { open[linear(at, count)] = 0; });
    }
};

/// Starts at one corner and grows every box along the axes in turn.
std::vector<MergedBrick> swept(OpenBricks bricks, const MergeOptions& options, std::array<int, 3> order) {
    std::vector<MergedBrick> boxes;
    forBox(glm::ivec3(0), bricks.count, [&](glm::ivec3 begin) {
        if (bricks.open[linear(begin, bricks.count)] == 0) return;
        glm::ivec3 end = begin + 1;
        Spread spread;
        (void)bricks.join(begin, end, spread);
        if (options.shape == MergeShape::Uniform) {
            for (int side = 2; side <= options.mostBricks && bricks.join(begin, begin + side, spread); side *= 2)
                end = begin + side;
        } else {
            for (const int axis : order)
                for (;;) {
                    glm::ivec3 from = begin, to = end;
                    from[axis] = end[axis];
                    ++to[axis];
                    if (to[axis] - begin[axis] > options.mostBricks || !bricks.join(from, to, spread)) break;
                    end = to;
                }
        }
        bricks.close(begin, end);
        boxes.push_back({begin, end, spread.hi});
    });
    return boxes;
}

/// Repeatedly joins the two most similar boxes.
class Joining {
public:
    Joining(const OpenBricks& bricks, const MergeOptions& options)
        : count_(bricks.count), most_(options.mostBricks), alike_(options.alike), owner_(bricks.open.size(), kNobody) {
        forBox(glm::ivec3(0), count_, [&](glm::ivec3 at) {
            const std::size_t i = linear(at, count_);
            if (bricks.open[i] == 0) return;
            owner_[i] = int(boxes_.size());
            Box box{at, at + 1, {}, true};
            box.spread.add(bricks.importance[i]);
            boxes_.push_back(box);
        });
        for (int box = 0; box < int(boxes_.size()); ++box) offer(box);
    }

    std::vector<MergedBrick> run() {
        while (!pairs_.empty()) {
            const Pair pair = pairs_.top();
            pairs_.pop();
            if (boxes_[std::size_t(pair.a)].whole && boxes_[std::size_t(pair.b)].whole) join(pair.a, pair.b);
        }
        std::vector<MergedBrick> out;
        for (const Box& box : boxes_)
            if (box.whole) out.push_back({box.begin, box.end, box.spread.hi});
        return out;
    }

private:
    struct Box {
        glm::ivec3 begin, end;
        Spread spread;
        bool whole; ///< not yet merged into another box
    };
    struct Pair {
        double width;
        int bricks, a, b;
        /// Order of pairs: the most similar first, then the largest, then the first.
        bool operator<(const Pair& other) const {
            return std::tuple(-width, bricks, -a, -b) < std::tuple(-other.width, other.bricks, -other.a, -other.b);
        }
    };

    /// The pairs a box makes with neighbours that share a whole face with it.
    void offer(int number) {
        const Box box = boxes_[std::size_t(number)];
        for (int axis = 0; axis < 3; ++axis)
            for (const bool above : {false, true}) {
                glm::ivec3 at = box.begin;
                at[axis] = above ? box.end[axis] : box.begin[axis] - 1;
                if (at[axis] < 0 || at[axis] >= count_[axis]) continue;
                const int other = owner_[linear(at, count_)];
                if (other == kNobody) continue;
                const Box& near = boxes_[std::size_t(other)];
                bool face = near.end[axis] - near.begin[axis] + box.end[axis] - box.begin[axis] <= most_;
                for (int side = 0; side < 3; ++side)
                    face = face &&
                           (side == axis || (near.begin[side] == box.begin[side] && near.end[side] == box.end[side]));
                Spread both = box.spread;
                both.add(near.spread);
                if (!face || both.width() > alike_) continue;
                const glm::ivec3 size = glm::max(box.end, near.end) - glm::min(box.begin, near.begin);
                pairs_.push({both.width(), size.x * size.y * size.z, std::min(number, other), std::max(number, other)});
            }
    }

    void join(int a, int b) {
        Box &one = boxes_[std::size_t(a)], &two = boxes_[std::size_t(b)];
        one.whole = two.whole = false;
        Box box{glm::min(one.begin, two.begin), glm::max(one.end, two.end), one.spread, true};
        box.spread.add(two.spread);
        const int number = int(boxes_.size());
        boxes_.push_back(box);
        forBox(box.begin, box.end, [&](glm::ivec3 at) { owner_[linear(at, count_)] = number; });
        offer(number);
    }

    glm::ivec3 count_;
    int most_;
    double alike_;
    std::vector<int> owner_;
    std::vector<Box> boxes_;
    std::priority_queue<Pair> pairs_;
};

} // namespace

std::vector<MergedBrick> mergeBricks(glm::ivec3 count, std::span<const float> importance, const MergeOptions& options) {
    assert(importance.size() == std::size_t(count.x) * std::size_t(count.y) * std::size_t(count.z));
    const OpenBricks bricks(count, importance, options);
    std::vector<MergedBrick> best = swept(bricks, options, {0, 1, 2});
    if (options.shape == MergeShape::Best) {
        const auto consider = [&](std::vector<MergedBrick> boxes) {
            if (boxes.size() < best.size()) best = std::move(boxes);
        };
        for (const std::array<int, 3>& order :
             {std::array{0, 2, 1}, std::array{1, 0, 2}, std::array{1, 2, 0}, std::array{2, 0, 1}, std::array{2, 1, 0}})
            consider(swept(bricks, options, order));
        consider(Joining(bricks, options).run());
    }
    std::sort(best.begin(), best.end(), [&](const MergedBrick& a, const MergedBrick& b) {
        return linear(a.begin, count) < linear(b.begin, count);
    });
    return best;
}

std::vector<float> mostImportant(const BrickSource& source) {
    const glm::ivec3 count = source.grid().count();
    std::vector<float> most;
    const auto channels = source.info().channels();
    forBox(glm::ivec3(0), count, [&](glm::ivec3 brick) {
        float largest = 0;
        for (std::size_t channel = 0; channel < channels.size(); ++channel) {
            if (channels[channel].magnitude) continue;
            for (std::size_t time = 0; time < source.info().times.size(); ++time) {
                const auto importance = source.importance({int(channel), int(time), 0, brick});
                largest = std::max(largest, importance ? importance->largest() : 1.0f);
            }
        }
        most.push_back(largest);
    });
    return most;
}

} // namespace tessera::volume
