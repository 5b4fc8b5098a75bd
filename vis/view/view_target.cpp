#include "vis/view/view_target.h"

#include <utility>

namespace tessera::vis {

void ViewTarget::resize(glm::ivec2 wanted, bool exact) {
    if (buffers.size == wanted) return;
    PictureBuffers made = PictureBuffers::make(wanted, exact);
    hidden.resize(wanted);
    buffers = std::move(made);
    shown.started = false;
    state = {};
    redraw(buffers.everything());
}

void ViewTarget::redraw(const Tile& part) {
    if (part.empty()) return;
    state.redraw(part);
    hidden.forgetPicture();
    geometry.forget();
}

} // namespace tessera::vis
