#pragma once

#include "tests/volume/uneven.h"

#include <random>

/// A layered device with uneven axes, for tests of panes and numbers.
namespace tessera::app {

inline double unevenLinear(glm::dvec3 p) {
    return 1e3 * p.x - 500 * p.y + 2e4 * p.z;
}

inline std::shared_ptr<const volume::BrickSource> unevenLayers(volume::AxisMap::Of of) {
    volume::Dataset dataset =
        volume::test::unevenDataset({volume::test::sampled<float>(volume::test::layeredLattice(of), unevenLinear)});
    dataset.info.parameters[0].name = "T";
    dataset.info.parameters[0].unit = "K";
    dataset.info.parameters[0].ranges = {Range{20, 58}};
    dataset.info.lengthUnit = "m";
    return volume::makeMemorySource(std::move(dataset), {.brickSize = 8});
}

struct UnevenPlaces {
    std::mt19937 engine{4};
    double operator()(double lo, double hi) { return std::uniform_real_distribution(lo, hi)(engine); }
    glm::dvec3 in(const volume::Box& box) {
        return {(*this)(box.lo.x, box.hi.x), (*this)(box.lo.y, box.hi.y), (*this)(box.lo.z, box.hi.z)};
    }
    /// As often in each cell.
    glm::dvec3 drawn(const volume::DatasetInfo& info) { return info.lattice.axes.toSpace(in(info.bounds)); }
};

} // namespace tessera::app
