#pragma once

#include "vis/bricks/texels.h"
#include "vis/gl/handles.h"

#include <glm/gtc/type_precision.hpp>
#include <optional>
#include <vector>

namespace tessera::vis {

GLenum texelFormat(int components, bool exact);
GLenum texelLayout(int components);

/// A 3D texture divided into slots of equal size, each for one brick with its halo.
class BrickAtlas {
public:
    /// Allocates at least `slots` slots, limited by the driver's maximal texture size. Throws MachineError when the
    /// driver refuses.
    BrickAtlas(int brickSize, int components, bool exact, std::size_t slots, int maxTextureSize);

    /// Reserves a slot with a reference count of 1 and returns its first texel; nullopt if the atlas is full.
    std::optional<glm::ivec3> allocate();
    /// Adds a reference to a slot: several times of a channel can share the same texels.
    void share(glm::ivec3 slot) { ++holders_[number(slot)]; }
    /// Removes a reference; without references the slot is free.
    void release(glm::ivec3 slot);
    void upload(glm::ivec3 slot, const TexelBlock& block);
    /// Copies a slot of another atlas of the same kind.
    void copy(const BrickAtlas& from, glm::ivec3 fromSlot, glm::ivec3 slot);

    GLuint texture() const { return texture_.name(); }
    glm::ivec3 size() const { return size_; }
    std::size_t capacity() const { return capacity_; }
    std::size_t unused() const { return free_.size(); }
    std::size_t bytes() const { return bytes_; }

private:
    Texture texture_;
    glm::ivec3 size_{0};
    std::size_t number(glm::ivec3 slot) const;

    std::size_t capacity_ = 0, bytes_ = 0;
    bool exact_ = false;
    int edge_ = 0;
    std::vector<glm::ivec3> free_;
    std::vector<int> holders_; ///< reference count per slot
};

/// Page table of one channel: for each brick at full resolution, the first texel of its part of a slot and the level
/// stored there, or kAbsent (no present sample) or kNowhere (not resident).
struct PageTable {
    static constexpr std::uint16_t kNowhere = 254, kAbsent = 255;
    explicit PageTable(glm::ivec3 bricks);
    void upload();

    Texture texture;
    glm::ivec3 count{0};
    std::vector<glm::u16vec4> pages; ///< x fastest; what the texture holds after upload()
};

} // namespace tessera::vis
