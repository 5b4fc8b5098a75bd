#include "vis/bricks/brick_atlas.h"

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
    : exact_(exact), edge_(brickSize + 2 * kHalo) {
    const int edge = edge_, most = std::max(1, maxTextureSize / edge);
    // As close to a cube as possible.
    glm::ivec3 count(1);
    count.x = std::clamp(int(std::ceil(std::cbrt(double(slots)))), 1, most);
    count.y = std::clamp(int(std::ceil(std::sqrt(double(slots) / count.x))), 1, most);
    count.z = std::clamp(int(std::ceil(double(slots) / count.x / count.y)), 1, most);
    size_ = count * edge;
    capacity_ = std::size_t(count.x) * std::size_t(count.y) * std::size_t(count.z);
    bytes_ = capacity_ * std::size_t(edge) * std::size_t(edge) * std::size_t(edge) * std::size_t(components) *
             (exact ? 4 : 2);
    holders_.assign(capacity_, 0);
    texture_ = makeTexture3D(size_, texelFormat(components, exact), GL_LINEAR, "brick atlas");
    for (int z = count.z - 1; z >= 0; --z)
        for (int y = count.y - 1; y >= 0; --y)
            for (int x = count.x - 1; x >= 0; --x) free_.push_back(glm::ivec3(x, y, z) * edge);
}

std::optional<glm::ivec3> BrickAtlas::allocate() {
    if (free_.empty()) return std::nullopt;
    const glm::ivec3 slot = free_.back();
    free_.pop_back();
    holders_[number(slot)] = 1;
    return slot;
}

void BrickAtlas::release(glm::ivec3 slot) {
    if (--holders_[number(slot)] == 0) free_.push_back(slot);
}

std::size_t BrickAtlas::number(glm::ivec3 slot) const {
    const glm::ivec3 at = slot / edge_, count = size_ / edge_;
    return (std::size_t(at.z) * std::size_t(count.y) + std::size_t(at.y)) * std::size_t(count.x) + std::size_t(at.x);
}

void BrickAtlas::upload(glm::ivec3 slot, const TexelBlock& block) {
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage3D(texture_.name(), 0, slot.x, slot.y, slot.z, block.size.x, block.size.y, block.size.z,
                        texelLayout(block.components), exact_ ? GL_FLOAT : GL_UNSIGNED_SHORT, block.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

void BrickAtlas::copy(const BrickAtlas& from, glm::ivec3 fromSlot, glm::ivec3 slot) {
    glCopyImageSubData(from.texture(), GL_TEXTURE_3D, 0, fromSlot.x, fromSlot.y, fromSlot.z, texture_.name(),
                       GL_TEXTURE_3D, 0, slot.x, slot.y, slot.z, edge_, edge_, edge_);
}

PageTable::PageTable(glm::ivec3 bricks)
    : texture(makeTexture3D(bricks, GL_RGBA16UI, GL_NEAREST, "page table")), count(bricks),
      pages(std::size_t(bricks.x) * std::size_t(bricks.y) * std::size_t(bricks.z), {0, 0, 0, kNowhere}) {
    upload();
}

void PageTable::upload() {
    glTextureSubImage3D(texture.name(), 0, 0, 0, 0, count.x, count.y, count.z, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT,
                        pages.data());
}

} // namespace tessera::vis
