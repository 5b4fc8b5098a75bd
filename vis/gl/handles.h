#pragma once

#include <epoxy/gl.h>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <utility>

/// Owners of GL objects: move-only; created by functions and deleted by the destructor, which needs the context to be
/// current.
namespace tessera::vis {

enum class ObjectKind { Buffer, Texture, Framebuffer, VertexArray, Query, Program };

void deleteObject(ObjectKind kind, GLuint name);

template <ObjectKind Kind> class Handle {
public:
    Handle() = default;
    explicit Handle(GLuint name) : name_(name) {}
    Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    ~Handle() {
        if (name_) deleteObject(Kind, name_);
    }
    GLuint name() const { return name_; }
    explicit operator bool() const { return name_ != 0; }

private:
    GLuint name_ = 0;
};

using Buffer = Handle<ObjectKind::Buffer>;
using Texture = Handle<ObjectKind::Texture>;
using Framebuffer = Handle<ObjectKind::Framebuffer>;
using VertexArray = Handle<ObjectKind::VertexArray>;
using Query = Handle<ObjectKind::Query>;
using ProgramObject = Handle<ObjectKind::Program>;

/// Longest edge in texels of a texture of this kind.
int longestEdge(GLenum target);

// Textures with one level of immutable storage, clamped to edge; `filter` is GL_NEAREST or GL_LINEAR. Each function
// throws MachineError when the driver refuses the size or has no memory. The initial content is undefined; with
// TESSERA_DEBUG_GL=nan in the environment it is NaN, or all bits set for integer formats.
Texture makeTexture2D(glm::ivec2 size, GLenum format, GLenum filter, const std::string& label);
/// An array of 1D textures, each filtered separately.
Texture makeTexture1DArray(int width, int rows, GLenum format, GLenum filter, const std::string& label);
Texture makeTexture3D(glm::ivec3 size, GLenum format, GLenum filter, const std::string& label);
/// A 3D texture of one texel.
Texture makeUniform3D(glm::vec4 value, const std::string& label);
Texture makeTexture2DArray(glm::ivec2 size, int layers, GLenum format, GLenum filter, const std::string& label);
/// A cube map with one level, filtered linearly, also across edges if GL_TEXTURE_CUBE_MAP_SEAMLESS is enabled.
Texture makeTextureCube(int edge, GLenum format, const std::string& label);
/// A framebuffer that writes to all given colour attachments. Throws MachineError when it is incomplete.
Framebuffer makeFramebuffer(std::initializer_list<GLuint> colorTextures, const std::string& label);
/// A buffer of fixed size. `content` null: written by GL later, NaN until then with TESSERA_DEBUG_GL=nan. `flags`: of
/// glNamedBufferStorage.
Buffer makeBuffer(GLsizeiptr bytes, const void* content, GLbitfield flags, const std::string& label);
VertexArray makeVertexArray(const std::string& label);

} // namespace tessera::vis
