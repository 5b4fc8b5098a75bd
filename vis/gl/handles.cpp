#include "vis/gl/handles.h"

#include "volume/base/error.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <vector>

namespace tessera::vis {

void deleteObject(ObjectKind kind, GLuint name) {
    switch (kind) {
    case ObjectKind::Buffer:
        return glDeleteBuffers(1, &name);
    case ObjectKind::Texture:
        return glDeleteTextures(1, &name);
    case ObjectKind::Framebuffer:
        return glDeleteFramebuffers(1, &name);
    case ObjectKind::VertexArray:
        return glDeleteVertexArrays(1, &name);
    case ObjectKind::Query:
        return glDeleteQueries(1, &name);
    case ObjectKind::Program:
        return glDeleteProgram(name);
    }
}

namespace {

void setUp(GLuint name, GLenum filter, const std::string& label) {
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(filter));
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(filter));
    for (GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTextureParameteri(name, wrap, GL_CLAMP_TO_EDGE);
    glObjectLabel(GL_TEXTURE, name, -1, label.c_str());
}

bool fillsWithNan() {
    static const bool fills = [] {
        const char* mode = std::getenv("TESSERA_DEBUG_GL");
        return mode != nullptr && std::string_view(mode) == "nan";
    }();
    return fills;
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Fills a new texture with values that are conspicuous if read before written.
void fill(GLuint texture) {
    GLint type = GL_NONE;
    glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_RED_TYPE, &type);
    if (type == GL_UNSIGNED_INT) {
        constexpr std::array<GLuint, 4> kAll{~0u, ~0u, ~0u, ~0u};
        glClearTexImage(texture, 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT, kAll.data());
    } else if (type != GL_NONE) { // depth formats have no NaN and are always cleared
        const float value = type == GL_FLOAT ? kNan : 1;
        const std::array texel{value, value, value, value};
        glClearTexImage(texture, 0, GL_RGBA, GL_FLOAT, texel.data());
    }
    glFinish(); // zink of Mesa 25.0 may fill it after what is drawn or cleared later
}

/// A texture; `allocate` creates its storage.
template <class Allocate>
Texture checked(GLenum target, glm::ivec3 size, GLenum filter, const std::string& label, Allocate&& allocate) {
    GLuint name = 0;
    glCreateTextures(target, 1, &name);
    Texture texture(name);
    while (glGetError() != GL_NO_ERROR) {
    }
    const bool fits = std::max({size.x, size.y, size.z}) <= longestEdge(target);
    if (fits) allocate(name);
    if (!fits || glGetError() != GL_NO_ERROR)
        throw MachineError("the graphics driver refuses a texture of " + std::to_string(size.x) + " x " +
                               std::to_string(size.y) + " x " + std::to_string(size.z) + " texels",
                           {}, label);
    setUp(name, filter, label);
    if (fillsWithNan()) fill(name);
    return texture;
}

} // namespace

int longestEdge(GLenum target) {
    GLint edge = 0;
    glGetIntegerv(target == GL_TEXTURE_3D         ? GL_MAX_3D_TEXTURE_SIZE
                  : target == GL_TEXTURE_CUBE_MAP ? GL_MAX_CUBE_MAP_TEXTURE_SIZE
                                                  : GL_MAX_TEXTURE_SIZE,
                  &edge);
    return edge;
}

Texture makeTexture2D(glm::ivec2 size, GLenum format, GLenum filter, const std::string& label) {
    return checked(GL_TEXTURE_2D, {size, 1}, filter, label,
                   [&](GLuint name) { glTextureStorage2D(name, 1, format, size.x, size.y); });
}

Texture makeTexture1DArray(int width, int rows, GLenum format, GLenum filter, const std::string& label) {
    return checked(GL_TEXTURE_1D_ARRAY, {width, rows, 1}, filter, label,
                   [&](GLuint name) { glTextureStorage2D(name, 1, format, width, rows); });
}

Texture makeTexture3D(glm::ivec3 size, GLenum format, GLenum filter, const std::string& label) {
    return checked(GL_TEXTURE_3D, size, filter, label,
                   [&](GLuint name) { glTextureStorage3D(name, 1, format, size.x, size.y, size.z); });
}

Texture makeUniform3D(glm::vec4 value, const std::string& label) {
    Texture texture = makeTexture3D({1, 1, 1}, GL_RGBA16F, GL_LINEAR, label);
    glTextureSubImage3D(texture.name(), 0, 0, 0, 0, 1, 1, 1, GL_RGBA, GL_FLOAT, &value.x);
    return texture;
}

Texture makeTexture2DArray(glm::ivec2 size, int layers, GLenum format, GLenum filter, const std::string& label) {
    return checked(GL_TEXTURE_2D_ARRAY, {size, 1}, filter, label,
                   [&](GLuint name) { glTextureStorage3D(name, 1, format, size.x, size.y, layers); });
}

Texture makeTextureCube(int edge, GLenum format, const std::string& label) {
    return checked(GL_TEXTURE_CUBE_MAP, {edge, edge, 6}, GL_LINEAR, label,
                   [&](GLuint name) { glTextureStorage2D(name, 1, format, edge, edge); });
}

Framebuffer makeFramebuffer(std::initializer_list<GLuint> colorTextures, const std::string& label) {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    Framebuffer framebuffer(name);
    std::vector<GLenum> buffers;
    for (GLuint texture : colorTextures) {
        buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(buffers.size()));
        glNamedFramebufferTexture(name, buffers.back(), texture, 0);
    }
    glNamedFramebufferDrawBuffers(name, static_cast<GLsizei>(buffers.size()), buffers.data());
    glObjectLabel(GL_FRAMEBUFFER, name, -1, label.c_str());
    if (glCheckNamedFramebufferStatus(name, GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw MachineError("the graphics driver refuses the framebuffer", {}, label);
    return framebuffer;
}

Buffer makeBuffer(GLsizeiptr bytes, const void* content, GLbitfield flags, const std::string& label) {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    Buffer buffer(name);
    glNamedBufferStorage(name, bytes, content, flags);
    glObjectLabel(GL_BUFFER, name, -1, label.c_str());
    if (!content && fillsWithNan()) {
        glClearNamedBufferData(name, GL_R32F, GL_RED, GL_FLOAT, &kNan);
        glFinish(); // as in fill()
    }
    return buffer;
}

VertexArray makeVertexArray(const std::string& label) {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    glObjectLabel(GL_VERTEX_ARRAY, name, -1, label.c_str());
    return VertexArray(name);
}

} // namespace tessera::vis
