#include "vis/passes/stereo_picture.h"

#include "vis/gl/handles.h"
#include "vis/gl/program.h"
#include "vis/processor/anaglyph.h"

#include <glm/common.hpp>

namespace tessera::vis {

struct StereoPicture::Impl {
    Program program;
    VertexArray array;
    Texture picture;
    Framebuffer framebuffer;
    glm::ivec2 size{0};
    MemoryTexture made; ///< without OpenGL
};

StereoPicture::StereoPicture() : impl_(std::make_unique<Impl>()) {}
StereoPicture::~StereoPicture() = default;
StereoPicture::StereoPicture(StereoPicture&&) noexcept = default;
StereoPicture& StereoPicture::operator=(StereoPicture&&) noexcept = default;

TextureName StereoPicture::combine(TexturesIn where, TextureName left, TextureName right, glm::ivec2 size) {
    Impl& own = *impl_;
    if (left == 0 || right == 0) return 0;
    if (where == TexturesIn::Memory) {
        own.made =
            anaglyphOf(*reinterpret_cast<const MemoryTexture*>(left), *reinterpret_cast<const MemoryTexture*>(right));
        return own.made.name();
    }
    if (!own.program) own.program = makeProgram({"screen.vert.glsl", "anaglyph.frag.glsl", {}, {}});
    if (!own.array) own.array = makeVertexArray("anaglyph");
    const glm::ivec2 wanted = glm::max(size, glm::ivec2(1));
    if (own.size != wanted) {
        own.picture = makeTexture2D(wanted, GL_RGBA8, GL_LINEAR, "anaglyph");
        own.framebuffer = makeFramebuffer({own.picture.name()}, "anaglyph");
        own.size = wanted;
    }
    own.program.set("left", 0);
    own.program.set("right", 1);
    glBindTextureUnit(0, GLuint(left));
    glBindTextureUnit(1, GLuint(right));
    glViewport(0, 0, wanted.x, wanted.y);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, own.framebuffer.name());
    glUseProgram(own.program.name());
    glBindVertexArray(own.array.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    return own.picture.name();
}

} // namespace tessera::vis
