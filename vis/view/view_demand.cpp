#include "vis/view/view_demand.h"

#include "volume/field/time_pair.h"

#include <algorithm>

namespace tessera::vis {

namespace {

constexpr std::size_t kSmallTexels = std::size_t(1) << 20; ///< larger channels are first loaded at a coarse level
constexpr double kAfterTheRest = 1e6;
constexpr double kMovingDetail = 2; ///< factor on the wanted voxel size during interaction

/// Adds the samples and bytes of a channel to the status.
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

/// `mixed`: channels that are computed between stored times are mixed, too, which needs no other samples.
PlanFrames framesAt(const Residency& residency, const RenderCall& call, double time, bool mixed) {
    const RayPlan& plan = call.plan;
    const volume::DatasetInfo& info = call.info();
    const volume::Prefilter prefilter = prefilterOf(call.scene.render.filter);
    const std::size_t count = plan.later > 0 ? std::size_t(plan.later) : plan.fields.size();
    const bool fits = 2 * count <= std::size_t(plan.mostFields);
    PlanFrames frames;
    std::vector<volume::TimePair> pairs;
    std::vector<std::optional<int>> computed;
    bool between = false;
    for (std::size_t i = 0; i < count; ++i) {
        volume::TimePair pair = volume::timesAround(info.times, time + plan.fields[i].timeShift);
        if (plan.fields[i].nearest || !fits) pair = {pair.nearest(), pair.nearest(), 0};
        computed.push_back(mixed ? std::nullopt : residency.computedTime(plan.fields[i].channel, pair));
        between = between || pair.between(); // one program, whether mixed or computed
        pairs.push_back(pair);
    }
    const auto add = [&](std::size_t i, int index) {
        const BoundField& field = plan.fields[i];
        const bool asStored = field.nearest || field.raw;
        frames.keys.push_back({field.channel, index, asStored ? volume::Prefilter::None : prefilter, field.part});
    };
    for (std::size_t i = 0; i < count; ++i) add(i, computed[i].value_or(pairs[i].earlier));
    for (std::size_t i = 0; between && i < count; ++i) {
        add(i, computed[i].value_or(pairs[i].later));
        frames.weights.push_back(pairs[i].weight);
    }
    return frames;
}

/// Extends the plan's fields for interpolation between two stored times.
void setFrames(RayPlan& plan, const PlanFrames& frames) {
    if (plan.later > 0) plan.fields.resize(std::size_t(plan.later));
    plan.later = int(frames.weights.size());
    for (std::size_t i = 0; i < frames.weights.size(); ++i) plan.fields[i].laterWeight = frames.weights[i];
    const std::vector<BoundField> once = plan.fields;
    if (plan.later > 0) plan.fields.insert(plan.fields.end(), once.begin(), once.end());
}

/// Cell edge of the finest level in the demands, in full-resolution cells.
double finestCell(const std::vector<std::shared_ptr<const BrickDemand>>& demands) {
    std::uint8_t finest = BrickDemand::kNotWanted;
    for (const auto& demand : demands)
        if (demand && !demand->level.empty()) finest = std::min(finest, *std::ranges::min_element(demand->level));
    return finest == BrickDemand::kNotWanted ? 1 : double(1 << finest);
}

/// Union of the demands of two stored times of a channel. (Both appear in one picture, so the same bricks of both are
/// occluded.)
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

/// Extends `into` by ranges in other texel units; empties it and returns false if the grids differ.
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

/// Indices of the fields, at the earlier time, whose channel has several parts.
std::vector<std::size_t> partedFields(const RayPlan& plan) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < std::size_t(plan.channels); ++i)
        if (plan.fields[i].parts > 1) out.push_back(i);
    return out;
}

/// Union of the ranges of all parts of a channel in texel units of the first; null if one is unknown.
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

