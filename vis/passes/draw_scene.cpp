#include "vis/passes/draw_scene.h"

#include "vis/passes/gl_frame.h"
#include "vis/passes/present.h"
#include "volume/base/error.h"

#include <algorithm>
#include <utility>

namespace tessera::vis {

namespace {

constexpr std::size_t kUploadPerFrame = std::size_t(24) << 20;

/// The bricks that the last picture of these data occluded; null if they cannot be used for a scene.
const HiddenInView* hiddenIn(const RendererState& shared, const ViewTarget& target, const Scene& scene) {
    return findsHidden(shared, scene) && target.shown.source == shared.source.get() ? &target.hidden.bricks() : nullptr;
}

void takeHidden(RendererState& shared, ViewTarget& target, bool wait) {
    target.hidden.take(wait,
                       target.shown.source == shared.source.get() && shared.source ? &shared.source->grid() : nullptr);
}

/// Requests what the plan samples and binds the resident part; false if it cannot be drawn yet.
bool bindData(RendererState& shared, ViewTarget& target, const RenderCall& call, FrameStatus& status) {
    takeHidden(shared, target, false);
    const std::optional<double> former = target.demand.time();
    const bool any = target.demand.bind(shared.residency, call, hiddenIn(shared, target, call.scene), status);
    if (target.demand.time() != former) ++target.shown.number;
    return any;
}

/// Requests the data of the scene and draws or refines what is resident; false if nothing can be drawn.
bool drawResident(RendererState& shared, ViewTarget& target, const RenderCall& call, Clock::time_point start,
                  FrameStatus& status) {
    const bool any = !call.plan.empty() && bindData(shared, target, call, status);
    // What the processor draws meanwhile has samples of its own.
    showScene(shared, target, call.scene, target.meanwhile ? target.shown.resident : shared.residency.revision());
    target.shown.compiling = false;
    if (any) {
        refineByOpenGl(shared, target, call, start);
        if (findsHidden(shared, call.scene) && !target.meanwhile)
            target.hidden.start(shared.tools, call, target.buffers, target.state, target.shown.number);
    } else if (!target.state.full()) {
        const bool comes = !call.plan.empty() && !status.complete;
        status.waits = comes;
        if (comes && !target.state.presented() && !call.request.wait)
            showBlank(shared, target, call.scene);
        else if (!comes || !target.state.presented())
            showNothing(shared, target, call.scene);
    }
    return any;
}

/// Draws small pictures from the coarsest bricks, then with growing shares of the others, nearest first, so that most
/// occluded bricks are never requested.
void probe(RendererState& shared, ViewTarget& target, const RenderCall& call) {
    ++target.shown.number;
    target.shown.scene = call.scene;
    target.shown.source = shared.source.get();
    for (const double share : {0.0, 0.125, 0.25, 0.5}) {
        target.demand.setShare(share);
        FrameStatus unused;
        if (!bindData(shared, target, call, unused)) break;
        target.redraw(target.buffers.everything());
        refineByOpenGl(shared, target, call, Clock::now());
        target.hidden.start(shared.tools, call, target.buffers, target.state, target.shown.number);
        takeHidden(shared, target, true);
    }
    target.demand.setShare(1);
}

/// Whether the finished picture shows bricks assumed to be occluded, so that other bricks are wanted.
bool reveals(RendererState& shared, ViewTarget& target, const RenderCall& call) {
    takeHidden(shared, target, true);
    return target.demand.chooseAgain(shared.residency, call, hiddenIn(shared, target, call.scene));
}

} // namespace

bool resizeTarget(RendererState& shared, ViewTarget& target, const FrameRequest& request) {
    try {
        target.resize(request.size, shared.options.exactTextures);
        return true;
    } catch (const MachineError& error) {
        if (request.wait) throw;
        if (shared.refusal != error.what()) shared.tools.messages.push_back(error.what());
        shared.refusal = error.what();
        return false;
    }
}

void beginFrame(RendererState& shared, ViewTarget& target, const Scene& scene, const FrameRequest& request) {
    const RenderLimits& given = scene.render.limits;
    shared.residency.setBudgets(std::min(shared.options.textureBudget, std::size_t(given.textureMemory) << 20),
                                std::min(shared.options.memoryBudget, std::size_t(given.brickMemory) << 20));
    shared.residency.setKeptChange(double(given.keptChange));
    // A window draws each target once per frame; a picture drawn with `wait` counts as a frame of its own.
    if (request.wait || target.shown.frame == shared.residency.frame()) shared.residency.beginFrame();
    target.shown.frame = shared.residency.frame();
    shared.residency.update(request.wait ? ~std::size_t(0) : kUploadPerFrame);
}

void drawAll(RendererState& shared, ViewTarget& target, const RenderCall& call, Clock::time_point start,
             FrameStatus& status) {
    const bool waits = call.request.wait, finds = !call.plan.empty() && findsHidden(shared, call.scene);
    // Occlusion in the last picture is a sufficient start.
    if (waits && finds && !target.hidden.any()) probe(shared, target, call);
    bool any = false;
    do any = drawResident(shared, target, call, start, status);
    while (waits && any && finds && reveals(shared, target, call));
    // Occluded bricks may be coarse, but that they are occluded must be certain.
    if (any && finds) status.complete = status.complete && target.hidden.known();
}

} // namespace tessera::vis
