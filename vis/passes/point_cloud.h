#pragma once

#include "vis/processor/drawn_cloud.h"

#include <memory>
#include <span>

namespace tessera::vis {

/// Draws many points as splats with order-independent transparency (weighted blended, McGuire and Bavoil 2013). In
/// OpenGL it needs a current GL 4.5 context from the first upload until its destruction.
class PointCloud {
public:
    PointCloud();
    ~PointCloud();
    PointCloud(PointCloud&&) noexcept;
    PointCloud& operator=(PointCloud&&) noexcept;

    /// Replaces the points. Any prefix of them should be a representative sample.
    void upload(TexturesIn where, std::span<const CloudPoint> points);
    std::size_t count() const;
    /// Returns an RGBA8 picture of view.size, rows bottom up, sRGB, opaque; valid until the next call.
    /// Throws Error when the shaders do not compile.
    TextureName draw(const CloudView& view);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessera::vis