/// Binds a field to the resident data of a channel; false, and bound to absent samples, if there are none.
bool bindField(const Residency& residency, BoundField& field, const ChannelKey& key) {
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

/// Whether all channels are resident, or never will be.
bool allHere(const Residency& residency, const PlanFrames& frames) {
    return std::ranges::all_of(frames.keys,
                               [&](const ChannelKey& key) { return residency.find(key) || residency.settled(key); });
}

/// The brick demands of a plan's fields at one time; `keys` are the channels of the fields.
std::vector<std::shared_ptr<const BrickDemand>> demandsAt(const Residency& residency, const RenderCall& call,
                                                          std::span<const ChannelKey> keys,
                                                          const DemandSettings& settings,
                                                          std::span<const std::uint8_t> hidden) {
    const std::size_t count = keys.size();
    RayPlan known = call.plan;
    known.later = 0;
    known.fields.resize(count);
    std::vector<const BlockRanges*> ranges(count, nullptr);
    std::vector<std::span<const float>> importance(count);
    for (std::size_t i = 0; i < count; ++i) {
        const ChannelTexture* channel = residency.known(keys[i]);
        if (!channel || !channel->bricks) continue;
        ranges[i] = &channel->bricks->brickRanges();
        importance[i] = channel->bricks->importance();
        known.fields[i].encoding = channel->encoding;
    }
    // The demand of a channel applies to each of its parts.
    std::vector<BlockRanges> all;
    all.reserve(count);
    for (const std::size_t i : partedFields(known)) {
        const std::optional<BlockRanges> united = rangesOfParts(known, i, ranges);
        ranges[i] = united ? &all.emplace_back(*united) : nullptr;
    }
    auto wanted = brickDemands(known, call.scene, call.info(), call.grid(), ranges, importance, settings, hidden);
    for (const std::size_t i : partedFields(known))
        for (int part = 1; part < known.fields[i].parts; ++part)
            wanted[std::size_t(known.fields[i].more + part - 1)] = wanted[i];
    return wanted;
}

/// Parts that failed to load are absent and adopt the texel units of a loaded part.
void alignParts(const Residency& residency, RayPlan& plan, const std::vector<ChannelKey>& keys,
                const std::vector<std::size_t>& parted, std::size_t times) {
    const std::size_t count = plan.fields.size() / times;
    for (std::size_t time = 0; time < times; ++time)
        for (const std::size_t i : parted) {
            TexelEncoding& units = plan.fields[time * count + i].encoding;
            for (int part = 1; part < plan.fields[i].parts && !residency.find(keys[time * count + i]); ++part) {
                const std::size_t other = time * count + std::size_t(plan.fields[i].more + part - 1);
                if (residency.find(keys[other])) units = plan.fields[other].encoding;
            }
        }
}

/// Block ranges of a plan's fields, united over parts and over both times.
std::vector<BlockRanges> unitedRanges(const RayPlan& plan, const std::vector<std::size_t>& parted, std::size_t times) {
    const std::size_t count = plan.fields.size() / times;
    std::vector<BlockRanges> out;
    for (const BoundField& field : plan.fields) out.push_back(*field.blocks);
    for (std::size_t time = 0; time < times; ++time)
        for (const std::size_t i : parted) {
            const std::size_t first = time * count;
            for (int part = 1; part < plan.fields[i].parts; ++part) {
                const std::size_t other = first + std::size_t(plan.fields[i].more + part - 1);
                unite(out[first + i], *plan.fields[other].blocks, plan.fields[first + i].encoding,
                      plan.fields[other].encoding);
            }
        }
    for (std::size_t i = 0; times > 1 && i < count; ++i)
        unite(out[i], out[count + i], plan.fields[i].encoding, plan.fields[count + i].encoding);
    return out;
}

} // namespace

/// Chooses the bricks of the picture from the known ranges of the channels; true if the choice changed.
bool ViewDemand::choose(const Residency& residency, const RenderCall& call, const HiddenInView* hidden,
                        const std::vector<ChannelKey>& frames) {
    if (!residency.bricked()) {
        chosen_.clear();
        demands_.assign(frames.size(), nullptr);
        cell_ = 1;
        return false;
    }
    const FrameRequest& request = call.request;
    DemandKey key{call.scene,
                  {request.size, call.scene.render.detail * (request.moving ? kMovingDetail : 1),
                   call.scene.render.importance, share_},
                  frames,
                  {},
                  hidden ? std::optional(hidden->revision()) : std::nullopt};
    for (const ChannelKey& frame : frames)
        if (const ChannelTexture* channel = residency.known(frame); channel && channel->bricks)
            key.known.push_back(frame);
    const std::size_t times = call.plan.later > 0 ? 2 : 1, count = frames.size() / times;
    bool anew = false;
    const Demands& chosen = chosen_.get(key, [&](const DemandKey& made) {
        anew = true;
        const std::span<const std::uint8_t> bricks = hidden ? hidden->bricks() : std::span<const std::uint8_t>();
        const std::span<const ChannelKey> keys(made.frames);
        Demands demands = demandsAt(residency, call, keys.first(count), made.settings, bricks);
        if (times == 1) return demands;
        const Demands later = demandsAt(residency, call, keys.last(count), made.settings, bricks);
        for (std::size_t i = 0; i < count; ++i) demands[i] = either(demands[i], later[i]);
        const Demands once = demands;
        demands.insert(demands.end(), once.begin(), once.end());
        return demands;
    });
    const auto same = [](const auto& a, const auto& b) { return a == b || (a && b && *a == *b); };
    if (!anew || std::ranges::equal(chosen, demands_, same)) return false;
    demands_ = chosen;
    cell_ = finestCell(demands_);
    return true;
}

