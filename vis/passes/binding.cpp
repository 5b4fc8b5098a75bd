#include "vis/passes/renderer_impl.h"

#include "volume/field/time_pair.h"

#include <algorithm>

namespace tessera::vis {

namespace {

constexpr std::size_t kSmallTexels = std::size_t(1) << 20; ///< channels up to here need no coarse picture first
constexpr double kAfterTheRest = 1e6;
constexpr double kMovingDetail = 2; ///< coarser bricks will do while something moves

/// Adds what a channel holds to the numbers of a frame.
void addCost(FrameStatus& status, const volume::BrickGrid& grid, const ChannelTexture* channel) {
    if (!channel) return;
    const auto count = [](glm::ivec3 size) { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); };
    if (!channel->bricks) {
        status.samples += count(grid.levelSamples(channel->level));
        status.bytes += channel->bytes;
        return;
    }
    const std::size_t bricks = std::size_t(channel->bricks->resident());
    const std::size_t perTexel = grid.lattice.kind == volume::LatticeKind::BCC ? 2 : 1;
    status.samples += bricks * count(glm::ivec3(grid.brickSize)) * perTexel;
    status.bytes += bricks * (channel->atlas->bytes() / std::max<std::size_t>(channel->atlas->capacity(), 1));
}

} // namespace

namespace {

/// The frames that a plan's fields show at a time: one each or, where one lies between two stored times, two each: the
/// earlier of all, then the later of all.
struct Frames {
    std::vector<ChannelKey> keys;
    std::vector<double> weights; ///< of the later frame, per field; empty: all are on stored times
};

Frames framesAt(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info, double time, bool bricked) {
    const bool prefiltered = scene.render.filter == Filter::AverageQuasi;
    const std::size_t count = plan.later > 0 ? std::size_t(plan.later) : plan.fields.size();
    const bool fits = 2 * count * (bricked ? 2 : 1) <= std::size_t(kMostFields);
    Frames frames;
    std::vector<volume::TimePair> pairs;
    bool between = false;
    for (std::size_t i = 0; i < count; ++i) {
        volume::TimePair pair = volume::timesAround(info.times, time + plan.fields[i].timeShift);
        if (plan.fields[i].nearest || !fits) pair = {pair.nearest(), pair.nearest(), 0};
        between = between || pair.between();
        pairs.push_back(pair);
    }
    const auto add = [&](std::size_t i, int index) {
        const BoundField& field = plan.fields[i];
        frames.keys.push_back({field.channel, index, prefiltered && !field.nearest && !field.raw, field.part});
    };
    for (std::size_t i = 0; i < count; ++i) add(i, pairs[i].earlier);
    for (std::size_t i = 0; between && i < count; ++i) {
        add(i, pairs[i].later);
        frames.weights.push_back(pairs[i].weight);
    }
    return frames;
}

/// Gives the plan a field for each frame.
void setFrames(RayPlan& plan, const Frames& frames) {
    if (plan.later > 0) plan.fields.resize(std::size_t(plan.later));
    plan.later = int(frames.weights.size());
    for (std::size_t i = 0; i < frames.weights.size(); ++i) plan.fields[i].laterWeight = frames.weights[i];
    const std::vector<BoundField> once = plan.fields;
    if (plan.later > 0) plan.fields.insert(plan.fields.end(), once.begin(), once.end());
}

/// Edge of a cell of the finest level that any of the demands names, in cells of full resolution.
double finestCell(const std::vector<std::shared_ptr<const BrickDemand>>& demands) {
    std::uint8_t finest = BrickDemand::kNotWanted;
    for (const auto& demand : demands)
        if (demand && !demand->level.empty()) finest = std::min(finest, *std::ranges::min_element(demand->level));
    return finest == BrickDemand::kNotWanted ? 1 : double(1 << finest);
}

/// What two frames of a channel need together. (They lie in one picture, which hides the same of both.)
std::shared_ptr<const BrickDemand> either(const std::shared_ptr<const BrickDemand>& a,
                                          const std::shared_ptr<const BrickDemand>& b) {
    if (!a || !b || *a == *b) return a ? b ? a : nullptr : nullptr;
    auto both = std::make_shared<BrickDemand>(*a);
    for (std::size_t i = 0; i < both->level.size(); ++i) {
        both->level[i] = std::min(a->level[i], b->level[i]);
        both->hidden[i] = a->hidden[i] | b->hidden[i];
        const bool here = a->level[i] != BrickDemand::kNotWanted, there = b->level[i] != BrickDemand::kNotWanted;
        both->priority[i] = here && there ? std::min(a->priority[i], b->priority[i])
                            : here        ? a->priority[i]
                                          : b->priority[i];
    }
    return both;
}

/// Takes in ranges in other texel units; false, and empty, where the grids differ.
bool unite(BlockRanges& into, const BlockRanges& other, const TexelEncoding& units, const TexelEncoding& otherUnits) {
    if (into.count != other.count || into.edge != other.edge || into.level != other.level || into.min.empty() ||
        other.min.empty()) {
        into.min.clear(), into.max.clear();
        return false;
    }
    const double scale = otherUnits.scale / units.scale, offset = (otherUnits.offset - units.offset) / units.scale;
    for (std::size_t i = 0; i < into.min.size(); ++i) {
        if (!(other.min[i] <= other.max[i])) continue;
        const float lo = float(double(other.min[i]) * scale + offset),
                    hi = float(double(other.max[i]) * scale + offset);
        const bool absent = !(into.min[i] <= into.max[i]);
        into.min[i] = absent ? lo : std::min(into.min[i], lo);
        into.max[i] = absent ? hi : std::max(into.max[i], hi);
    }
    return true;
}

/// Fields of a plan's channels at one time, from `first` on, that have several parts.
std::vector<std::size_t> partedFields(const RayPlan& plan, std::size_t first) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < std::size_t(plan.channels); ++i)
        if (plan.fields[i].parts > 1) out.push_back(first + i);
    return out;
}

