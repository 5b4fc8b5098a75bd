#include "vis/passes/renderer_impl.h"

#include "vis/optics/proxy.h"
#include "vis/raycast/lens_uniforms.h"
#include "volume/base/error.h"

namespace tessera::vis {

/// Whether pictures of the scene tell which bricks they hide. Where a lens magnifies, rays see other places than those
/// they pass.
bool Renderer::Impl::findsHidden(const Scene& scene) const {
    return scene.render.cullHidden && residency.bricked() && !lensesBend(scene) && !drawnByProxy(scene) &&
           !options.countSamples;
}

/// Begins to read back what the picture just drawn hides.
void Renderer::Impl::startReach(ViewTarget& target, const Scene& scene) {
    const bool quick =
        std::exchange(target.reducedDrawn, false) && target.reducedValid && target.reducedTile == target.everything();
    const bool last = target.fullValid && target.stillDone && !target.hiddenKnown;
    if (target.reach.pending() || !(quick || last)) return;
    const Program* program =
        programs.find({"screen.vert.glsl", "reach.frag.glsl", {}, {{"TILE", std::to_string(kReachTile)}}});
    if (!program) throw Error("the program that reads back ray ends does not compile");
    const RayBuffer& from = last ? target.full : target.reduced;
    glDisable(GL_SCISSOR_TEST);
    target.reach.start(*program, vertices.name(), from.reach.name(), from.first,
                       last ? target.size : target.reducedSize, scene.camera,
                       worldFrame(source->info().bounds, scene.stretch));
    target.reachScene = target.sceneNumber;
    target.reachFinal = last;
}

/// Takes what has come back; `wait`: until it has.
void Renderer::Impl::takeReach(ViewTarget& target, bool wait) {
    const std::optional<ReachMap> map = target.reach.take(wait);
    if (!map || target.source != source.get()) return;
    target.hidden.learn(hiddenBricks(*map, source->grid()), target.hiddenScene == target.reachScene);
    target.hiddenScene = target.reachScene;
    target.hiddenKnown = target.hiddenKnown || target.reachFinal;
}

/// Draws the scene small from the coarsest bricks, then from more and more of the others, nearest first, so that most
/// of what they hide is never asked for.
void Renderer::Impl::probe(ViewTarget& target, const Scene& scene, const FrameRequest& request, RayPlan& plan) {
    ++target.sceneNumber;
    target.scene = scene;
    target.source = source.get();
    for (const double share : {0.0, 0.125, 0.25, 0.5}) {
        target.share = share;
        FrameStatus unused;
        if (!bind(target, scene, request, plan, unused)) break;
        target.redraw(target.everything());
        refine(target, scene, request, plan, Clock::now());
        startReach(target, scene);
        takeReach(target, true);
    }
    target.share = 1;
}

/// Whether the finished picture shows bricks that were taken to be hidden: what is wanted then is something else.
bool Renderer::Impl::reveals(ViewTarget& target, const Scene& scene, const FrameRequest& request, const RayPlan& plan) {
    takeReach(target, true);
    return demandBricks(target, scene, request, plan, target.shown);
}

} // namespace tessera::vis