/// Requests the channels at the scene's time.
PlanFrames ViewDemand::wantFrames(Residency& residency, const RenderCall& call, const HiddenInView* hidden) {
    const bool waits = call.request.wait;
    PlanFrames wanted = framesAt(residency, call, call.scene.time, call.request.moving && !waits);
    setFrames(call.plan, wanted);
    const glm::ivec3 texels = call.grid().lattice.texels();
    const bool large = std::size_t(texels.x) * std::size_t(texels.y) * std::size_t(texels.z) > kSmallTexels;
    choose(residency, call, hidden, wanted.keys);
    do {
        for (std::size_t i = 0; i < wanted.keys.size(); ++i)
            residency.want(wanted.keys[i], double(i), large && !waits, demands_[i]);
        if (waits) residency.finish();
    } while (waits && choose(residency, call, hidden, wanted.keys));
    return wanted;
}

/// Decides which time is shown: all channels of a picture show the same time, the wanted one if all are resident, else
/// the former one.
PlanFrames ViewDemand::showFrames(Residency& residency, const RenderCall& call, const PlanFrames& wanted, double& time,
                                  bool& mixed) const {
    time = call.scene.time;
    mixed = call.request.moving && !call.request.wait;
    if (allHere(residency, wanted) || !time_) return wanted;
    PlanFrames former = framesAt(residency, call, *time_, mixed_);
    if (!allHere(residency, former)) return wanted;
    time = *time_;
    mixed = mixed_;
    setFrames(call.plan, former);
    for (const ChannelKey& key : former.keys) residency.keep(key);
    return former;
}

/// Prefetches the next stored time while an animation runs.
void ViewDemand::wantNext(Residency& residency, const RenderCall& call, bool settled) {
    const std::vector<double>& times = call.info().times;
    const volume::TimePair now = volume::timesAround(times, call.scene.time);
    if (now.earlier != wantedTime_) timeStep_ = wantedTime_ < 0 ? 0 : now.earlier - wantedTime_;
    wantedTime_ = now.earlier;
    const int next = (timeStep_ > 0 ? now.later : now.earlier) + timeStep_;
    if (!settled || call.request.wait || timeStep_ == 0 || next < 0 || next >= int(times.size())) return;
    const PlanFrames coming = framesAt(residency, call, times[std::size_t(next)], true);
    for (std::size_t i = 0; i < coming.keys.size(); ++i)
        residency.want(coming.keys[i], kAfterTheRest + double(i), false, demands_[i % demands_.size()]);
}

bool ViewDemand::bind(Residency& residency, const RenderCall& call, const HiddenInView* hidden, FrameStatus& status) {
    RayPlan& plan = call.plan;
    status.samples = status.bytes = 0;
    status.bricksMissing = 0;
    const PlanFrames wanted = wantFrames(residency, call, hidden);
    double time = 0;
    bool mixed = false;
    const PlanFrames shown = showFrames(residency, call, wanted, time, mixed);
    bool any = false, settled = true;
    for (const ChannelKey& key : wanted.keys) {
        settled = settled && residency.settled(key);
        status.bricksMissing += residency.missing(key);
    }
    for (std::size_t i = 0; i < plan.fields.size(); ++i) {
        any = bindField(residency, plan.fields[i], shown.keys[i]) || any;
        addCost(status, call.grid(), residency.find(shown.keys[i]));
    }
    bindRanges(residency, plan, shown.keys);
    // Drawing only some channels would need another program for a short time.
    if (!allHere(residency, shown)) any = false;
    if (any) {
        if (mixed_ && !mixed) residency.announce();
        time_ = time;
        mixed_ = mixed;
        frames_ = shown.keys;
    }
    wantNext(residency, call, settled);
    status.complete = settled;
    return any;
}

/// Combines block ranges over parts and, between two stored times, over both.
void ViewDemand::bindRanges(const Residency& residency, RayPlan& plan, const std::vector<ChannelKey>& frames) {
    const std::size_t times = plan.later > 0 ? 2 : 1;
    const std::vector<std::size_t> parted = partedFields(plan);
    alignParts(residency, plan, frames, parted, times);
    if (times == 1 && parted.empty()) return;
    const std::vector<BlockRanges>& ranges = ranges_.get(
        RangesKey{frames, residency.revision()}, [&](const RangesKey&) { return unitedRanges(plan, parted, times); });
    for (std::size_t i = 0; i < plan.fields.size(); ++i) plan.fields[i].blocks = &ranges[i];
}

} // namespace tessera::vis
