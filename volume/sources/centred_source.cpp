#include "volume/sources/centred_source.h"

#include "volume/base/error.h"
#include "volume/base/load_once.h"
#include "volume/bricks/brick_cache.h"
#include "volume/bricks/magnitude.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/field/part_masks.h"
#include "volume/sources/centred_samples.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace tessera::volume {

namespace {

/// The grid of the source and the body-centred one at a level.
CentredLevel levelOf(const BrickGrid& source, const BrickGrid& centred, int level) {
    CentredLevel out = finestCentred(source.lattice);
    out.finest = level == 0;
    const double step = double(1 << level);
    const glm::ivec3 grid = source.levelSamples(level);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out.grid[axis] = {source.levelPhase(level), step, grid[int(axis)]};
        for (int s = 0; s < 2; ++s) {
            LevelAxis& own = out.sublattices[std::size_t(s)][axis];
            own.first += own.step * centred.levelPhase(level);
            own.step *= step;
            own.count = (own.count + (1 << level) - 1) >> level;
        }
    }
    return out;
}

/// As many levels as the source has and as volume/sources/memory_source.h would make.
BrickGrid centredGrid(const BrickGrid& source) {
    constexpr int kCoarsestEdge = 4; // texels
    BrickGrid grid;
    grid.lattice = bccFor(source.lattice);
    grid.brickSize = source.brickSize;
    grid.phase = 0.5;
    const glm::ivec3 texels = grid.lattice.texels();
    const int longest = std::min(std::max({texels.x, texels.y, texels.z}), grid.brickSize);
    grid.levels = 1;
    while (grid.levels < source.levels && (longest >> grid.levels) >= kCoarsestEdge) ++grid.levels;
    return grid;
}

class CentredSource final : public BrickSource {
public:
    CentredSource(std::shared_ptr<const BrickSource> source, std::size_t budget)
        : shown_(source), source_(std::make_shared<BrickCache>(std::move(source), budget / 4)), info_(source_->info()),
          grid_(centredGrid(source_->grid())), channels_(info_.channels()),
          made_(
              budget, [this](const BrickKey& key) { return std::make_shared<const BrickSamples>(make(key)); },
              [](const BrickSamples& brick) { return brick.values.size() * sizeof(float) + brick.present.size(); }) {
        info_.lattice = grid_.lattice;
        for (int level = 0; level < grid_.levels; ++level)
            for (const bool categorical : {false, true})
                levels_[categorical ? 1 : 0].emplace_back(levelOf(source_->grid(), grid_, level), categorical);
        for (const Channel& channel : channels_)
            labels_.push_back(labelChannel(info_, info_.parameters[std::size_t(channel.parameter)]));
    }

    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return grid_; }

    BrickStats stats(const BrickKey& key) const override {
        const bool label = isLabel(key);
        if (isMagnitude(key))
            return magnitudeStats(stats(component(key, 0)), stats(component(key, 1)), stats(component(key, 2)));
        BrickStats out{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), 0};
        double present = 0, bricks = 0;
        bool whole = true;
        forBricks(key, gridOf(key, 0).near(texelsOf(key, 0)), [&](const BrickKey& from) {
            const BrickStats own = source_->stats(from);
            whole = whole && own.presentFraction == 1;
            present += double(own.presentFraction);
            ++bricks;
            if (own.presentFraction <= 0) return;
            out.min = std::min(out.min, own.min);
            out.max = std::max(out.max, own.max);
        });
        // One only where all samples are there; a share too small for a float is not none.
        constexpr float kMost = 1 - std::numeric_limits<float>::epsilon();
        out.presentFraction =
            whole ? 1.0f : std::min(std::max(float(present / bricks), present > 0 ? 1e-30f : 0.0f), kMost);
        if (label || !(out.min < out.max)) return out;
        const double beyond = kCentredHeadroom * (double(out.max) - double(out.min));
        constexpr float kFarthest = std::numeric_limits<float>::max();
        out.min = std::nextafter(float(double(out.min) - beyond), -kFarthest);
        out.max = std::nextafter(float(double(out.max) + beyond), kFarthest);
        return out;
    }

    std::optional<BrickImportance> importance(const BrickKey& key) const override {
        std::optional<BrickImportance> out = BrickImportance{};
        forBricks(key, gridOf(key, 0).near(texelsOf(key, 0)), [&](const BrickKey& from) {
            const std::optional<BrickImportance> own = source_->importance(from);
            if (!own || !out) return out.reset();
            out->importance = std::max(out->importance, own->importance);
            out->detail = std::max(out->detail, own->detail);
        });
        return out;
    }

    /// Nothing where the source has not changed. Of other changes only those of whole parts are bounded: where a part
    /// ends it is continued by formulas that are not linear.
    std::optional<BrickChange> change(const BrickKey& key, int toTime) const override {
        if (isMagnitude(key)) {
            BrickChange changes[3];
            for (int c = 0; c < 3; ++c) {
                const std::optional<BrickChange> own = change(component(key, c), toTime);
                if (!own) return std::nullopt;
                changes[c] = *own;
            }
            return magnitudeChange(changes);
        }
        if (toTime == key.time) return BrickChange{};
        double most = 0;
        bool known = true, mixed = false;
        const std::optional<int> label = labels_[std::size_t(key.channel)];
        forBricks(key, gridOf(key, 0).needed(texelsOf(key, 0), true), [&](const BrickKey& from) {
            const std::optional<BrickChange> own = source_->change(from, toTime);
            known = known && own;
            if (own) most = std::max(most, double(own->max));
            mixed = mixed || source_->stats(from).presentFraction != 1;
            if (!label) return;
            const std::optional<BrickChange> moved = source_->change(labelKey(from, *label), toTime);
            known = known && moved && moved->max == 0;
            const BrickStats regions = source_->stats(labelKey(from, *label));
            mixed = mixed || regions.min != regions.max || regions.presentFraction != 1;
        });
        if (!known) return std::nullopt;
        if (most == 0) return BrickChange{};
        if (mixed) return std::nullopt;
        const float bound = roundedUp(most * (isLabel(key) ? 1 : kCentredGain));
        return BrickChange{bound, bound};
    }

    BrickSamples read(const BrickKey& key) const override {
        (void)channelOf(key);
        return *made_.get(key);
    }

    const std::shared_ptr<const BrickSource>& shown() const { return shown_; }

    /// Takes over what the two have in common.
    void adopt(const CentredSource& former) {
        if (former.grid_ != grid_ || former.info_.times != info_.times) return;
        const auto [own, other] = std::ranges::mismatch(info_.parameters, former.info_.parameters);
        int same = 0;
        while (same < int(channels_.size()) && channels_[std::size_t(same)].parameter < own - info_.parameters.begin())
            ++same;
        const auto isSame = [&](const BrickKey& key) { return key.channel < same; };
        made_.adopt(former.made_, isSame);
        source_->adopt(*former.source_, isSame);
    }