/// Ranges of all parts of a channel, in texels of its first; null where not all are known.
std::optional<BlockRanges> rangesOfParts(const RayPlan& plan, std::size_t i,
                                         std::span<const BlockRanges* const> ranges) {
    const BoundField& field = plan.fields[i];
    if (!ranges[i]) return std::nullopt;
    BlockRanges all = *ranges[i];
    for (int part = 1; part < field.parts; ++part) {
        const BlockRanges* other = ranges[std::size_t(field.more + part - 1)];
        const TexelEncoding& units = plan.fields[std::size_t(field.more + part - 1)].encoding;
        if (!other) return std::nullopt;
        unite(all, *other, field.encoding, units);
    }
    return all;
}

} // namespace

/// Which bricks the picture needs, by what is known of the plan's channels at its frames; true when that is something
/// else than before.
bool Renderer::Impl::demandBricks(ViewTarget& target, const Scene& scene, const FrameRequest& request,
                                  const RayPlan& plan, const std::vector<ChannelKey>& keys) {
    if (!residency.bricked()) {
        target.demands.assign(keys.size(), nullptr);
        target.cell = 1;
        return false;
    }
    std::vector<ChannelKey> state;
    for (const ChannelKey& key : keys)
        if (const ChannelTexture* channel = residency.known(key); channel && channel->bricks) state.push_back(key);
    const DemandSettings settings{request.size, scene.render.detail * (request.moving ? kMovingDetail : 1),
                                  scene.render.importance, target.share};
    if (target.demandsFor && *target.demandsFor == scene && target.demandSettings == settings &&
        target.demandsKnown == state && target.demandsHidden == target.hidden.revision() &&
        target.demands.size() == keys.size())
        return false;
    target.demandsFor = scene;
    target.demandSettings = settings;
    target.demandsKnown = state;
    target.demandsHidden = target.hidden.revision();
    std::span<const std::uint8_t> hidden;
    if (findsHidden(scene) && target.source == source.get()) hidden = target.hidden.bricks();
    const std::size_t count = plan.later > 0 ? std::size_t(plan.later) : plan.fields.size();
    const auto demandsOf = [&](std::size_t first) {
        RayPlan known = plan;
        known.later = 0;
        known.fields.resize(count);
        std::vector<const BlockRanges*> ranges(count, nullptr);
        std::vector<std::span<const float>> importance(count);
        for (std::size_t i = 0; i < count; ++i) {
            const ChannelTexture* channel = residency.known(keys[first + i]);
            if (!channel || !channel->bricks) continue;
            ranges[i] = &channel->bricks->brickRanges();
            importance[i] = channel->bricks->importance();
            known.fields[i].encoding = channel->encoding;
        }
        // What is wanted of a channel is wanted of each of its parts.
        std::vector<BlockRanges> all;
        all.reserve(count);
        for (const std::size_t i : partedFields(known, 0)) {
            const std::optional<BlockRanges> united = rangesOfParts(known, i, ranges);
            ranges[i] = united ? &all.emplace_back(*united) : nullptr;
        }
        auto wanted = brickDemands(known, scene, source->info(), source->grid(), ranges, importance, settings, hidden);
        for (const std::size_t i : partedFields(known, 0))
            for (int part = 1; part < known.fields[i].parts; ++part)
                wanted[std::size_t(known.fields[i].more + part - 1)] = wanted[i];
        return wanted;
    };
    std::vector<std::shared_ptr<const BrickDemand>> demands = demandsOf(0);
    if (plan.later > 0) {
        const std::vector<std::shared_ptr<const BrickDemand>> later = demandsOf(count);
        for (std::size_t i = 0; i < count; ++i) demands[i] = either(demands[i], later[i]);
        const std::vector<std::shared_ptr<const BrickDemand>> once = demands;
        demands.insert(demands.end(), once.begin(), once.end());
    }
    const bool changed = !std::equal(demands.begin(), demands.end(), target.demands.begin(), target.demands.end(),
                                     [](const auto& a, const auto& b) { return a == b || (a && b && *a == *b); });
    if (changed) {
        target.demands = std::move(demands);
        target.cell = finestCell(target.demands);
    }
    return changed;
}

