#include "vis/gl/warm_up.h"

#include <algorithm>
#include <bit>
#include <ctime>

namespace tessera::vis {

namespace {

constexpr GLuint kUnits = 50; // as many as numbered in ray_uniforms.h and present.cpp
struct Kind {
    GLenum binding, target;
};
constexpr Kind kKinds[] = {{GL_TEXTURE_BINDING_2D, GL_TEXTURE_2D},
                           {GL_TEXTURE_BINDING_3D, GL_TEXTURE_3D},
                           {GL_TEXTURE_BINDING_1D_ARRAY, GL_TEXTURE_1D_ARRAY},
                           {GL_TEXTURE_BINDING_2D_ARRAY, GL_TEXTURE_2D_ARRAY},
                           {GL_TEXTURE_BINDING_CUBE_MAP, GL_TEXTURE_CUBE_MAP}};
constexpr GLenum kSampling[] = {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER, GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T,
                                GL_TEXTURE_WRAP_R};
constexpr std::array<GLint, 5> kPlain{GL_NEAREST, GL_NEAREST, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE};

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

BoundTexture describe(GLuint unit, GLenum target, GLuint name) {
    BoundTexture out{.unit = unit, .target = target};
    GLint format = 0;
    glGetTextureLevelParameteriv(name, 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
    out.format = GLenum(format);
    glGetTextureLevelParameteriv(name, 0, GL_TEXTURE_WIDTH, &out.size.x);
    glGetTextureLevelParameteriv(name, 0, GL_TEXTURE_HEIGHT, &out.size.y);
    glGetTextureLevelParameteriv(name, 0, GL_TEXTURE_DEPTH, &out.size.z);
    for (std::size_t i = 0; i < out.sampling.size(); ++i) glGetTextureParameteriv(name, kSampling[i], &out.sampling[i]);
    return out;
}

/// A small texture like that one. Not by makeTexture2D() and the like, which clear it when debugging: see
/// drawNothing().
Texture alike(const BoundTexture& of) {
    const auto edge = [](int texels) { return std::has_single_bit(unsigned(std::max(texels, 1))) ? 4 : 3; };
    const glm::ivec3 size(edge(of.size.x), edge(of.size.y), edge(of.size.z));
    GLuint name = 0;
    glCreateTextures(of.target, 1, &name);
    Texture texture(name);
    if (of.target == GL_TEXTURE_3D || of.target == GL_TEXTURE_2D_ARRAY)
        glTextureStorage3D(name, 1, of.format, size.x, size.y, size.z);
    else
        glTextureStorage2D(name, 1, of.format, size.x, size.y);
    for (std::size_t i = 0; i < of.sampling.size(); ++i) glTextureParameteri(name, kSampling[i], of.sampling[i]);
    return texture;
}

/// Of all samplers of a program, element by element.
std::vector<std::pair<std::string, int>> samplerUnits(const Program& program) {
    std::vector<std::pair<std::string, int>> out;
    GLint count = 0;
    glGetProgramiv(program.name(), GL_ACTIVE_UNIFORMS, &count);
    for (GLint i = 0; i < count; ++i) {
        char text[128];
        GLsizei length = 0;
        GLint size = 0;
        GLenum type = 0;
        glGetActiveUniform(program.name(), GLuint(i), sizeof text, &length, &size, &type, text);
        if (!isSampler(type)) continue;
        const std::string name(text, std::size_t(length)), array = name.substr(0, name.find('['));
        for (GLint element = 0; element < size; ++element) {
            const std::string at = size > 1 ? array + '[' + std::to_string(element) + ']' : name;
            const GLint source = glGetUniformLocation(program.name(), at.c_str());
            GLint unit = 0;
            if (source < 0) continue;
            glGetUniformiv(program.name(), source, &unit);
            out.emplace_back(at, unit);
        }
    }
    return out;
}

double threadMilliseconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return double(time.tv_sec) * 1e3 + double(time.tv_nsec) * 1e-6;
}

} // namespace

DrawState captureDrawState(const Program& program, const Framebuffer& framebuffer) {
    DrawState state{.textures = {},
                    .colorFormats = {},
                    .samplers = samplerUnits(program),
                    .seamless = glIsEnabled(GL_TEXTURE_CUBE_MAP_SEAMLESS) == GL_TRUE};
    for (GLuint unit = 0; unit < kUnits; ++unit) {
        glActiveTexture(GL_TEXTURE0 + unit);
        for (const Kind& kind : kKinds) {
            GLint name = 0;
            glGetIntegerv(kind.binding, &name);
            if (name != 0) state.textures.push_back(describe(unit, kind.target, GLuint(name)));
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

double drawNothing(const Program& program, const DrawState& state) {
    const double start = threadMilliseconds();
    std::vector<Texture> colors, bound;
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    const Framebuffer framebuffer(name);
    std::vector<GLenum> buffers;
    for (const GLenum format : state.colorFormats) {
        buffers.push_back(GLenum(GL_COLOR_ATTACHMENT0 + colors.size()));
        colors.push_back(alike({.target = GL_TEXTURE_2D, .format = format, .size = {4, 4, 1}, .sampling = kPlain}));
        glNamedFramebufferTexture(name, buffers.back(), colors.back().name(), 0);
    }
    glNamedFramebufferDrawBuffers(name, GLsizei(buffers.size()), buffers.data());
    for (const BoundTexture& each : state.textures) {
        bound.push_back(alike(each));
        glBindTextureUnit(each.unit, bound.back().name());
    }
    for (const auto& [uniform, unit] : state.samplers) program.set(uniform.c_str(), unit);
    (state.seamless ? glEnable : glDisable)(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    const VertexArray vertices = makeVertexArray("warm-up");
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name);
    glViewport(0, 0, 4, 4);
    glEnable(GL_RASTERIZER_DISCARD);
    glUseProgram(program.name());
    glBindVertexArray(vertices.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glFinish();
    glDisable(GL_RASTERIZER_DISCARD);
    glUseProgram(0);
    glBindVertexArray(0);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    for (const BoundTexture& each : state.textures) glBindTextureUnit(each.unit, 0);
    while (glGetError() != GL_NO_ERROR) {
    } // only time is lost
    return threadMilliseconds() - start;
}

} // namespace tessera::vis
