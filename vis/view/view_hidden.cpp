#include "vis/view/view_hidden.h"

#include "volume/base/error.h"

namespace tessera::vis {

void ViewHidden::forgetData() {
    hidden_.learn({}, false);
    scene_ = 0;
}

void ViewHidden::start(RenderTools& tools, const RenderCall& call, const PictureBuffers& buffers,
                       const PictureState& state, std::uint64_t scene) {
    const bool quick = std::exchange(reducedDrawn_, false) && state.reduced() == buffers.everything();
    const bool last = state.converged() && !known_;
    if (termination_.pending() || !(quick || last)) return;
    const Program* program = tools.programs.find(
        {"screen.vert.glsl", "termination.frag.glsl", {}, {{"TILE", std::to_string(kTerminationTile)}}});
    if (!program) throw Error("the shader that reads back ray ends does not compile");
    const RayBuffer& from = last ? buffers.full : buffers.reduced;
    glDisable(GL_SCISSOR_TEST);
    termination_.start(*program, tools.vertices.name(), from.termination.name(), from.first, from.used,
                       call.scene.camera, call.frame());
    terminationScene_ = scene;
    final_ = last;
}

void ViewHidden::take(bool wait, const volume::BrickGrid* grid) {
    const std::optional<TerminationMap> map = termination_.take(wait);
    if (!map || !grid) return;
    hidden_.learn(hiddenBricks(*map, *grid), scene_ == terminationScene_);
    scene_ = terminationScene_;
    known_ = known_ || final_;
}

} // namespace tessera::vis
