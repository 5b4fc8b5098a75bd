#include "volume/resample/even_grid.h"

#include "volume/base/error.h"
#include "volume/field/part_masks.h"
#include "volume/resample/resample.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tessera::volume {

namespace {

/// Intervals between planes of the shortest length along an axis.
double intervalsOf(const AxisMap& map) {
    double least = map.hi() - map.lo();
    for (std::size_t i = 1; i < map.planes().size(); ++i)
        least = std::min(least, map.planes()[i] - map.planes()[i - 1]);
    return std::ceil((map.hi() - map.lo()) / least * (1 - 1e-9));
}

} // namespace

Lattice evenFor(const Lattice& uneven, const EvenLimits& limits) {
    if (uneven.kind != LatticeKind::CC) throw Error("only a Cartesian grid can be made even");
    Lattice even = uneven;
    even.axes = {};
    int axes = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (const AxisMap* map = uneven.axes[axis]) {
            ++axes;
            const int points = map->of() == AxisMap::Of::Points ? 1 : 0;
            even.size[axis] =
                int(std::clamp(intervalsOf(*map) + points, double(1 + points), double(std::max(limits.perAxis, 2))));
        }
    for (int tries = 0; tries < 64; ++tries) { // an axis cannot have less than two samples, others then have fewer
        const double all = double(even.size.x) * even.size.y * even.size.z;
        if (axes == 0 || all <= limits.samples) break;
        const double factor = std::pow(limits.samples / all, 1.0 / axes);
        for (int axis = 0; axis < 3; ++axis)
            if (uneven.axes[axis]) even.size[axis] = std::max(2, int(even.size[axis] * factor));
    }
    for (int axis = 0; axis < 3; ++axis)
        if (const AxisMap* map = uneven.axes[axis]) {
            const bool points = map->of() == AxisMap::Of::Points;
            even.spacing[axis] = (map->hi() - map->lo()) / (even.size[axis] - (points ? 1 : 0));
            even.origin[axis] = map->lo() + (points ? 0 : 0.5 * even.spacing[axis]);
        }
    return even;
}

Dataset onEvenGrid(const Dataset& dataset, const EvenLimits& limits) {
    if (dataset.info.lattice.isEven()) return dataset;
    const Lattice even = evenFor(dataset.info.lattice, limits);
    Dataset out = dataset;
    out.info.lattice = even;
    const glm::ivec3 from = dataset.info.lattice.size;
    const auto sizeText = [](glm::ivec3 size) {
        return std::to_string(size.x) + " x " + std::to_string(size.y) + " x " + std::to_string(size.z);
    };
    out.info.notes.push_back("resampled from " + sizeText(from) + " samples of uneven spacing to " +
                             sizeText(even.size) + " of even spacing, linear between samples");
    std::vector<bool> categorical;
    for (const Parameter& parameter : dataset.info.parameters) categorical.push_back(parameter.categorical);
    out.read = [source = withParts(dataset), even, categorical](int parameter, int component, int time) {
        const ResampleOptions linear{.filter = ResampleFilter::Linear};
        return withoutParts(resample(source.read(parameter, component, time), even,
                                     optionsFor(categorical[std::size_t(parameter)], linear)));
    };
    return out;
}

} // namespace tessera::volume
