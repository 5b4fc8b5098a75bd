#include "volume/mesh/region_surface.h"

#include "volume/mesh/isosurface.h"

#include <cmath>
#include <glm/common.hpp>

namespace tessera::volume {

SurfaceMesh extractRegionSurface(const BrickSource& source, int label, int time, int value, int level,
                                 const Progress& progress) {
    SampleGrid grid = padded(readSamples(source, label, time, level, progress.part(0, 0.4)));
    const glm::ivec3 size = grid.lattice.size;
    const int slices = grid.lattice.kind == LatticeKind::BCC ? 2 : 1;
    const glm::ivec3 ring(1, 1, slices); // what was added lies outside
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const glm::ivec3 at(x, y, z);
                const std::size_t i = grid.lattice.index(at);
                const bool within = at == glm::clamp(at, ring, size - 1 - ring);
                const bool member = within && grid.isPresent(i) && std::abs(double(grid.values[i]) - value) < 0.5;
                grid.values[i] = member ? 1.0f : 0.0f;
            }
    grid.present.clear();
    grid.parts.clear();
    SurfaceMesh mesh = extractIsosurface(grid, 0.5, {}, progress.part(0.4, 1));
    const Box& box = source.info().bounds;
    for (glm::vec3& position : mesh.positions)
        position = glm::clamp(position, glm::vec3(box.lo - mesh.origin), glm::vec3(box.hi - mesh.origin));
    return mesh;
}

} // namespace tessera::volume
