#include "volume/four/lattice_tetrahedra.h"

#include "volume/mesh/cell_triangles.h"

#include <algorithm>
#include <tuple>

namespace tessera::volume {

namespace {

using Solid = std::array<glm::ivec3, 4>;

std::vector<Solid> kuhnTetrahedra() {
    std::vector<Solid> out;
    std::array<int, 3> axes{0, 1, 2};
    do {
        Solid solid{};
        for (std::size_t i = 0; i < 3; ++i) {
            solid[i + 1] = solid[i];
            solid[i + 1][axes[i]] = 1;
        }
        out.push_back(solid);
    } while (std::ranges::next_permutation(axes).found);
    return out;
}

} // namespace

LatticeTetrahedra latticeTetrahedra(LatticeKind kind) {
    LatticeTetrahedra out;
    for (Solid solid : kind == LatticeKind::CC ? kuhnTetrahedra() : bccTetrahedra()) {
        std::ranges::sort(solid, {}, [](glm::ivec3 at) { return std::tuple(at.z, at.y, at.x); });
        std::array<int, 4> positions{};
        for (std::size_t i = 0; i < 4; ++i) {
            const auto found = std::ranges::find(out.corners, solid[i]);
            positions[i] = int(found - out.corners.begin());
            if (found == out.corners.end()) out.corners.push_back(solid[i]);
        }
        out.solids.push_back(positions);
    }
    return out;
}

} // namespace tessera::volume
