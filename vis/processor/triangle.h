#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>

namespace tessera::vis {

/// A corner of a triangle of rasterised geometry, or what lies between three of them.
struct SurfacePoint {
    glm::dvec3 world{0};
    glm::dvec3 direction{0}; ///< normal of a mesh, not normalised, or along the line
    double value = 0;
    double side = 0;   ///< -1..1 across a line
    double stroke = 0; ///< Geometry::strokes

    SurfacePoint operator*(double f) const { return {world * f, direction * f, value * f, side * f, stroke * f}; }
    SurfacePoint operator+(const SurfacePoint& b) const {
        return {world + b.world, direction + b.direction, value + b.value, side + b.side, stroke + b.stroke};
    }
};

/// A triangle in a picture, by its corners in homogeneous coordinates (M. Olano, T. Greer: Triangle scan conversion
/// using 2D homogeneous coordinates, 1997), so that nothing has to be cut at the eye.
class Triangle {
public:
    /// `corners`: x, y in pixels, y up, z and w of clip space, all times w.
    explicit Triangle(const std::array<glm::dvec4, 3>& corners);

    /// The pixels within `size` that a triangle with such corners may cover, by their centres, which are shifted by
    /// `jitter`; empty (lo >= hi) if none, as for most triangles smaller than a pixel.
    struct Box {
        glm::ivec2 lo{0}, hi{0};
        bool empty() const { return lo.x >= hi.x || lo.y >= hi.y; }
    };
    static Box box(const std::array<glm::dvec4, 3>& corners, glm::ivec2 size, glm::dvec2 jitter);
    /// Shares of the corners at a position in the picture, also beyond the edges of the triangle. nullopt: behind the
    /// eye.
    std::optional<glm::dvec3> shares(glm::dvec2 at) const;
    /// The same where the triangle covers the position and lies between the near and the far plane.
    std::optional<glm::dvec3> covered(glm::dvec2 at) const;

private:
    std::array<glm::dvec4, 3> corners_;
    glm::dmat3 weights_{0}; ///< times (x, y, 1): shares over w; 0: seen edge-on
};

} // namespace tessera::vis
