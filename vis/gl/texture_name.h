#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

/// Pictures that ImGui shows, in OpenGL or in memory.
namespace tessera::vis {

/// Where pictures are kept until they are shown.
enum class TexturesIn { OpenGl, Memory };

/// What ImGui knows a picture by: its GL name or, in memory, the address of a MemoryTexture. 0: none.
using TextureName = std::uintptr_t;

/// A picture that no GL texture holds: RGBA8, rows in the order in which GL would have them.
struct MemoryTexture {
    glm::ivec2 size{0};
    std::vector<std::uint8_t> rgba;
    bool smooth = true; ///< interpolated where it is magnified, as it always is where it is minified

    TextureName name() const { return reinterpret_cast<TextureName>(this); }
};

} // namespace tessera::vis
