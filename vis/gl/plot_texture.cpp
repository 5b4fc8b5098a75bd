#include "vis/gl/plot_texture.h"

#include "vis/gl/handles.h"

#include <cassert>
#include <epoxy/gl.h>

namespace tessera::vis {

struct PlotTexture::Impl {
    Texture texture;
    glm::ivec2 size{0}; ///< of `texture`
    MemoryTexture memory{.rgba = {}, .smooth = false};
};

PlotTexture::PlotTexture() : impl_(std::make_unique<Impl>()) {}
PlotTexture::~PlotTexture() = default;
PlotTexture::PlotTexture(PlotTexture&&) noexcept = default;
PlotTexture& PlotTexture::operator=(PlotTexture&&) noexcept = default;

void PlotTexture::upload(TexturesIn where, glm::ivec2 size, std::span<const std::uint8_t> rgba) {
    assert(rgba.size() == static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * 4);
    if (where == TexturesIn::Memory) {
        impl_->memory.size = size;
        impl_->memory.rgba.assign(rgba.begin(), rgba.end());
        return;
    }
    if (impl_->size != size) {
        impl_->texture = makeTexture2D(size, GL_RGBA8, GL_LINEAR, "plot");
        glTextureParameteri(impl_->texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        impl_->size = size;
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(impl_->texture.name(), 0, 0, 0, size.x, size.y, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

TextureName PlotTexture::name() const {
    return impl_->memory.rgba.empty() ? impl_->texture.name() : impl_->memory.name();
}

} // namespace tessera::vis
