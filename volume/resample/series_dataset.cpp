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
            glm::dvec4(info.lattice.origin, 0)};
}

std::string textOf(double number) {
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

namespace {

/// The frames of a D4* lattice from number `first` on; `source` is the whole series.
D4Frames framesFrom(const Dataset& source, const Lattice4& lattice, int first, const ResampleOptions& options,
                    const SliceMemory& memory) {
    D4Frames out;
    out.times = source.info.times;
    out.frames.info = source.info;
    out.frames.info.lattice = lattice.grid(0);
    out.frames.info.times.clear();
    for (int k = first; k < lattice.size.w; ++k)
        out.frames.info.times.push_back(timeAt(source.info.times, lattice.time(k)));
    out.frames.info.quantities = atTimes(source.info.quantities, source.info.times, out.frames.info.times);
    if (memory.step > 0) {
        out.frames.read =
            d4Slices(source, frameLattice(source.info, LatticeKind4::CC), lattice, first, options, memory);
        return out;
    }
    // One series per component, each with the frames that its filter spans and the next one.
    const auto series = std::make_shared<std::map<std::pair<int, int>, Series>>();
    const Dataset parted = withParts(source);
    for (int p = 0; p < int(source.info.parameters.size()); ++p)
        for (int c = 0; c < source.info.parameters[std::size_t(p)].components; ++c)
            (*series)[{p, c}] = remembering(seriesOf(parted, p, c), std::size_t(framesSpanned(options)) + 1);
    out.frames.read = [series, lattice, first, options](int parameter, int component, int time) {
        return withoutParts(toD4Frame(series->at({parameter, component}), lattice, first + time, options));
    };
    return out;
}

} // namespace

D4Frames framesOfD4(const Dataset& source, const ResampleOptions& options, const SliceMemory& memory) {
    if (source.info.lattice.kind != LatticeKind::CC)
        throw Error("D4* can be computed from a regular grid only", source.info.name);
    if (source.info.times.size() < 2) throw Error("D4* is a lattice in space and time and needs two times or more");
    return framesFrom(source, d4For(frameLattice(source.info, LatticeKind4::CC)), 0, options, memory);
}

D4Frames continueD4(Dataset source, const std::vector<double>& known, const std::vector<double>& frames,
                    const ResampleOptions& options, const SliceMemory& memory) {
    const std::vector<double> given = source.info.times;
    std::vector<double> times = known;
    for (const double time : given)
        if (time > known.back()) times.push_back(time);
    if (times.size() == known.size()) throw Error("the data have no times after the last one", source.info.name);
    // Index in the source of each time of the whole series, or -1.
    std::vector<int> place;
    for (const double time : times) {
        const auto at = std::lower_bound(given.begin(), given.end(), time);
        place.push_back(at != given.end() && *at == time ? int(at - given.begin()) : -1);
    }
    for (Quantity& quantity : source.info.quantities) {
        std::vector<double> values;
        for (const int at : place)
            values.push_back(at < 0 ? std::numeric_limits<double>::quiet_NaN() : quantity.values[std::size_t(at)]);
        quantity.values = std::move(values);
    }
    source.info.times = times;
    source.read = source.read.through(
        [place](const FrameReader& read, int parameter, int component, int time, SliceRange slices) {
            return read(parameter, component, place[std::size_t(time)], slices);
        });
    Lattice4 lattice = d4For(frameLattice(source.info, LatticeKind4::CC));
    lattice.origin.w = frameAt(known, frames.front());
    const double last = double(times.size() - 1), step = 0.5 * lattice.spacing.w;
    constexpr double kRounding = 1e-9;
    lattice.size.w = int((last - lattice.origin.w) / step + kRounding) + 1;
    const int first = int(frames.size());
    std::string missing;
    for (int at = firstFrameSpanned(lattice.time(first), int(times.size()), options); at < int(known.size()); ++at)
        if (place[std::size_t(at)] < 0) missing += (missing.empty() ? "" : ", ") + textOf(known[std::size_t(at)]);
    if (!missing.empty())
        throw Error("D4* also needs earlier times to continue: the data must contain again the times " + missing,
                    source.info.name);
    return framesFrom(source, lattice, first, options, memory);
}

} // namespace tessera::volume