/// Asks for what the plan samples and binds what is here; false when it cannot be drawn yet.
bool Renderer::Impl::bind(ViewTarget& target, const Scene& scene, const FrameRequest& request, RayPlan& plan,
                          FrameStatus& status) {
    const volume::DatasetInfo& info = source->info();
    status.samples = status.bytes = 0;
    status.bricksMissing = 0;
    takeReach(target, false);
    const auto at = [&](double time) { return framesAt(plan, scene, info, time, residency.bricked()); };
    const Frames wanted = at(scene.time);
    setFrames(plan, wanted);
    const glm::ivec3 texels = source->grid().lattice.texels();
    const bool large = std::size_t(texels.x) * std::size_t(texels.y) * std::size_t(texels.z) > kSmallTexels;
    demandBricks(target, scene, request, plan, wanted.keys);
    do {
        for (std::size_t i = 0; i < wanted.keys.size(); ++i)
            residency.want(wanted.keys[i], double(i), large && !request.wait, target.demands[i]);
        if (request.wait) residency.finish();
    } while (request.wait && demandBricks(target, scene, request, plan, wanted.keys));

    // All channels of one picture show one time: the wanted one if each has something there, else the former one.
    const auto here = [&](const Frames& frames) {
        return std::all_of(frames.keys.begin(), frames.keys.end(), [&](const ChannelKey& key) {
            return residency.find(key) || residency.settled(key); // or it will never come
        });
    };
    double time = scene.time;
    Frames shown = wanted;
    if (!here(wanted) && target.lastTime) {
        const Frames former = at(*target.lastTime);
        if (here(former)) {
            time = *target.lastTime;
            shown = former;
            setFrames(plan, shown);
            for (const ChannelKey& key : shown.keys) residency.keep(key);
        }
    }
    bool any = false, settled = true;
    for (const ChannelKey& key : wanted.keys) {
        settled = settled && residency.settled(key);
        status.bricksMissing += residency.missing(key);
    }
    for (std::size_t i = 0; i < plan.fields.size(); ++i) {
        any = bindField(plan.fields[i], shown.keys[i]) || any;
        addCost(status, source->grid(), residency.find(shown.keys[i]));
    }
    bindRanges(target, plan, shown.keys);
    // Part of the channels would want a program of its own, for a moment.
    if (!here(shown)) any = false;
    if (any) {
        if (target.lastTime != time) ++target.sceneNumber;
        target.lastTime = time;
        target.shown = shown.keys;
    }
    // While the time moves on, the frame after this one comes next.
    const volume::TimePair now = volume::timesAround(info.times, scene.time);
    if (now.earlier != target.wantedTime) target.timeStep = target.wantedTime < 0 ? 0 : now.earlier - target.wantedTime;
    target.wantedTime = now.earlier;
    const int next = (target.timeStep > 0 ? now.later : now.earlier) + target.timeStep;
    if (settled && !request.wait && target.timeStep != 0 && next >= 0 && next < int(info.times.size())) {
        const Frames coming = at(info.times[std::size_t(next)]);
        for (std::size_t i = 0; i < coming.keys.size(); ++i)
            residency.want(coming.keys[i], kAfterTheRest + double(i), false, target.demands[i % target.demands.size()]);
    }
    status.complete = settled;
    return any;
}

