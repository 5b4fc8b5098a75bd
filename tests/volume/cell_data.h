#pragma once

#include "tests/volume/fields.h"
#include "volume/sources/memory_source.h"

#include <random>

/// A small flow with regions, holes and a density, for tests of sections, balances and statistics by region.
namespace tessera::volume::test {

enum CellParameter { kO2, kRegion, kRho, kU }; ///< channels: 0, 1, 2, 3 to 5 and |U|

inline Dataset cellData(const Lattice& lattice, const Box& bounds, unsigned seed = 7) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> even(-1, 1);
    const auto noise = [&](glm::dvec3) { return even(random); };
    Field o2 = sampled<float>(lattice, [&](glm::dvec3 p) { return 4 + 0.3 * p.x - 0.1 * p.z + noise(p); });
    Field region = sampled<float>(lattice, [&](glm::dvec3) { return double(random() % 3 == 2 ? 3 : random() % 2); });
    Field rho = sampled<float>(lattice, [&](glm::dvec3 p) { return 1.5 + 0.4 * noise(p); });
    std::vector<Field> fields{o2, region, rho};
    for (int axis = 0; axis < 3; ++axis)
        fields.push_back(sampled<float>(lattice, [&](glm::dvec3 p) { return 0.5 + noise(p); }));
    removeWhere(fields[kO2], [&](glm::dvec3) { return random() % 6 == 0; });
    removeWhere(fields[kRegion], [&](glm::dvec3) { return random() % 17 == 0; });
    for (std::size_t axis = 1; axis < 3; ++axis) fields[kU + axis].mask = fields[kO2].mask;
    Dataset dataset;
    dataset.info.name = "cell";
    dataset.info.lattice = lattice;
    dataset.info.bounds = bounds;
    const auto parameter = [&](const char* name, const char* unit, int components) {
        Parameter& made = dataset.info.parameters.emplace_back();
        made.name = name;
        made.unit = unit;
        made.components = components;
        made.ranges.assign(components == 1 ? 1 : 4, Range{0, 8});
    };
    parameter("O2", "mol/m3", 1);
    parameter("region", "", 1);
    parameter("rho", "kg/m3", 1);
    parameter("U", "m/s", 3);
    dataset.info.parameters[kRegion].categorical = true;
    dataset.info.parameters[kRegion].labels = {{0, "solid"}, {1, "air"}, {3, "fuel"}};
    auto shared = std::make_shared<const std::vector<Field>>(std::move(fields));
    dataset.read = [shared](int of, int component, int) { return (*shared)[std::size_t(of + component)]; };
    return dataset;
}

inline std::shared_ptr<const BrickSource> cellSource(const Dataset& dataset) {
    MemorySourceOptions options;
    options.brickSize = 8;
    options.lattice = dataset.info.lattice.kind;
    return makeMemorySource(dataset, options);
}

/// Length of a sample's cell along an axis, by the rule that cells reach half way to the neighbours of the same
/// sublattice and end at the box: written anew.
inline double cellLength(const Lattice& lattice, const Box& box, glm::ivec3 at, int axis) {
    const bool bcc = lattice.kind == LatticeKind::BCC;
    const int sublattice = bcc ? at.z % 2 : 0;
    const int index = axis == 2 && bcc ? at.z / 2 : at[axis];
    const int count = lattice.sublatticeSize(sublattice)[axis];
    if (box.hi[axis] <= box.lo[axis]) return lattice.spacing[axis] / count;
    const double centre = lattice.position(at)[axis], half = 0.5 * lattice.spacing[axis];
    const double lo = index == 0 ? box.lo[axis] : std::clamp(centre - half, box.lo[axis], box.hi[axis]);
    const double hi = index == count - 1 ? box.hi[axis] : std::clamp(centre + half, box.lo[axis], box.hi[axis]);
    return hi - lo;
}

/// Every storage index of a lattice.
inline void forAll(const Lattice& lattice, auto&& body) {
    for (int k = 0; k < lattice.size.z; ++k)
        for (int j = 0; j < lattice.size.y; ++j)
            for (int i = 0; i < lattice.size.x; ++i) body(glm::ivec3(i, j, k), lattice.index({i, j, k}));
}

} // namespace tessera::volume::test
