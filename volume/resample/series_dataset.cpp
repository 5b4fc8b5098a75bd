#include "volume/resample/series_dataset.h"

#include "volume/field/part_masks.h"
#include "volume/field/quantities.h"
#include "volume/resample/series_slices.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

namespace tessera::volume {

namespace {

Lattice4 frameLattice(const DatasetInfo& info, LatticeKind4 kind) {
    // D4* frames are half a cell apart, so its cells are two frames long.
    const double cell = kind == LatticeKind4::D4 ? 2 : 1;
    return {kind, glm::ivec4(info.lattice.size, int(info.times.size())), glm::dvec4(info.lattice.spacing, cell),
            glm::dvec4(info.lattice.origin, 0), info.lattice.axes};
}

std::string digitsOf(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.12g", number);
    return text;
}

Series framesOf(const Dataset& dataset, int parameter, int component, LatticeKind4 kind) {
    return {frameLattice(dataset.info, kind), dataset.info.parameters[std::size_t(parameter)].categorical,
            [read = dataset.read, parameter, component](int frame) {
                return std::make_shared<const Field>(read(parameter, component, frame));
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
    if (times.size() < 2) return times.front();
    const auto base = std::size_t(std::clamp(std::floor(frame), 0.0, double(times.size() - 2)));
    const double fraction = frame - double(base);
    if (fraction == 0) return times[base];
    return fraction == 1 ? times[base + 1] : std::lerp(times[base], times[base + 1], fraction);
}

Series seriesOf(const Dataset& dataset, int parameter, int component) {
    return framesOf(dataset, parameter, component, LatticeKind4::CC);
}

Series d4SeriesOf(const Dataset& frames, int parameter, int component) {
    return framesOf(frames, parameter, component, LatticeKind4::D4);
}

std::string whyNotD4(const DatasetInfo& info) {
    constexpr double kUneven = 0.01; // of a step
    if (info.lattice.kind != LatticeKind::CC) return "D4* can be computed from a regular grid only";
    if (info.timeName == "operating point")
        return "D4* is a lattice in space and time; between operating points there is nothing";
    if (info.times.size() < kLeastD4Times)
        return "D4* is a lattice in space and time and needs " + std::to_string(kLeastD4Times) +
               " times or more, not " + std::to_string(info.times.size());
    const double step = (info.times.back() - info.times.front()) / double(info.times.size() - 1);
    for (std::size_t t = 1; t < info.times.size(); ++t)
        if (std::abs(info.times[t] - info.times[t - 1] - step) > kUneven * step)
            return "D4* needs evenly spaced times; from " + digitsOf(info.times[t - 1]) + " to " +
                   digitsOf(info.times[t]) + " is not one of " + std::to_string(info.times.size() - 1) + " equal steps";
    return "";
}

Dataset toD4(const Dataset& source, const ResampleOptions& options, const SliceMemory& memory) {
    if (const std::string reason = whyNotD4(source.info); !reason.empty()) throw Error(reason, source.info.name);
    const Lattice4 lattice = d4For(frameLattice(source.info, LatticeKind4::CC));
    Dataset out;
    out.info = source.info;
    out.info.lattice = lattice.grid(0);
    out.info.times.clear();
    for (int k = 0; k < lattice.size.w; ++k) out.info.times.push_back(timeAt(source.info.times, lattice.time(k)));
    out.info.quantities = atTimes(source.info.quantities, source.info.times, out.info.times);
    if (memory.step > 0) {
        out.read = d4Slices(source, frameLattice(source.info, LatticeKind4::CC), lattice, options, memory);
        return out;
    }
    // One series per component, each with the frames that its filter spans and the next one.
    const auto series = std::make_shared<std::map<std::pair<int, int>, Series>>();
    const Dataset parted = withParts(source);
    for (int p = 0; p < int(source.info.parameters.size()); ++p)
        for (int c = 0; c < source.info.parameters[std::size_t(p)].components; ++c)
            (*series)[{p, c}] = remembering(seriesOf(parted, p, c), std::size_t(framesSpanned(options)) + 1);
    out.read = [series, lattice, options](int parameter, int component, int time) {
        return withoutParts(toD4Frame(series->at({parameter, component}), lattice, time, options));
    };
    return out;
}

} // namespace tessera::volume