/// Block ranges of channels of several parts, and of those between two frames.
void Renderer::Impl::bindRanges(ViewTarget& target, RayPlan& plan, const std::vector<ChannelKey>& keys) {
    // What failed to load is absent in any units.
    const std::size_t times = plan.later > 0 ? 2 : 1, count = plan.fields.size() / times;
    std::vector<std::size_t> parted = partedFields(plan, 0);
    for (std::size_t time = 0; time < times; ++time)
        for (const std::size_t i : parted) {
            TexelEncoding& units = plan.fields[time * count + i].encoding;
            for (int part = 1; part < plan.fields[i].parts && !residency.find(keys[time * count + i]); ++part) {
                const std::size_t other = time * count + std::size_t(plan.fields[i].more + part - 1);
                if (residency.find(keys[other])) units = plan.fields[other].encoding;
            }
        }
    if (plan.later == 0 && parted.empty()) return;
    if (target.unitedKeys != keys || target.unitedRevision != residency.revision()) {
        target.unitedKeys = keys;
        target.unitedRevision = residency.revision();
        target.unitedBlocks.clear();
        for (const BoundField& field : plan.fields) target.unitedBlocks.push_back(*field.blocks);
        for (std::size_t time = 0; time < times; ++time)
            for (const std::size_t i : parted) {
                const std::size_t first = time * count;
                for (int part = 1; part < plan.fields[i].parts; ++part) {
                    const std::size_t other = first + std::size_t(plan.fields[i].more + part - 1);
                    unite(target.unitedBlocks[first + i], *plan.fields[other].blocks, plan.fields[first + i].encoding,
                          plan.fields[other].encoding);
                }
            }
        for (std::size_t i = 0; plan.later > 0 && i < count; ++i)
            unite(target.unitedBlocks[i], target.unitedBlocks[count + i], plan.fields[i].encoding,
                  plan.fields[count + i].encoding);
    }
    for (std::size_t i = 0; i < plan.fields.size(); ++i) plan.fields[i].blocks = &target.unitedBlocks[i];
}

bool Renderer::Impl::bindField(BoundField& field, const ChannelKey& key) {
    const ChannelTexture* found = residency.find(key);
    const ChannelTexture& texture = found ? *found : residency.nothing();
    field.texture = texture.texture ? texture.texture->name() : residency.nothing().texture->name();
    field.level = texture.level;
    field.encoding = texture.encoding;
    field.textureSize = texture.size;
    field.blocks = &texture.blocks();
    if (texture.bricks) {
        field.pages = texture.bricks->pageTexture();
        field.atlas = texture.atlas->texture();
        field.atlasSize = texture.atlas->size();
    } else if (residency.bricked()) {
        field.pages = residency.nothingPages();
        field.atlas = texture.texture->name();
    }
    return found != nullptr;
}

} // namespace tessera::vis
