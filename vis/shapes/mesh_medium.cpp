#include "vis/shapes/mesh_medium.h"

#include "vis/optics/ray_setup.h"
#include "vis/scene/drawn_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::vis {

namespace {

constexpr int kMostParts = 512; ///< subdivisions along an edge

/// Adds an amount to the eight cells around a position in cells (centres at integers), as far as they are in the grid.
template <class Number> void deposit(Medium<Number>& medium, const LightGrid& grid, glm::dvec3 p, glm::dvec4 amount) {
    const glm::ivec3 lo(glm::floor(p));
    const glm::dvec3 w = p - glm::dvec3(lo);
    for (int c = 0; c < 8; ++c) {
        const glm::ivec3 up(c & 1, c >> 1 & 1, c >> 2), at = lo + up;
        if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, grid.size))) continue;
        const glm::dvec3 parts = glm::mix(1.0 - w, w, glm::dvec3(up));
        medium[grid.index(at)] += glm::vec<4, Number>(amount * (parts.x * parts.y * parts.z));
    }
}

} // namespace

MeshCasters meshCasters(const Scene& scene, const volume::DatasetInfo& info) {
    MeshCasters out;
    if (!scene.lighting.shadows.meshes) return out;
    out.frame = worldFrame(info, scene.stretch);
    out.clips = placeClips(scene.clips, out.frame);
    out.lenses = placeLenses(scene, out.frame);
    for (const DrawnGeometry& drawn : drawnGeometry(scene, out.lenses)) {
        const GeometryLayer& layer = scene.geometry[std::size_t(drawn.layer)];
        if (layer.geometry->mesh.triangles.empty()) continue;
        MeshCasters::Caster caster;
        caster.geometry = layer.geometry;
        caster.color = linearFromSrgb(glm::dvec3(layer.style.color));
        caster.opacity = double(layer.style.opacity);
        caster.lens = drawn.lens;
        const std::optional<DrawnChannel> colors = colorsOf(scene, info, layer);
        caster.scalars = colors && !layer.geometry->mesh.scalars.empty();
        if (caster.scalars) {
            caster.function = *colors->function;
            caster.range = colors->range;
        }
        out.casters.push_back(std::move(caster));
    }
    return out;
}

template <class Number>
Medium<Number> meshMedium(const LightGrid& grid, const MeshCasters& casters, std::stop_token stop) {
    Medium<Number> medium(grid.count(), glm::vec<4, Number>(0));
    const glm::dvec3 cell = grid.cell();
    const double cellVolume = cell.x * cell.y * cell.z;
    for (const MeshCasters::Caster& caster : casters.casters) {
        const volume::SurfaceMesh& mesh = caster.geometry->mesh;
        for (const glm::uvec3& triangle : mesh.triangles) {
            if (stop.stop_requested()) return medium;
            glm::dvec3 p[3];
            double scalar = 0, longest = 0;
            for (int i = 0; i < 3; ++i) {
                p[i] = casters.frame.sheetToWorld(mesh.origin + glm::dvec3(mesh.positions[triangle[i]]));
                if (caster.scalars) scalar += double(mesh.scalars[triangle[i]]) / 3;
            }
            for (int i = 0; i < 3; ++i) longest = std::max(longest, glm::length((p[(i + 1) % 3] - p[i]) / cell));
            const glm::dvec3 along = p[1] - p[0], across = p[2] - p[0];
            const double area = 0.5 * glm::length(glm::cross(along, across));
            if (!(area > 0) || !std::isfinite(area)) continue;
            glm::dvec3 color = caster.color;
            if (caster.scalars && !std::isnan(scalar))
                color = linearFromSrgb(glm::dvec3(evaluate(caster.function, caster.range, scalar)));
            const int n = std::clamp(int(std::ceil(2 * longest)), 1, kMostParts);
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < 2 * (n - j) - 1; ++i) {
                    // Row j has n - j upright triangles and n - j - 1 inverted ones between them.
                    const int column = i / 2; // of an upright one and the inverted one after it
                    const double third = i % 2 == 0 ? 1.0 / 3 : 2.0 / 3;
                    const glm::dvec3 world = p[0] + along * ((column + third) / n) + across * ((j + third) / n);
                    if (!kept(casters.clips, world)) continue;
                    const double opacity = caster.opacity * lensAction(casters.lenses, caster.lens, world).opacity;
                    const double amount =
                        -std::log(1 - std::min(opacity, kThickest)) * area / (double(n) * n) / cellVolume;
                    deposit(medium, grid, (world + grid.halfSize) / cell - 0.5, glm::dvec4(color, 1) * amount);
                }
        }
    }
    return medium;
}

template Medium<float> meshMedium(const LightGrid&, const MeshCasters&, std::stop_token);
template Medium<double> meshMedium(const LightGrid&, const MeshCasters&, std::stop_token);

} // namespace tessera::vis
