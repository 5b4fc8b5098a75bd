#include "vis/passes/renderer_state.h"

#include "vis/demand/changed_pixels.h"
#include "vis/shapes/proxy.h"

namespace tessera::vis {

bool findsHidden(const RendererState& shared, const Scene& scene) {
    return scene.render.cullHidden && shared.residency.bricked() && !lensesBend(scene) && !drawnByProxy(scene) &&
           !shared.options.countSamples && scene.camera.aperture <= 0;
}

void showScene(RendererState& shared, ViewTarget& target, const Scene& scene, std::uint64_t resident) {
    ShownScene& shown = target.shown;
    const bool same = shown.source == shared.source.get();
    if (shown.started && shown.scene == scene && shown.resident == resident && same) return;
    std::optional<Tile> part;
    if (shared.source && shown.started && target.state.presented() && same && shown.resident == resident)
        part = changedPixels(shown.scene, scene, worldFrame(shared.source->info(), scene.stretch), target.buffers.size);
    target.redraw(part.value_or(target.buffers.everything()));
    if (!(shown.scene == scene) || !same) ++shown.number;
    target.state.setPresented(target.state.presented() && (same || shown.source == shared.formerSource));
    shown.scene = scene;
    shown.resident = resident;
    shown.source = shared.source.get();
    shown.started = true;
}

} // namespace tessera::vis
