#include "vis/passes/view_target.h"

#include <utility>

namespace tessera::vis {

void RayBuffer::resize(glm::ivec2 wanted, bool exact, const char* label) {
    if (size == wanted) return;
    RayBuffer made;
    made.color = makeTexture2D(wanted, exact ? GL_RGBA32F : GL_RGBA16F, GL_LINEAR, label);
    made.pick = makeTexture2D(wanted, GL_RG32F, GL_NEAREST, label);
    made.reach = makeTexture2D(wanted, GL_R32F, GL_NEAREST, label);
    made.framebuffer = makeFramebuffer({made.color.name(), made.pick.name(), made.reach.name()}, label);
    made.size = wanted;
    made.clear(); // pictures and positions are read before every tile of the first one is drawn
    *this = std::move(made);
}

void RayBuffer::clear() const {
    const float empty[] = {0, 0, 0, 0}, nowhere[] = {-1e9f, 0, 0, 0}, endless[] = {1e9f, 0, 0, 0};
    glDisable(GL_SCISSOR_TEST);
    glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, 0, empty);
    glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, 1, nowhere);
    glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, 2, endless);
}

void ViewTarget::resize(glm::ivec2 wanted, bool exact) {
    if (size == wanted) return;
    RayBuffer whole, quick;
    whole.resize(wanted, exact, "picture");
    quick.resize(wanted, exact, "reduced picture");
    Texture made = makeTexture2D(wanted, GL_RGBA8, GL_LINEAR, "presented picture");
    Framebuffer framebuffer = makeFramebuffer({made.name()}, "presented picture");
    reach.resize(wanted);
    full = std::move(whole);
    reduced = std::move(quick);
    output = std::move(made);
    outputFramebuffer = std::move(framebuffer);
    size = wanted;
    started = shows = stillDone = false;
    changed = stale = {};
    redraw(everything());
}

void ViewTarget::redraw(const Tile& part) {
    if (part.empty()) return;
    stale = stillDone ? part : united(stale, part);
    changed = united(changed, part);
    reducedValid = fullValid = stillDone = false;
    hiddenKnown = reachFinal = false;
    tilesDone = 0;
    geometrySize = {0, 0};
}

void ViewTargetDeleter::operator()(ViewTarget* target) const {
    delete target;
}

} // namespace tessera::vis
