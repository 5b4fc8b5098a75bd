#pragma once

#include "vis/gl/handles.h"
#include "vis/gl/texels.h"

#include <glm/gtc/type_precision.hpp>
#include <optional>
#include <vector>

namespace tessera::vis {

GLenum texelFormat(int components, bool exact);
GLenum texelLayout(int components);

/// A 3D texture of equal slots, each for one brick with its halo.
class BrickAtlas {
public:
    /// Room for at least `slots` bricks as far as the driver's texture size allows. Throws MachineError when refused.
    BrickAtlas(int brickSize, int components, bool exact, std::size_t slots, int maxTextureSize);

    /// First texel of a free slot; nullopt when full.
    std::optional<glm::ivec3> allocate();
    void release(glm::ivec3 slot) { free_.push_back(slot); }
    void upload(glm::ivec3 slot, const TexelBlock& block);

    GLuint texture() const { return texture_.name(); }
    glm::ivec3 size() const { return size_; }
    std::size_t capacity() const { return capacity_; }
    std::size_t bytes() const { return bytes_; }

private:
    Texture texture_;
    glm::ivec3 size_{0};
    std::size_t capacity_ = 0, bytes_ = 0;
    bool exact_ = false;
    std::vector<glm::ivec3> free_;
};

/// Where the bricks of one channel are. Texel of the page table: first texel of the slot, then kAbsent, kCoarse or
/// kResident.
struct PageTable {
    static constexpr std::uint16_t kCoarse = 0, kResident = 1, kAbsent = 2;
    explicit PageTable(glm::ivec3 bricks);
    void set(glm::ivec3 brick, glm::ivec3 slot, std::uint16_t state);

    Texture texture;
    glm::ivec3 count{0};
    std::vector<glm::u16vec4> pages; ///< what the texture holds, x fastest
};

} // namespace tessera::vis
