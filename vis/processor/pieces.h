#pragma once

#include "vis/processor/surface_shading.h"

#include <cstdint>

namespace tessera::vis {

/// A triangle of a picture: of a mesh, or half of a segment of a line.
struct Piece {
    Triangle triangle;
    std::array<SurfacePoint, 3> corners;
    const SurfaceLayer* layer = nullptr;
    glm::vec4 tint = kNoTint;
    bool line = false;

    SurfacePoint between(glm::dvec3 shares) const {
        return corners[0] * shares.x + corners[1] * shares.y + corners[2] * shares.z;
    }
};

/// The triangles of a picture that may cover a pixel, numbered in the order in which they are drawn. There can be
/// millions, so of those of meshes little is kept; the rest is made when it is asked for.
class Pieces {
public:
    /// Those of all layers. Refers to the shading and the scene. `jitter`: offset of the pixel centres, in pixels.
    Pieces(const SurfaceShading& shading, const Camera& camera, glm::ivec2 size, glm::dvec2 jitter);

    Piece operator[](std::uint32_t number) const;
    Triangle::Box box(std::uint32_t number) const { return slot(number).box; }
    /// For each band of so many rows the numbers of the triangles that may cover some of it, rising.
    std::vector<std::vector<std::uint32_t>> inBands(int rows, std::size_t bands) const;

private:
    static constexpr std::size_t kBlock = 4096; ///< at most, of one block
    struct Slot {
        Triangle::Box box;
        std::uint32_t number; ///< of the mesh or in lines_
        std::int32_t layer;   ///< in layers_, -1: a line
    };
    const Slot& slot(std::uint32_t number) const { return blocks_[number / kBlock][number % kBlock]; }
    glm::dvec4 pixels(glm::dvec3 world) const;
    glm::dvec3 corner(const SurfaceLayer& layer, std::uint32_t vertex) const;
    void addMesh(std::size_t layer);
    void addSegment(const std::array<SurfacePoint, 2>& ends, const SurfaceLayer& layer);
    void addLines(const SurfaceLayer& layer);
    void addLine(const std::array<glm::dvec4, 3>& clip, const std::array<SurfacePoint, 3>& corners,
                 const SurfaceLayer& layer);

    const SurfaceShading& shading_;
    const std::vector<SurfaceLayer>& layers_;
    WorldFrame frame_;
    glm::ivec2 size_;
    glm::dvec2 jitter_;
    glm::dmat4 toClip_, toPixels_; ///< of the world; toPixels_: x and y in pixels, times w
    double pixel_ = 0;             ///< world edge of a pixel, by w
    std::vector<std::vector<Slot>> blocks_;
    std::vector<Piece> lines_;
};

} // namespace tessera::vis
