#include "vis/passes/view_hidden.h"

#include "volume/base/error.h"

namespace tessera::vis {

void ViewHidden::forgetData() {
    hidden_.learn({}, false);
    scene_ = 0;
}

void ViewHidden::start(RenderTools& tools, const RenderCall& call, const PictureBuffers& buffers,
                       const PictureState& state, std::uint64_t scene) {
    const bool quick = std::exchange(reducedDrawn_, false) && state.reduced() == buffers.everything();
    const bool last = state.still() && !known_;
    if (reach_.pending() || !(quick || last)) return;
    const Program* program =
        tools.programs.find({"screen.vert.glsl", "reach.frag.glsl", {}, {{"TILE", std::to_string(kReachTile)}}});
    if (!program) throw Error("the shader that reads back ray ends does not compile");
    const RayBuffer& from = last ? buffers.full : buffers.reduced;
    glDisable(GL_SCISSOR_TEST);
    reach_.start(*program, tools.vertices.name(), from.reach.name(), from.first, from.used, call.scene.camera,
                 call.frame());
    reachScene_ = scene;
    final_ = last;
}

void ViewHidden::take(bool wait, const volume::BrickGrid* grid) {
    const std::optional<ReachMap> map = reach_.take(wait);
    if (!map || !grid) return;
    hidden_.learn(hiddenBricks(*map, *grid), scene_ == reachScene_);
    scene_ = reachScene_;
    known_ = known_ || final_;
}

} // namespace tessera::vis
