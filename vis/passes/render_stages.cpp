#include "vis/passes/render_stages.h"

#include "vis/demand/changed_pixels.h"
#include "vis/shapes/proxy.h"
#include "volume/base/error.h"

#include <algorithm>
#include <utility>

namespace tessera::vis {

namespace {

constexpr std::size_t kUploadPerFrame = std::size_t(24) << 20;

} // namespace

/// Resizes the target to the picture; returns false, with a single message, if the driver has no memory.
bool RenderStages::resize(ViewTarget& target, const FrameRequest& request) {
    try {
        target.resize(request.size, options.exactTextures);
        return true;
    } catch (const MachineError& error) {
        if (request.wait) throw;
        if (refusal != error.what()) tools.messages.push_back(error.what());
        refusal = error.what();
        return false;
    }
}

/// Uploads loaded data within the scene's limits.
void RenderStages::beginFrame(ViewTarget& target, const Scene& scene, const FrameRequest& request) {
    const RenderLimits& given = scene.render.limits;
    residency.setBudgets(std::min(options.textureBudget, std::size_t(given.textureMemory) << 20),
                         std::min(options.memoryBudget, std::size_t(given.brickMemory) << 20));
    residency.setKeptChange(double(given.keptChange));
    // A window draws each target once per frame; a picture drawn with `wait` counts as a frame of its own.
    if (request.wait || target.shown.frame == residency.frame()) residency.beginFrame();
    target.shown.frame = residency.frame();
    residency.update(request.wait ? ~std::size_t(0) : kUploadPerFrame);
}

/// Whether pictures of the scene tell which bricks are occluded. With a magnifying lens, rays sample other positions
/// than those they pass; with depth of field, those of a pixel pass different ones.
bool RenderStages::findsHidden(const Scene& scene) const {
    return scene.render.cullHidden && residency.bricked() && !lensesBend(scene) && !drawnByProxy(scene) &&
           !options.countSamples && scene.camera.aperture <= 0;
}

/// The bricks that the last picture of these data occluded; null if they cannot be used for a scene.
const HiddenInView* RenderStages::hiddenIn(const ViewTarget& target, const Scene& scene) const {
    return findsHidden(scene) && target.shown.source == source.get() ? &target.hidden.bricks() : nullptr;
}

void RenderStages::takeHidden(ViewTarget& target, bool wait) {
    target.hidden.take(wait, target.shown.source == source.get() && source ? &source->grid() : nullptr);
}

/// Requests what the plan samples and binds the resident part; false if it cannot be drawn yet.
bool RenderStages::bind(ViewTarget& target, const RenderCall& call, FrameStatus& status) {
    takeHidden(target, false);
    const std::optional<double> former = target.demand.time();
    const bool any = target.demand.bind(residency, call, hiddenIn(target, call.scene), status);
    if (target.demand.time() != former) ++target.shown.number;
    return any;
}

/// Makes the scene that of the target and marks outdated pixels.
/// `resident`: changes with the samples that are drawn.
void RenderStages::show(ViewTarget& target, const Scene& scene, std::uint64_t resident) {
    ShownScene& shown = target.shown;
    const bool same = shown.source == source.get();
    if (shown.started && shown.scene == scene && shown.resident == resident && same) return;
    std::optional<Tile> part;
    if (source && shown.started && target.state.presented() && same && shown.resident == resident)
        part = changedPixels(shown.scene, scene, worldFrame(source->info().bounds, scene.stretch), target.buffers.size);
    target.redraw(part.value_or(target.buffers.everything()));
    if (!(shown.scene == scene) || !same) ++shown.number;
    target.state.setPresented(target.state.presented() && (same || shown.source == formerSource));
    shown.scene = scene;
    shown.resident = resident;
    shown.source = source.get();
    shown.started = true;
}

/// Requests the data of the scene and draws or refines what is resident; false if nothing can be drawn.
bool RenderStages::draw(ViewTarget& target, const RenderCall& call, Clock::time_point start, FrameStatus& status) {
    const bool any = !call.plan.empty() && bind(target, call, status);
    // What the processor draws meanwhile has samples of its own.
    show(target, call.scene, target.meanwhile ? target.shown.resident : residency.revision());
    target.shown.compiling = false;
    if (any) {
        refine(target, call, start);
        if (findsHidden(call.scene) && !target.meanwhile)
            target.hidden.start(tools, call, target.buffers, target.state, target.shown.number);
    } else if (!target.state.full()) {
        const bool comes = !call.plan.empty() && !status.complete;
        status.waits = comes;
        if (comes && !target.state.presented() && !call.request.wait)
            blank(target, call.scene);
        else if (!comes || !target.state.presented())
            nothing(target, call.scene);
    }
    return any;
}

/// Draws small pictures from the coarsest bricks, then with growing shares of the others, nearest first, so that most
/// occluded bricks are never requested.
void RenderStages::probe(ViewTarget& target, const RenderCall& call) {
    ++target.shown.number;
    target.shown.scene = call.scene;
    target.shown.source = source.get();
    for (const double share : {0.0, 0.125, 0.25, 0.5}) {
        target.demand.setShare(share);
        FrameStatus unused;
        if (!bind(target, call, unused)) break;
        target.redraw(target.buffers.everything());
        refine(target, call, Clock::now());
        target.hidden.start(tools, call, target.buffers, target.state, target.shown.number);
        takeHidden(target, true);
    }
    target.demand.setShare(1);
}

/// Whether the finished picture shows bricks assumed to be occluded, so that other bricks are wanted.
bool RenderStages::reveals(ViewTarget& target, const RenderCall& call) {
    takeHidden(target, true);
    return target.demand.chooseAgain(residency, call, hiddenIn(target, call.scene));
}

/// Draws the scene as far as the request allows.
void RenderStages::drawAll(ViewTarget& target, const RenderCall& call, Clock::time_point start, FrameStatus& status) {
    const bool waits = call.request.wait, finds = !call.plan.empty() && findsHidden(call.scene);
    // Occlusion in the last picture is a sufficient start.
    if (waits && finds && !target.hidden.any()) probe(target, call);
    bool any = false;
    do any = draw(target, call, start, status);
    while (waits && any && finds && reveals(target, call));
    // Occluded bricks may be coarse, but that they are occluded must be certain.
    if (any && finds) status.complete = status.complete && target.hidden.known();
}

} // namespace tessera::vis
