#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <span>

namespace tessera::vis {

/// An RGBA8 picture for a 2D plot: minified smoothly, magnified without interpolation. Needs a current GL context from
/// the first upload until its destruction.
class PlotTexture {
public:
    PlotTexture();
    ~PlotTexture();
    PlotTexture(PlotTexture&&) noexcept;
    PlotTexture& operator=(PlotTexture&&) noexcept;

    /// Replaces the picture; rows top down, not premultiplied.
    void upload(glm::ivec2 size, std::span<const std::uint8_t> rgba);
    /// GL name, 0 before the first upload.
    std::uint32_t name() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessera::vis
