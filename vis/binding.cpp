#include "vis/renderer_impl.h"

#include <algorithm>

namespace tessera::vis {

namespace {

constexpr std::size_t kSmallTexels = std::size_t(1) << 20; ///< channels up to here need no coarse picture first
constexpr double kAfterTheRest = 1e6;
constexpr double kMovingDetail = 2; ///< coarser bricks will do while something moves

} // namespace

/// Which bricks the picture needs, by what is known of the plan's channels at a time; true when that is something else
/// than before.
bool Renderer::Impl::demandBricks(ViewTarget& target, const Scene& scene, const FrameRequest& request,
                                  const RayPlan& plan, const std::vector<ChannelKey>& keys) {
    if (!residency.bricked()) {
        target.demands.assign(keys.size(), nullptr);
        return false;
    }
    RayPlan known = plan;
    std::vector<const BlockRanges*> ranges(keys.size(), nullptr);
    std::vector<ChannelKey> state;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const ChannelTexture* channel = residency.known(keys[i]);
        if (!channel || !channel->bricks) continue;
        ranges[i] = &channel->bricks->brickRanges();
        known.fields[i].encoding = channel->encoding;
        state.push_back(keys[i]);
    }
    DemandSettings settings{request.size, scene.render.detail * (request.moving ? kMovingDetail : 1)};
    if (target.demandsFor && *target.demandsFor == scene && target.demandSettings == settings &&
        target.demandsKnown == state && target.demands.size() == keys.size())
        return false;
    target.demandsFor = scene;
    target.demandSettings = settings;
    target.demandsKnown = state;
    std::vector<std::shared_ptr<const BrickDemand>> demands =
        brickDemands(std::move(known), scene, source->info(), source->grid(), ranges, settings);
    const bool changed = !std::equal(demands.begin(), demands.end(), target.demands.begin(), target.demands.end(),
                                     [](const auto& a, const auto& b) { return a == b || (a && b && *a == *b); });
    if (changed) target.demands = std::move(demands);
    return changed;
}

/// Asks for what the plan samples and binds what is here; false when it cannot be drawn yet.
bool Renderer::Impl::bind(ViewTarget& target, const Scene& scene, const FrameRequest& request, RayPlan& plan,
                          FrameStatus& status) {
    const volume::DatasetInfo& info = source->info();
    const bool prefiltered = scene.render.filter == Filter::AverageQuasi;
    const int wantedTime = info.nearestTime(scene.time);
    const auto keysAt = [&](int time) {
        std::vector<ChannelKey> keys;
        for (const BoundField& field : plan.fields) {
            const bool shifted = field.timeShift != 0 && !info.times.empty();
            const int own = shifted ? info.nearestTime(info.times[std::size_t(time)] + field.timeShift) : time;
            keys.push_back({field.channel, own, prefiltered && !field.categorical && !field.raw});
        }
        return keys;
    };
    const std::vector<ChannelKey> wanted = keysAt(wantedTime);
    const glm::ivec3 texels = source->grid().lattice.texels();
    const bool large = std::size_t(texels.x) * std::size_t(texels.y) * std::size_t(texels.z) > kSmallTexels;
    demandBricks(target, scene, request, plan, wanted);
    do {
        for (std::size_t i = 0; i < wanted.size(); ++i)
            residency.want(wanted[i], double(i), large && !request.wait, target.demands[i]);
        if (request.wait) residency.finish();
    } while (request.wait && demandBricks(target, scene, request, plan, wanted));

    // All channels of one picture show one time: the wanted one if each has something there, else the former one.
    const auto here = [&](const std::vector<ChannelKey>& keys) {
        return std::all_of(keys.begin(), keys.end(), [&](const ChannelKey& key) {
            return residency.find(key) || residency.settled(key); // or it will never come
        });
    };
    int time = wantedTime;
    if (!here(wanted) && target.lastTime >= 0 && target.lastTime < int(info.times.size()) &&
        here(keysAt(target.lastTime))) {
        time = target.lastTime;
        for (const ChannelKey& key : keysAt(time)) residency.keep(key);
    }
    const std::vector<ChannelKey> shown = keysAt(time);
    bool any = false, settled = true;
    for (std::size_t i = 0; i < plan.fields.size(); ++i) {
        settled = settled && residency.settled(wanted[i]);
        status.bricksMissing += residency.missing(wanted[i]);
        any = bindField(plan.fields[i], shown[i]) || any;
    }
    // Part of the channels would want a program of its own, for a moment.
    if (!here(shown)) any = false;
    if (any) target.lastTime = time;
    // While the time moves on, the frame after this one comes next.
    if (wantedTime != target.wantedTime) target.timeStep = target.wantedTime < 0 ? 0 : wantedTime - target.wantedTime;
    target.wantedTime = wantedTime;
    const int next = wantedTime + target.timeStep;
    if (settled && !request.wait && target.timeStep != 0 && next >= 0 && next < int(info.times.size())) {
        const std::vector<ChannelKey> coming = keysAt(next);
        for (std::size_t i = 0; i < coming.size(); ++i)
            residency.want(coming[i], kAfterTheRest + double(i), false, target.demands[i]);
    }
    status.complete = settled;
    return any;
}

bool Renderer::Impl::bindField(BoundField& field, const ChannelKey& key) {
    const ChannelTexture* found = residency.find(key);
    const ChannelTexture& texture = found ? *found : residency.nothing();
    field.texture = texture.texture.name();
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
        field.atlas = texture.texture.name();
    }
    return found != nullptr;
}

} // namespace tessera::vis
