#include "vis/view/picture.h"

namespace tessera::vis {

namespace {

RayBuffer makeRayBuffer(glm::ivec2 size, bool exact, const char* label) {
    RayBuffer made;
    made.color = makeTexture2D(size, exact ? GL_RGBA32F : GL_RGBA16F, GL_LINEAR, label);
    made.pick = makeTexture2D(size, GL_RG32F, GL_NEAREST, label);
    made.termination = makeTexture2D(size, GL_R32F, GL_NEAREST, label);
    made.framebuffer = makeFramebuffer({made.color.name(), made.pick.name(), made.termination.name()}, label);
    made.size = made.used = size;
    made.clear(); // unwritten pixels may be read: the picture is presented before all tiles are drawn
    return made;
}

} // namespace

void RayBuffer::clear() {
    const float empty[] = {0, 0, 0, 0}, nowhere[] = {-1e9f, 0, 0, 0}, endless[] = {1e9f, 0, 0, 0};
    glDisable(GL_SCISSOR_TEST);
    glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, 0, empty);
    glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, 1, nowhere);
    glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, 2, endless);
    drawn = {};
}

PictureBuffers PictureBuffers::make(glm::ivec2 size, bool exact) {
    PictureBuffers made;
    made.size = size;
    made.full = makeRayBuffer(size, exact, "picture");
    made.half = makeRayBuffer((size + 1) / 2, exact, "picture of half resolution");
    made.reduced = makeRayBuffer(size, exact, "reduced picture");
    made.output = makeTexture2D(size, GL_RGBA8, GL_LINEAR, "presented picture");
    made.outputFramebuffer = makeFramebuffer({made.output.name()}, "presented picture");
    return made;
}

void PictureState::redraw(const Tile& part) {
    if (part.empty()) return;
    stale_ = converged() ? part : united(stale_, part);
    changed_ = united(changed_, part);
    reduced_.reset();
    half_.reset();
    done_ = Done::Nothing;
    tilesDone_ = halfTilesDone_ = 0;
}

void PictureState::drewPass() {
    done_ = Done::Full;
    changed_ = {};
}

void PictureState::drewReduced() {
    reduced_ = changed_;
    changed_ = {};
}

} // namespace tessera::vis
