#include "vis/gl/warm_up.h"

#include <algorithm>
#include <ctime>

namespace tessera::vis {

namespace {

constexpr GLuint kUnits = 50; // as many as numbered in ray_uniforms.h and present.cpp
constexpr GLenum kTextureBindings[] = {GL_TEXTURE_BINDING_2D,       GL_TEXTURE_BINDING_3D,
                                       GL_TEXTURE_BINDING_1D_ARRAY, GL_TEXTURE_BINDING_2D_ARRAY,
                                       GL_TEXTURE_BINDING_CUBE_MAP, GL_TEXTURE_BINDING_BUFFER};

bool isSampler(GLenum type) {
    switch (type) {
    case GL_SAMPLER_2D:
    case GL_SAMPLER_3D:
    case GL_SAMPLER_CUBE:
    case GL_SAMPLER_1D_ARRAY:
    case GL_SAMPLER_2D_ARRAY:
    case GL_SAMPLER_BUFFER:
    case GL_SAMPLER_2D_SHADOW:
    case GL_INT_SAMPLER_2D:
    case GL_INT_SAMPLER_3D:
    case GL_INT_SAMPLER_BUFFER:
    case GL_UNSIGNED_INT_SAMPLER_2D:
    case GL_UNSIGNED_INT_SAMPLER_3D:
    case GL_UNSIGNED_INT_SAMPLER_BUFFER:
        return true;
    default:
        return false;
    }
}

double threadMilliseconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return double(time.tv_sec) * 1e3 + double(time.tv_nsec) * 1e-6;
}

} // namespace

DrawState captureDrawState(const Framebuffer& framebuffer) {
    DrawState state;
    for (GLuint unit = 0; unit < kUnits; ++unit) {
        glActiveTexture(GL_TEXTURE0 + unit);
        for (const GLenum binding : kTextureBindings) {
            GLint name = 0;
            glGetIntegerv(binding, &name);
            if (name != 0) state.textures.emplace_back(unit, GLuint(name));
        }
    }
    glActiveTexture(GL_TEXTURE0);
    for (GLenum i = 0; i < 4; ++i) {
        const GLenum attachment = GL_COLOR_ATTACHMENT0 + i;
        GLint type = GL_NONE, name = 0, format = 0;
        glGetNamedFramebufferAttachmentParameteriv(framebuffer.name(), attachment,
                                                   GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &type);
        if (type != GL_TEXTURE) break;
        glGetNamedFramebufferAttachmentParameteriv(framebuffer.name(), attachment,
                                                   GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME, &name);
        glGetTextureLevelParameteriv(GLuint(name), 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
        state.colorFormats.push_back(GLenum(format));
    }
    return state;
}

double drawOnePixel(const Program& program, const DrawState& state) {
    const double start = threadMilliseconds();
    std::vector<Texture> colors;
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    const Framebuffer framebuffer(name);
    std::vector<GLenum> buffers;
    for (const GLenum format : state.colorFormats) {
        buffers.push_back(GLenum(GL_COLOR_ATTACHMENT0 + colors.size()));
        colors.push_back(makeTexture2D({4, 4}, format, GL_NEAREST, "warm-up"));
        glNamedFramebufferTexture(name, buffers.back(), colors.back().name(), 0);
    }
    glNamedFramebufferDrawBuffers(name, GLsizei(buffers.size()), buffers.data());
    for (const auto& [unit, texture] : state.textures)
        if (glIsTexture(texture)) glBindTextureUnit(unit, texture); // it may have been deleted since
    const VertexArray vertices = makeVertexArray("warm-up");
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name);
    glViewport(0, 0, 4, 4);
    glEnable(GL_SCISSOR_TEST);
    glScissor(1, 1, 1, 1);
    glUseProgram(program.name());
    glBindVertexArray(vertices.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glFinish();
    glUseProgram(0);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    for (const auto& [unit, texture] : state.textures) glBindTextureUnit(unit, 0); // release the references
    while (glGetError() != GL_NO_ERROR) {
    } // a texture was just deleted: only time is lost
    return threadMilliseconds() - start;
}

void copySamplerUnits(const Program& from, const Program& to) {
    GLint count = 0;
    glGetProgramiv(from.name(), GL_ACTIVE_UNIFORMS, &count);
    for (GLint i = 0; i < count; ++i) {
        char text[128];
        GLsizei length = 0;
        GLint size = 0;
        GLenum type = 0;
        glGetActiveUniform(from.name(), GLuint(i), sizeof text, &length, &size, &type, text);
        if (!isSampler(type)) continue;
        const std::string name(text, std::size_t(length)), array = name.substr(0, name.find('['));
        for (GLint element = 0; element < size; ++element) {
            const std::string at = size > 1 ? array + '[' + std::to_string(element) + ']' : name;
            const GLint source = glGetUniformLocation(from.name(), at.c_str());
            GLint unit = 0;
            if (source < 0) continue;
            glGetUniformiv(from.name(), source, &unit);
            glProgramUniform1i(to.name(), glGetUniformLocation(to.name(), at.c_str()), unit);
        }
    }
}

} // namespace tessera::vis
