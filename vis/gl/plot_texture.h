#pragma once

#include "vis/gl/texture_name.h"

#include <memory>
#include <span>

namespace tessera::vis {

/// An RGBA8 picture for a 2D plot: minified smoothly, magnified without interpolation. In OpenGL it needs a current
/// context from the first upload until its destruction.
class PlotTexture {
public:
    PlotTexture();
    ~PlotTexture();
    PlotTexture(PlotTexture&&) noexcept;
    PlotTexture& operator=(PlotTexture&&) noexcept;

    /// Replaces the picture; rows top down, not premultiplied.
    void upload(TexturesIn where, glm::ivec2 size, std::span<const std::uint8_t> rgba);
    /// 0 before the first upload.
    TextureName name() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessera::vis
