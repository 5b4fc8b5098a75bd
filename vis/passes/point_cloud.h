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
    float radiusPixels = 3; ///< of a splat at the middle of the picture that nothing magnifies
    double share = 1; ///< of the points to draw, from the first; opacities rise so that the picture keeps its density
    glm::vec3 background{0}; ///< sRGB
    bool operator==(const CloudView&) const = default;
};

/// Splats many points with order-independent transparency (weighted blended, McGuire and Bavoil 2013). Needs a current
/// GL 4.5 context from the first upload until its destruction.
class PointCloud {
public:
    PointCloud();
    ~PointCloud();
    PointCloud(PointCloud&&) noexcept;
    PointCloud& operator=(PointCloud&&) noexcept;

    /// Replaces the points. Any first part of them should be a fair sample of all.
    void upload(std::span<const CloudPoint> points);
    std::size_t count() const;
    /// GL name of an RGBA8 texture of view.size, rows bottom up, sRGB, opaque; valid until the next call. Throws Error
    /// when the shaders do not compile.
    std::uint32_t draw(const CloudView& view);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessera::vis
