#include "vis/gl/brick_atlas.h"

#include <algorithm>
#include <cmath>

namespace tessera::vis {

GLenum texelFormat(int components, bool exact) {
    switch (components) {
    case 1:
        return exact ? GL_R32F : GL_R16;
    case 2:
        return exact ? GL_RG32F : GL_RG16;
    default:
        return exact ? GL_RGBA32F : GL_RGBA16;
    }
}

GLenum texelLayout(int components) {
    return components == 1 ? GL_RED : components == 2 ? GL_RG : GL_RGBA;
}

BrickAtlas::BrickAtlas(int brickSize, int components, bool exact, std::size_t slots, int maxTextureSize)
    : exact_(exact) {
    const int edge = brickSize + 2 * kHalo, most = std::max(1, maxTextureSize / edge);
    // As cubic as possible.
    glm::ivec3 count(1);
    count.x = std::clamp(int(std::ceil(std::cbrt(double(slots)))), 1, most);
    count.y = std::clamp(int(std::ceil(std::sqrt(double(slots) / count.x))), 1, most);
    count.z = std::clamp(int(std::ceil(double(slots) / count.x / count.y)), 1, most);
    size_ = count * edge;
    capacity_ = std::size_t(count.x) * std::size_t(count.y) * std::size_t(count.z);
    bytes_ = capacity_ * std::size_t(edge) * std::size_t(edge) * std::size_t(edge) * std::size_t(components) *
             (exact ? 4 : 2);
    texture_ = makeTexture3D(size_, texelFormat(components, exact), GL_LINEAR, "brick atlas");
    for (int z = count.z - 1; z >= 0; --z)
        for (int y = count.y - 1; y >= 0; --y)
            for (int x = count.x - 1; x >= 0; --x) free_.push_back(glm::ivec3(x, y, z) * edge);
}

std::optional<glm::ivec3> BrickAtlas::allocate() {
    if (free_.empty()) return std::nullopt;
    const glm::ivec3 slot = free_.back();
    free_.pop_back();
    return slot;
}

void BrickAtlas::upload(glm::ivec3 slot, const TexelBlock& block) {
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage3D(texture_.name(), 0, slot.x, slot.y, slot.z, block.size.x, block.size.y, block.size.z,
                        texelLayout(block.components), exact_ ? GL_FLOAT : GL_UNSIGNED_SHORT, block.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

PageTable::PageTable(glm::ivec3 bricks)
    : texture(makeTexture3D(bricks, GL_RGBA16UI, GL_NEAREST, "page table")), count(bricks),
      pages(std::size_t(bricks.x) * std::size_t(bricks.y) * std::size_t(bricks.z), glm::u16vec4(0)) {
    glTextureSubImage3D(texture.name(), 0, 0, 0, 0, count.x, count.y, count.z, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT,
                        pages.data());
}

void PageTable::set(glm::ivec3 brick, glm::ivec3 slot, std::uint16_t state) {
    const glm::u16vec4 page(slot.x, slot.y, slot.z, state);
    pages[(std::size_t(brick.z) * std::size_t(count.y) + std::size_t(brick.y)) * std::size_t(count.x) +
          std::size_t(brick.x)] = page;
    glTextureSubImage3D(texture.name(), 0, brick.x, brick.y, brick.z, 1, 1, 1, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT,
                        &page);
}

} // namespace tessera::vis
