#include "volume/series_dataset.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tessera::volume {

namespace {

Lattice4 frameLattice(const DatasetInfo& info, LatticeKind4 kind) {
    // Frames of D4* lie half a cell apart, so its cells are two frames long.
    const double cell = kind == LatticeKind4::D4 ? 2 : 1;
    return {kind, glm::ivec4(info.lattice.size, int(info.times.size())), glm::dvec4(info.lattice.spacing, cell),
            glm::dvec4(info.lattice.origin, 0)};
}

Series framesOf(const Dataset& dataset, int parameter, int component, LatticeKind4 kind) {
    return {frameLattice(dataset.info, kind), dataset.info.parameters[std::size_t(parameter)].categorical,
            [load = dataset.load, parameter, component](int frame) {
                return std::make_shared<const Field>(load(parameter, component, frame));
            }};
}

} // namespace

double frameAt(std::span<const double> times, double time) {
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    if (after == times.begin()) return 0;
    if (after == times.end()) return double(times.size() - 1);
    const double before = *(after - 1);
    return double(after - times.begin() - 1) + (time - before) / (*after - before);
}

double timeAt(std::span<const double> times, double frame) {
    const double inside = std::clamp(frame, 0.0, double(times.size() - 1));
    const std::size_t base = std::min(std::size_t(inside), times.size() - 1);
    const double fraction = inside - double(base);
    return fraction == 0 ? times[base] : std::lerp(times[base], times[base + 1], fraction);
}

Series seriesOf(const Dataset& dataset, int parameter, int component) {
    return framesOf(dataset, parameter, component, LatticeKind4::CC);
}

Series d4SeriesOf(const Dataset& frames, int parameter, int component) {
    return framesOf(frames, parameter, component, LatticeKind4::D4);
}

Dataset toD4(Dataset source, const ResampleOptions& options) {
    if (source.info.lattice.kind != LatticeKind::CC)
        throw Error("D4* is made from a regular grid, and this is none", source.info.name);
    if (source.info.times.size() < 2) throw Error("D4* is a lattice in space and time: it needs two times or more");
    const Lattice4 lattice = d4For(frameLattice(source.info, LatticeKind4::CC));
    Dataset out;
    out.info = source.info;
    out.info.lattice = lattice.grid(0);
    out.info.times.clear();
    for (int k = 0; k < lattice.size.w; ++k) out.info.times.push_back(timeAt(source.info.times, lattice.time(k)));
    // One series per component, each with the frames its filter spans and one to move on.
    const auto series = std::make_shared<std::map<std::pair<int, int>, Series>>();
    for (int p = 0; p < int(source.info.parameters.size()); ++p)
        for (int c = 0; c < source.info.parameters[std::size_t(p)].components; ++c)
            (*series)[{p, c}] = remembering(seriesOf(source, p, c), std::size_t(framesSpanned(options)) + 1);
    out.load = [series, lattice, options](int parameter, int component, int time) {
        return toD4Frame(series->at({parameter, component}), lattice, time, options);
    };
    return out;
}

} // namespace tessera::volume