private:
    BrickSamples make(const BrickKey& key) const {
        if (isMagnitude(key))
            return magnitude(read(component(key, 0)), read(component(key, 1)), read(component(key, 2)));
        const IndexBox texels = texelsOf(key, key.level);
        const CentredGrid& level = gridOf(key, key.level);
        const bool mixed = isMixed(key, level.needed(texels, true));
        return interleaved(key, level.make(gathered(key, level.needed(texels, mixed), mixed), texels));
    }

    const Channel& channelOf(const BrickKey& key) const {
        const glm::ivec3 count = grid_.count();
        const bool inside = key.channel >= 0 && std::size_t(key.channel) < channels_.size() && key.time >= 0 &&
                            std::size_t(key.time) < info_.times.size() && key.level >= 0 && key.level < grid_.levels &&
                            glm::clamp(key.index, glm::ivec3(0), count - 1) == key.index;
        if (!inside) throw Error("no such brick", info_.name);
        return channels_[std::size_t(key.channel)];
    }
    bool isLabel(const BrickKey& key) const {
        return info_.parameters[std::size_t(channelOf(key).parameter)].categorical;
    }
    bool isMagnitude(const BrickKey& key) const { return channelOf(key).magnitude; }
    BrickKey component(BrickKey magnitude, int which) const {
        magnitude.channel += which - channelOf(magnitude).component; // components come right before their magnitude
        return magnitude;
    }
    const CentredGrid& gridOf(const BrickKey& key, int level) const {
        return levels_[isLabel(key) ? 1 : 0][std::size_t(level)];
    }
    static BrickKey labelKey(BrickKey key, int label) {
        key.channel = label;
        return key;
    }

    /// The texels of a brick at a level.
    IndexBox texelsOf(const BrickKey& key, int level) const {
        const glm::ivec3 first = grid_.levelBegin(key.index, level), size = grid_.brickSamples(key.index, level);
        const glm::ivec3 begin(first.x, first.y, first.z / 2);
        return {begin, begin + glm::ivec3(size.x, size.y, (size.z + 1) / 2)};
    }

    /// Calls visit(key) for the bricks of the source that a box of samples of a level lies in.
    template <class Visit>
    void forBricks(const BrickKey& key, const IndexBox& box, const Visit& visit, int level = 0) const {
        const int edge = source_->grid().brickSize >> level;
        const glm::ivec3 first = box.begin / edge, last = (box.end - 1) / edge;
        for (int z = first.z; z <= last.z; ++z)
            for (int y = first.y; y <= last.y; ++y)
                for (int x = first.x; x <= last.x; ++x) visit(BrickKey{key.channel, key.time, level, {x, y, z}});
    }

    /// Whether samples in a box may be absent or of several parts, as far as statistics tell.
    bool isMixed(const BrickKey& key, const IndexBox& box) const {
        bool mixed = false;
        const std::optional<int> label = labels_[std::size_t(key.channel)];
        forBricks(
            key, box,
            [&](const BrickKey& from) {
                mixed = mixed || source_->stats(from).presentFraction != 1;
                if (!label || mixed) return;
                const BrickStats regions = source_->stats(labelKey(from, *label));
                mixed = regions.min != regions.max || regions.presentFraction != 1;
            },
            key.level);
        return mixed;
    }

    /// Samples of the source in a box of a level, with the numbers of their parts.
    SampledBox gathered(const BrickKey& key, const IndexBox& box, bool mixed) const {
        const Parameter& parameter = info_.parameters[std::size_t(channelOf(key).parameter)];
        const std::optional<int> label = labels_[std::size_t(key.channel)];
        SampledBox out{box, UnfilledVector<float>(box.count()), std::vector<std::uint8_t>(mixed ? box.count() : 0), 1};
        forBricks(
            key, box,
            [&](const BrickKey& from) {
                const auto brick = source_->get(from);
                std::vector<std::uint8_t> parts;
                if (label) parts = partsOfSamples(*source_->get(labelKey(from, *label)), parameter.parts);
                if (label && !mixed) out.number = std::uint8_t(1 + parts.front());
                const glm::ivec3 first = source_->grid().levelBegin(from.index, key.level);
                const IndexBox own{first, first + brick->size};
                const glm::ivec3 lo = glm::max(own.begin, box.begin), hi = glm::min(own.end, box.end);
                for (int z = lo.z; z < hi.z; ++z)
                    for (int y = lo.y; y < hi.y; ++y) {
                        const std::size_t to = box.place({lo.x, y, z}), at = own.place({lo.x, y, z});
                        const auto width = std::size_t(hi.x - lo.x);
                        std::copy_n(&brick->values[at], width, &out.values[to]);
                        for (std::size_t i = 0; mixed && i < width; ++i)
                            out.numbers[to + i] = !brick->isPresent(at + i) ? std::uint8_t(0)
                                                  : parts.empty()           ? std::uint8_t(1)
                                                                            : std::uint8_t(1 + parts[at + i]);
                    }
            },
            key.level);
        return out;
    }

    /// Both sublattices as a brick.
    BrickSamples interleaved(const BrickKey& key, const std::array<SampledBox, 2>& made) const {
        BrickSamples out;
        out.size = grid_.brickSamples(key.index, key.level);
        const auto slice = std::size_t(out.size.x) * std::size_t(out.size.y);
        out.values.resize(slice * std::size_t(out.size.z));
        const bool whole = std::ranges::all_of(made, [](const SampledBox& box) {
            return box.numbers.empty() ? box.number != 0 : std::ranges::find(box.numbers, 0) == box.numbers.end();
        });
        if (!whole) out.present.resize(out.values.size());
        for (std::size_t z = 0; z < std::size_t(out.size.z); ++z) {
            const SampledBox& from = made[z % 2];
            const std::size_t first = z / 2 * slice;
            std::copy_n(&from.values[first], slice, &out.values[z * slice]);
            for (std::size_t i = 0; !whole && i < slice; ++i)
                out.present[z * slice + i] = from.numberAt(first + i) != 0 ? 1 : 0;
        }
        return out;
    }

    std::shared_ptr<const BrickSource> shown_;
    std::shared_ptr<BrickCache> source_; ///< each brick is also read for those around it
    DatasetInfo info_;
    BrickGrid grid_;
    std::vector<Channel> channels_;
    std::vector<std::optional<int>> labels_;         ///< by channel: that of the parts of its parameter
    std::array<std::vector<CentredGrid>, 2> levels_; ///< of numbers, of labels
    mutable LoadOnce<BrickKey, BrickSamples, BrickKeyHash> made_;
};

} // namespace

bool canBeCentred(const BrickSource& source) {
    if (source.grid().lattice.kind != LatticeKind::CC) return false;
    const DatasetInfo& info = source.info();
    return std::ranges::all_of(info.parameters, [&](const Parameter& parameter) {
        return labelOf(info, parameter) < 0 || parameter.parts.count() <= kMostParts;
    });
}

std::shared_ptr<const BrickSource> makeCentredSource(std::shared_ptr<const BrickSource> source, std::size_t budget,
                                                     const BrickSource* former) {
    if (!canBeCentred(*source)) throw Error("it cannot be shown on the body-centred lattice", source->info().name);
    auto made = std::make_shared<CentredSource>(std::move(source), budget);
    if (const auto* known = dynamic_cast<const CentredSource*>(former)) made->adopt(*known);
    return made;
}

std::shared_ptr<const BrickSource> centredFrom(const BrickSource& source) {
    const auto* centred = dynamic_cast<const CentredSource*>(&source);
    return centred ? centred->shown() : nullptr;
}

} // namespace tessera::volume
