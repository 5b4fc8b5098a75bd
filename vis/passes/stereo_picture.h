#pragma once

#include "vis/gl/texture_name.h"

#include <memory>

namespace tessera::vis {

/// Combines the pictures of both eyes into an anaglyph (vis/formulas/anaglyph.h), where they are: in OpenGL, with a
/// current context of GL 4.5 from the first call until its destruction, or in memory.
class StereoPicture {
public:
    StereoPicture();
    ~StereoPicture();
    StereoPicture(StereoPicture&&) noexcept;
    StereoPicture& operator=(StereoPicture&&) noexcept;

    /// `left`, `right`: RGBA8, sRGB, `size` large, of PointCloud::draw or Renderer::render. The result is one likewise,
    /// valid until the next call. 0 where one of them is. Throws Error when the shader does not compile.
    TextureName combine(TexturesIn where, TextureName left, TextureName right, glm::ivec2 size);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessera::vis
