#include "vis/processor/pieces.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tessera::vis {

Pieces::Pieces(const SurfaceShading& shading, const Camera& camera, glm::ivec2 size, glm::dvec2 jitter)
    : shading_(shading), layers_(shading.layers()), frame_(shading.frame()), size_(size), jitter_(jitter),
      toClip_(projectionMatrix(camera, double(size.x) / size.y) * viewMatrix(camera)) {
    glm::dmat4 toPicture(1);
    for (int axis = 0; axis < 2; ++axis) toPicture[axis][axis] = toPicture[3][axis] = 0.5 * size[axis];
    toPixels_ = toPicture * toClip_;
    pixel_ = pixelAtDepthOne(camera, size);
    for (std::size_t layer = 0; layer < layers_.size(); ++layer) {
        addMesh(layer);
        addLines(layers_[layer]);
    }
}

glm::dvec4 Pieces::pixels(glm::dvec3 world) const {
    return toPixels_ * glm::dvec4(world, 1);
}

/// World position of a vertex of a mesh; of a rim moved outwards. Twin: vis/shaders/geometry_mesh.vert.glsl.
glm::dvec3 Pieces::corner(const SurfaceLayer& layer, std::uint32_t vertex) const {
    const volume::SurfaceMesh& mesh = layer.layer->geometry->mesh;
    const glm::dvec3 world = frame_.sheetToWorld(mesh.origin + glm::dvec3(mesh.positions[vertex]));
    const double rim = double(layer.layer->style.rim);
    if (!(rim > 0) || mesh.normals.empty()) return world;
    const glm::dvec3 normal = glm::dvec3(mesh.normals[vertex]) / frame_.scale;
    if (!(glm::dot(normal, normal) > 0)) return world;
    return world + glm::normalize(normal) * (rim * pixel_ * std::max(pixels(world).w, 0.0));
}

void Pieces::addMesh(std::size_t layer) {
    const volume::SurfaceMesh& mesh = layers_[layer].layer->geometry->mesh;
    const std::size_t count = mesh.triangles.size(), first = blocks_.size();
    blocks_.resize(first + (count + kBlock - 1) / kBlock);
    parallelFor(blocks_.size() - first, [&](std::size_t block) {
        std::vector<Slot>& slots = blocks_[first + block];
        for (std::size_t n = block * kBlock; n < std::min((block + 1) * kBlock, count); ++n) {
            std::array<glm::dvec4, 3> at;
            for (int i = 0; i < 3; ++i) at[std::size_t(i)] = pixels(corner(layers_[layer], mesh.triangles[n][i]));
            const Triangle::Box box = Triangle::box(at, size_, jitter_);
            if (!box.empty()) slots.push_back({box, std::uint32_t(n), std::int32_t(layer)});
        }
    });
}

void Pieces::addLine(const std::array<glm::dvec4, 3>& clip, const std::array<SurfacePoint, 3>& corners,
                     const SurfaceLayer& layer) {
    std::array<glm::dvec4, 3> at;
    for (std::size_t i = 0; i < 3; ++i)
        at[i] = {(glm::dvec2(clip[i]) + clip[i].w) * 0.5 * glm::dvec2(size_), clip[i].z, clip[i].w};
    const Triangle::Box box = Triangle::box(at, size_, jitter_);
    if (box.empty()) return;
    if (blocks_.empty() || blocks_.back().size() == kBlock) blocks_.emplace_back();
    blocks_.back().push_back({box, std::uint32_t(lines_.size()), -1});
    lines_.push_back({Triangle(at), corners, &layer, kNoTint, true});
}

