#include "volume/mesh/region_surface.h"

#include "tests/volume/fields.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <map>

namespace tessera::volume {
namespace {

/// A label that is 2 in a box of samples, 1 elsewhere.
std::shared_ptr<const BrickSource> labelSource(const Lattice& lattice, const Box& bounds, const Box& inside) {
    Dataset dataset;
    dataset.info.lattice = lattice;
    dataset.info.bounds = bounds;
    Parameter& label = dataset.info.parameters.emplace_back();
    label.name = "region";
    label.categorical = true;
    label.ranges = {{1, 2}};
    auto field = std::make_shared<const Field>(test::sampled<float>(lattice, [&](glm::dvec3 p) {
        bool in = true;
        for (int axis = 0; axis < 3; ++axis) in = in && p[axis] >= inside.lo[axis] && p[axis] <= inside.hi[axis];
        return in ? 2.0 : 1.0;
    }));
    dataset.read = [field](int, int, int) { return *field; };
    MemorySourceOptions options;
    options.lattice = lattice.kind;
    return makeMemorySource(dataset, options);
}

/// Volume enclosed by a mesh, positive if it faces outwards; and whether every edge has two triangles.
double enclosedVolume(const SurfaceMesh& mesh, bool& closed) {
    double sum = 0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const glm::uvec3& t : mesh.triangles) {
        const auto at = [&](std::uint32_t i) { return glm::dvec3(mesh.positions[i]); };
        sum += glm::dot(at(t.x), glm::cross(at(t.y), at(t.z))) / 6;
        for (int c = 0; c < 3; ++c) ++edges[std::minmax(t[c], t[(c + 1) % 3])];
    }
    closed = std::ranges::all_of(edges, [](const auto& edge) { return edge.second == 2; });
    return sum;
}

TEST(RegionSurface, IsClosedHalfWayToOthersAndOnTheFacesOfTheBox) {
    const Lattice cc = test::ccLattice({12, 10, 8}, {1, 1, 1}, {0, 0, 0});
    const Box bounds = test::boxOf(cc);
    struct Case {
        Box inside;
        double volume; ///< of cells that reach half-way, less the corners and edges that marching cubes cut off
    };
    const Case within{{{3, 3, 2}, {6, 5, 4}}, 4 * 3 * 3}, whole{{{-1, -1, -1}, {20, 20, 20}}, 11 * 9 * 7};
    for (const Case& of : {within, whole}) {
        const auto source = labelSource(cc, bounds, of.inside);
        const SurfaceMesh mesh = extractRegionSurface(*source, 0, 0, 2, 0);
        bool closed = false;
        const double volume = enclosedVolume(mesh, closed);
        EXPECT_TRUE(closed);
        EXPECT_GT(volume, 0.75 * of.volume);
        EXPECT_LT(volume, of.volume * (1 + 1e-9));
        for (const glm::vec3& p : mesh.positions)
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_GE(double(p[axis]), std::max(bounds.lo[axis], of.inside.lo[axis] - 0.5) - 1e-6);
                EXPECT_LE(double(p[axis]), std::min(bounds.hi[axis], of.inside.hi[axis] + 0.5) + 1e-6);
            }
    }
    EXPECT_TRUE(extractRegionSurface(*labelSource(cc, bounds, within.inside), 0, 0, 7, 0).triangles.empty());
}

TEST(RegionSurface, IsThereOnBodyCentredLattices) {
    const Lattice cc = test::ccLattice({24, 24, 24}, {1, 1, 1}, {0, 0, 0});
    const Box bounds = test::boxOf(cc), inside{{6, 6, 6}, {16, 16, 16}};
    const auto source = labelSource(bccFor(cc), bounds, inside);
    bool closed = false;
    const double volume = enclosedVolume(extractRegionSurface(*source, 0, 0, 2, 0), closed);
    EXPECT_TRUE(closed);
    EXPECT_NEAR(volume, 1100, 250) << "about a cell more than the samples reach";
}

} // namespace
} // namespace tessera::volume
