#pragma once

#include "vis/shapes/cloud4.h"
#include "vis/shapes/rotation4.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace tessera::vis {

struct CloudView {
    glm::dmat4 rotation{1};
    Projection4 projection;
    glm::ivec2 size{512, 512};
    float radiusPixels = 3; ///< of a splat in the centre of the picture, without magnification
    double share =
        1; ///< fraction of the points to draw, from the first; opacities are raised to keep the density of the picture
    glm::vec3 background{0}; ///< sRGB
    bool operator==(const CloudView&) const = default;
};

/// Draws many points as splats with order-independent transparency (weighted blended, McGuire and Bavoil 2013). Needs a
/// current GL 4.5 context from the first upload until its destruction.
class PointCloud {
public:
    PointCloud();
    ~PointCloud();
    PointCloud(PointCloud&&) noexcept;
    PointCloud& operator=(PointCloud&&) noexcept;

    /// Replaces the points. Any prefix of them should be a representative sample.
    void upload(std::span<const CloudPoint> points);
    std::size_t count() const;
    /// Returns the GL name of an RGBA8 texture of view.size, rows bottom up, sRGB, opaque; valid until the next call.
    /// Throws Error when the shaders do not compile.
    std::uint32_t draw(const CloudView& view);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessera::vis