/// A segment of a line as a strip of two triangles that faces the viewer. Twin: vis/shaders/geometry_lines.vert.glsl.
void Pieces::addSegment(const std::array<SurfacePoint, 2>& ends, const SurfaceLayer& layer) {
    const glm::dvec2 size(size_);
    const glm::dvec4 a = toClip_ * glm::dvec4(ends[0].world, 1), b = toClip_ * glm::dvec4(ends[1].world, 1);
    glm::dvec2 along = (glm::dvec2(b) / std::max(b.w, 1e-6) - glm::dvec2(a) / std::max(a.w, 1e-6)) * size;
    along = glm::dot(along, along) > 1e-12 ? glm::normalize(along) : glm::dvec2(1, 0);
    const double rim = double(layer.layer->style.rim), width = double(layer.layer->style.lineWidth) + 2 * rim;
    const glm::dvec2 beside = glm::dvec2(-along.y, along.x) * width / size;
    std::array<glm::dvec4, 4> clip;
    std::array<SurfacePoint, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) {
        const double side = i >= 2 ? 1 : -1;
        clip[i] = i % 2 == 1 ? b : a;
        corners[i] = ends[i % 2];
        corners[i].side = side;
        if (rim > 0) { // behind the line by half its width
            corners[i].world -= shading_.toViewer(corners[i].world) * (0.5 * width * pixel_ * std::max(clip[i].w, 0.0));
            clip[i] = toClip_ * glm::dvec4(corners[i].world, 1);
        }
        clip[i] += glm::dvec4(beside * (side * clip[i].w), 0, 0);
    }
    addLine({clip[0], clip[1], clip[2]}, {corners[0], corners[1], corners[2]}, layer);
    addLine({clip[2], clip[1], clip[3]}, {corners[2], corners[1], corners[3]}, layer);
}

void Pieces::addLines(const SurfaceLayer& layer) {
    const LineSet& lines = layer.layer->geometry->lines;
    std::size_t first = 0;
    for (const std::uint32_t end : lines.ends) {
        for (std::size_t i = first; i + 1 < std::min<std::size_t>(end, lines.positions.size()); ++i) {
            std::array<SurfacePoint, 2> ends;
            for (std::size_t k = 0; k < 2; ++k)
                ends[k] = {.world = frame_.sheetToWorld(lines.origin + glm::dvec3(lines.positions[i + k])),
                           .value = lines.scalars.empty() ? 0 : double(lines.scalars[i + k])};
            ends[0].direction = ends[1].direction = ends[1].world - ends[0].world;
            addSegment(ends, layer);
        }
        first = end;
    }
}

Piece Pieces::operator[](std::uint32_t number) const {
    const Slot& at = slot(number);
    if (at.layer < 0) return lines_[at.number];
    const SurfaceLayer& layer = layers_[std::size_t(at.layer)];
    const Geometry& geometry = *layer.layer->geometry;
    const volume::SurfaceMesh& mesh = geometry.mesh;
    const glm::uvec3 triangle = mesh.triangles[at.number];
    std::array<SurfacePoint, 3> corners;
    std::array<glm::dvec4, 3> seen;
    for (int i = 0; i < 3; ++i) {
        const std::size_t v = triangle[i], to = std::size_t(i);
        const glm::dvec3 normal = mesh.normals.empty() ? glm::dvec3(0) : glm::dvec3(mesh.normals[v]);
        corners[to] = {.world = corner(layer, triangle[i]),
                       .direction = normal / frame_.scale,
                       .value = mesh.scalars.empty() ? 0 : double(mesh.scalars[v]),
                       .stroke = geometry.strokes.empty() ? 0 : double(geometry.strokes[v])};
        seen[to] = pixels(corners[to].world);
    }
    return {Triangle(seen), corners, &layer, geometry.tints.empty() ? kNoTint : geometry.tints[triangle.z], false};
}

std::vector<std::vector<std::uint32_t>> Pieces::inBands(int rows, std::size_t bands) const {
    std::vector<std::vector<std::uint32_t>> out(bands);
    for (std::size_t block = 0; block < blocks_.size(); ++block)
        for (std::size_t i = 0; i < blocks_[block].size(); ++i) {
            const Triangle::Box& box = blocks_[block][i].box;
            for (int band = box.lo.y / rows; band <= (box.hi.y - 1) / rows; ++band)
                out[std::size_t(band)].push_back(std::uint32_t(block * kBlock + i));
        }
    return out;
}

} // namespace tessera::vis
