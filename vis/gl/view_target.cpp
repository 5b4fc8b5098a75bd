#include "vis/gl/view_target.h"

namespace tessera::vis {

void RayBuffer::resize(glm::ivec2 wanted, bool exact, const char* label) {
    if (size == wanted) return;
    color = makeTexture2D(wanted, exact ? GL_RGBA32F : GL_RGBA16F, GL_LINEAR, label);
    pick = makeTexture2D(wanted, GL_RG32F, GL_NEAREST, label);
    framebuffer = makeFramebuffer({color.name(), pick.name()}, label);
    size = wanted;
}

void ViewTarget::resize(glm::ivec2 wanted, bool exact) {
    if (size == wanted) return;
    size = wanted;
    full.resize(wanted, exact, "picture");
    reduced.resize(wanted, exact, "reduced picture");
    output = makeTexture2D(wanted, GL_RGBA8, GL_LINEAR, "presented picture");
    outputFramebuffer = makeFramebuffer({output.name()}, "presented picture");
    started = shows = stillDone = false;
    changed = stale = {};
    redraw(everything());
}

void ViewTarget::redraw(const Tile& part) {
    if (part.empty()) return;
    stale = stillDone ? part : united(stale, part);
    changed = united(changed, part);
    reducedValid = fullValid = stillDone = false;
    tilesDone = 0;
    geometrySize = {0, 0};
}

void ViewTargetDeleter::operator()(ViewTarget* target) const {
    delete target;
}

} // namespace tessera::vis
