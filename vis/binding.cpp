#include "vis/renderer_impl.h"

#include <algorithm>

namespace tessera::vis {

namespace {

constexpr std::size_t kSmallTexels = std::size_t(1) << 20; ///< channels up to here need no coarse picture first

} // namespace

/// Asks for what the plan samples and binds what is here; false when nothing of it is here yet.
bool Renderer::Impl::bind(ViewTarget& target, const Scene& scene, const FrameRequest& request, RayPlan& plan,
                          FrameStatus& status) {
    const volume::DatasetInfo& info = source->info();
    const bool prefiltered = scene.render.filter == Filter::AverageQuasi;
    const int wantedTime = info.nearestTime(scene.time);
    const auto keyOf = [&](const BoundField& field, int time) {
        return ChannelKey{field.channel, time, prefiltered && !field.categorical};
    };
    const volume::Lattice& lattice = source->grid().lattice;
    const WorldFrame frame = worldFrame(info.bounds, scene.stretch);
    const glm::dvec3 eye = lattice.toCells(frame.toPhysical(cameraRay(scene.camera, 1, {0, 0}).origin));
    const glm::ivec3 texels = lattice.texels();
    const bool large = std::size_t(texels.x) * std::size_t(texels.y) * std::size_t(texels.z) > kSmallTexels;
    for (std::size_t i = 0; i < plan.fields.size(); ++i)
        residency.want(keyOf(plan.fields[i], wantedTime), double(i), large && !request.wait, eye);
    if (request.wait) residency.finish();

    // All channels of one picture show one time: the wanted one if each has something there, else the former one.
    const auto here = [&](int time) {
        return std::all_of(plan.fields.begin(), plan.fields.end(), [&](const BoundField& field) {
            const ChannelKey key = keyOf(field, time);
            return residency.find(key) || residency.settled(key); // or it will never come
        });
    };
    int time = wantedTime;
    if (!here(time) && target.lastTime >= 0 && target.lastTime < int(info.times.size()) && here(target.lastTime)) {
        time = target.lastTime;
        for (const BoundField& field : plan.fields) residency.keep(keyOf(field, time));
    }
    bool any = false, settled = true;
    for (BoundField& field : plan.fields) {
        const ChannelKey wanted = keyOf(field, wantedTime);
        settled = settled && residency.settled(wanted);
        status.bricksMissing += residency.missing(wanted);
        const ChannelTexture* texture = residency.find(keyOf(field, time));
        if (!texture) texture = &residency.nothing();
        any = any || texture != &residency.nothing();
        field.texture = texture->texture.name();
        field.level = texture->level;
        field.encoding = texture->encoding;
        field.textureSize = texture->size;
        field.blocks = &texture->blocks;
        field.pages = texture->pages && texture->atlas ? texture->pages->texture.name() : 0;
        field.atlas = field.pages ? texture->atlas->texture() : 0;
        if (field.atlas) field.atlasSize = texture->atlas->size();
        field.everyBrick = texture->bricksMissing == 0;
    }
    if (any) target.lastTime = time;
    status.complete = settled;
    return any;
}

} // namespace tessera::vis
