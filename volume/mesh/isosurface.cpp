#include "volume/mesh/isosurface.h"

#include "volume/base/parallel.h"
#include "volume/flow/flow.h"
#include "volume/mesh/cell_triangles.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>

namespace tessera::volume {

namespace {

/// Appends the slabs' triangles in order, and the vertices of each slab after the shared ones.
void join(SurfaceMesh& mesh, const std::vector<CellTriangles>& slabs) {
    std::vector<std::size_t> first(slabs.size()), firstOwn(slabs.size());
    std::size_t triangles = 0, vertices = mesh.positions.size();
    for (std::size_t i = 0; i < slabs.size(); ++i) {
        first[i] = triangles;
        firstOwn[i] = vertices;
        triangles += slabs[i].triangles.size();
        vertices += slabs[i].own.size();
    }
    if (vertices >= kOwnVertex) throw Error("the surface has more than 2 thousand million vertices");
    mesh.triangles.resize(triangles);
    mesh.positions.resize(vertices);
    mesh.normals.resize(vertices);
    parallelFor(slabs.size(), [&](std::size_t i) {
        for (std::size_t n = 0; n < slabs[i].own.size(); ++n) {
            glm::vec3 position(0), normal(0);
            for (const std::uint32_t of : slabs[i].own[n]) {
                position += mesh.positions[of] / float(slabs[i].own[n].size());
                normal += mesh.normals[of];
            }
            mesh.positions[firstOwn[i] + n] = position;
            const float length = glm::length(normal);
            mesh.normals[firstOwn[i] + n] = length > 0 ? normal / length : normal;
        }
        for (std::size_t n = 0; n < slabs[i].triangles.size(); ++n) {
            glm::uvec3 triangle = slabs[i].triangles[n];
            for (int c = 0; c < 3; ++c)
                if ((triangle[c] & kOwnVertex) != 0)
                    triangle[c] = std::uint32_t(firstOwn[i]) + (triangle[c] & ~kOwnVertex);
            mesh.triangles[first[i] + n] = triangle;
        }
    });
}

SurfaceMesh extractPart(const SampleGrid& grid, float value, glm::dvec3 origin, const Progress& progress) {
    const CrossedEdges edges(grid, value, progress.part(0, 0.4));
    SurfaceMesh mesh = edges.vertices(origin, progress);
    progress.advance(0.7);
    std::vector<CellTriangles> slabs(std::size_t(slabCount(grid)));
    parallelFor(slabs.size(), [&](std::size_t slab) {
        if (progress.stop.stop_requested()) throw Cancelled();
        slabs[slab] = grid.lattice.kind == LatticeKind::CC ? cubeTriangles(grid, edges, value, int(slab))
                                                           : tetrahedronTriangles(edges, int(slab));
    });
    join(mesh, slabs);
    // Beside absent samples, and at the border of BCC, some crossed edges belong to no whole cell.
    if (!grid.present.empty() || grid.lattice.kind == LatticeKind::BCC) removeUnused(mesh);
    return mesh;
}

/// Surfaces of each part separately: a jump between two parts is not a crossing.
SurfaceMesh extract(const SampleGrid& grid, float value, glm::dvec3 origin, const Progress& progress) {
    if (grid.parts.empty()) return extractPart(grid, value, origin, progress);
    const std::size_t parts = 1 + std::size_t(*std::ranges::max_element(grid.parts));
    SurfaceMesh mesh;
    mesh.origin = origin;
    for (std::size_t p = 0; p < parts; ++p) {
        const SurfaceMesh own = extractPart(ofPart(grid, p), value, origin,
                                            progress.part(double(p) / double(parts), double(p + 1) / double(parts)));
        const auto first = glm::uvec3(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.insert(mesh.positions.end(), own.positions.begin(), own.positions.end());
        mesh.normals.insert(mesh.normals.end(), own.normals.begin(), own.normals.end());
        for (const glm::uvec3 triangle : own.triangles) mesh.triangles.push_back(triangle + first);
    }
    return mesh;
}

} // namespace

bool spans(const SampleGrid& grid, const Box& box) {
    const Lattice& lattice = grid.lattice;
    const glm::dvec3 first = lattice.position(glm::ivec3(0)), last = lattice.position(lattice.size - 1);
    const auto slack = [&](glm::dvec3 at) { return lattice.lengthsAt(at) * 1e-6; };
    return lattice.kind == LatticeKind::CC && glm::all(glm::lessThanEqual(glm::abs(first - box.lo), slack(first))) &&
           glm::all(glm::lessThanEqual(glm::abs(last - box.hi), slack(last)));
}

SurfaceMesh extractIsosurface(const SampleGrid& grid, double value, const std::optional<Box>& box,
                              const Progress& progress) {
    const Lattice& lattice = grid.lattice;
    const glm::dvec3 origin =
        originFor(box.value_or(Box{lattice.position(glm::ivec3(0)), lattice.position(lattice.size - 1)}));
    if (!box || spans(grid, *box)) return extract(grid, float(value), origin, progress);
    SurfaceMesh mesh = extract(padded(grid), float(value), origin, progress);
    clipToBox(mesh, *box);
    return mesh;
}

SurfaceMesh extractIsosurface(const BrickSource& source, int channel, int time, double value, int level,
                              const Progress& progress) {
    const SampleGrid grid = readSamples(source, channel, time, level, progress.part(0, 0.5));
    return extractIsosurface(grid, value, source.info().bounds, progress.part(0.5, 1));
}

void sampleAtVertices(SurfaceMesh& mesh, const BrickSource& source, int channel, int time, int level,
                      const Progress& progress) {
    const SampleGrid grid = readSamples(source, channel, time, level, progress.part(0, 0.5));
    const Lattice& lattice = grid.lattice;
    const Channel known = source.info().channel(channel);
    const bool categorical = source.info().parameters[std::size_t(known.parameter)].categorical;
    const auto labelAt = [&](glm::dvec3 position) -> std::optional<double> {
        const std::size_t index = lattice.index(lattice.nearest(position));
        if (!grid.isPresent(index)) return std::nullopt;
        return double(grid.values[index]);
    };
    mesh.scalars.resize(mesh.positions.size());
    parallelRanges(
        mesh.positions.size(),
        [&](std::size_t begin, std::size_t end) {
            if (progress.stop.stop_requested()) throw Cancelled();
            for (std::size_t i = begin; i < end; ++i) {
                const glm::dvec3 position = mesh.origin + glm::dvec3(mesh.positions[i]);
                const std::optional<double> value = categorical ? labelAt(position) : valueAt(grid, position);
                mesh.scalars[i] = value ? float(*value) : std::numeric_limits<float>::quiet_NaN();
            }
        },
        4096);
    progress.advance(1);
}

} // namespace tessera::volume
