#pragma once

#include "vis/gl/handles.h"

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Programs composed of the files in vis/shaders.
///
///     Program program = makeProgram({.vertex = "screen.vert.glsl", .fragment = "raycast.frag.glsl",
///                                    .slots = {{"reconstruct", "slots/recon_cc_linear.glsl"}},
///                                    .defines = {{"LAYERS", "2"}}});
///     program.set("halfSize", glm::vec3(0.5f));
namespace tessera::vis {

/// The files of a program. `#include "path"` names a file relative to vis/shaders; `#include <slot:name>` names the
/// file that `slots` assigns to the slot. Each file is included once.
struct ProgramRecipe {
    std::string vertex, fragment;
    std::map<std::string, std::string> slots;
    std::vector<std::pair<std::string, std::string>>
        defines; ///< emitted as `#define first second` after shaderConstants()

    /// Equal for equal recipes: the key of a program cache.
    std::string key() const;
};

/// `member` of the i-th element of `all` as a GLSL expression in i that folds to a constant once a loop is unrolled.
/// (Not a constant array: Mesa turns arrays into uniforms before unrolling.)
template <class Each, class Member> std::string choice(const std::vector<Each>& all, Member member) {
    std::string chain = "0";
    for (std::size_t i = all.size(); i-- > 0;) {
        std::string outer = "((i)==";
        outer += std::to_string(i);
        outer += '?';
        outer += std::to_string(int(member(all[i])));
        outer += ':';
        outer += chain;
        outer += ')';
        chain = std::move(outer);
    }
    return chain;
}

/// Source of one stage after includes and slots are resolved. `#line` numbers are file * 10000 + line; `files[file]` is
/// the path.
struct ComposedShader {
    std::string text;
    std::vector<std::string> files;
};

/// Resolves includes and slots. Throws Error naming the file and line of a missing include or slot.
ComposedShader composeShader(const std::string& root, const ProgramRecipe& recipe);

/// The composed source of both stages, which any thread can compile.
struct ProgramText {
    std::string vertex, fragment; ///< file names
    ComposedShader vertexShader, fragmentShader;
};
ProgramText composeProgram(const ProgramRecipe& recipe);

/// Replaces "file * 10000 + line" in a compiler's message by "path:line".
std::string mapLines(std::string_view log, const std::vector<std::string>& files);

/// Source of a shader file: from the folder in the environment variable TESSERA_SHADER_DIR if it is set and has the
/// file (for shader development), else the embedded text. Null if it does not exist.
const std::string* shaderText(const std::string& path);

class Program {
public:
    Program() = default;
    explicit Program(ProgramObject object) : object_(std::move(object)) {}
    GLuint name() const { return object_.name(); }
    explicit operator bool() const { return bool(object_); }

    /// Sets a uniform; ignored if the compiler removed it.
    void set(const char* uniform, int value) const;
    void set(const char* uniform, float value) const;
    void set(const char* uniform, glm::ivec3 value) const;
    void set(const char* uniform, glm::vec2 value) const;
    void set(const char* uniform, glm::vec3 value) const;
    void set(const char* uniform, glm::vec4 value) const;
    void set(const char* uniform, const glm::mat3& value) const;
    void set(const char* uniform, std::span<const int> values) const;
    void set(const char* uniform, std::span<const float> values) const;
    void set(const char* uniform, std::span<const glm::ivec4> values) const;
    void set(const char* uniform, std::span<const glm::vec2> values) const;
    void set(const char* uniform, std::span<const glm::vec3> values) const;
    void set(const char* uniform, std::span<const glm::vec4> values) const;

private:
    GLint location(const char* uniform) const;
    ProgramObject object_;
    mutable std::map<std::string, GLint, std::less<>> locations_;
};

/// Composes, compiles and links. Throws Error with "path:line: text" lines when the compiler refuses.
Program makeProgram(const ProgramRecipe& recipe);
/// Compiles and links composed shaders.
Program linkProgram(const ProgramText& text);

/// A linked program as the driver stores it, which contexts that share nothing can exchange. Empty: it stores none.
struct ProgramBinary {
    GLenum format = GL_NONE;
    std::vector<std::byte> bytes;
};
ProgramBinary binaryOf(const Program& program);
/// The program of a binary, with the uniforms of a new one; from `text` where the driver does not take the binary.
Program loadProgram(const ProgramBinary& binary, const ProgramText& text);

} // namespace tessera::vis
