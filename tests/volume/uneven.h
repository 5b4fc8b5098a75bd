#pragma once

#include "tests/volume/fields.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <utility>

/// Layered devices for tests: axes of uneven spacing.
namespace tessera::volume::test {

/// Borders of a stack of layers, each with so many cells that grow by `ratio` from its first to its last one.
struct Layer {
    double thickness;
    int cells;
    double ratio = 1;
};
inline std::vector<double> layerPlanes(const std::vector<Layer>& layers, double from = 0) {
    std::vector<double> planes{from};
    for (const Layer& layer : layers) {
        const double start = planes.back();
        const double step = layer.cells > 1 ? std::pow(layer.ratio, 1.0 / (layer.cells - 1)) : 1;
        double sum = 0, cell = 1, reached = 0;
        for (int i = 0; i < layer.cells; ++i, cell *= step) sum += cell;
        cell = 1;
        for (int i = 0; i < layer.cells; ++i, cell *= step) {
            reached += cell;
            planes.push_back(i + 1 == layer.cells ? start + layer.thickness : start + layer.thickness * reached / sum);
        }
    }
    return planes;
}

/// Half a cell of a fuel cell along z: membrane 25 um (2 cells), catalyst layer 10 um (2), diffusion layer 200 um (6,
/// growing), channel 1.5 mm (10, growing 1:10); x is graded 1:10, y is even.
inline Lattice layeredLattice(AxisMap::Of of, LatticeKind kind = LatticeKind::CC) {
    const auto axis = [&](const std::vector<Layer>& layers) {
        return std::make_shared<const AxisMap>(of, layerPlanes(layers, 1e-3));
    };
    Lattice even = ccLattice({1, 9, 1}, glm::dvec3(2e-4), glm::dvec3(5e-4));
    const Lattice cc = withAxes(
        even, {{axis({{2e-3, 12, 10}}), nullptr, axis({{25e-6, 2}, {10e-6, 2}, {200e-6, 6, 3}, {1.5e-3, 10, 10}})}});
    return kind == LatticeKind::BCC ? bccFor(cc) : cc;
}

/// The box of a grid: of cells to their faces, of points and even axes from the first to the last sample.
inline Box unevenBox(const Lattice& cc) {
    Box box = boxOf(cc);
    for (int axis = 0; axis < 3; ++axis)
        if (const AxisMap* map = cc.axes[axis]) box.lo[axis] = map->lo(), box.hi[axis] = map->hi();
    return box;
}

/// Fields on one such lattice (each of all its samples at one time) as a source of bricks.
inline Dataset unevenDataset(std::vector<Field> fields, std::size_t times = 1) {
    Dataset dataset = datasetOf(std::move(fields), times);
    dataset.info.bounds = unevenBox(dataset.info.lattice);
    return dataset;
}
inline std::shared_ptr<const BrickSource> unevenSource(std::vector<Field> fields, int brickSize = 8) {
    return makeMemorySource(unevenDataset(std::move(fields)), {.brickSize = brickSize});
}

} // namespace tessera::volume::test
