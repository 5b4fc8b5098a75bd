#include "codec/memory_plan.h"

#include "volume/error.h"

#include <algorithm>
#include <cmath>
#include <unistd.h>

namespace tessera::codec {

namespace {

constexpr double kMega = 1e6;
constexpr double kOwn = 64 * kMega; ///< the program itself, its threads and tables

double quarterOfRam() {
    const double pages = double(::sysconf(_SC_PHYS_PAGES)), bytes = double(::sysconf(_SC_PAGE_SIZE));
    return pages > 0 && bytes > 0 ? pages * bytes / 4 : 1e9;
}

/// What resampling has beside source and result, for each sample of the source.
double workingBytes(const volume::ResampleOptions& options) {
    const bool spline =
        options.filter == volume::ResampleFilter::BSpline3 || options.filter == volume::ResampleFilter::BSpline5;
    constexpr double kLines = 1.25; // lines being filtered, and what the allocator keeps of them
    return (spline ? kLines * double(sizeof(double)) : 0) + (options.sharpen > 0 ? double(sizeof(float)) + 1 : 0);
}

} // namespace

MemoryPlan planMemory(const Metadata& metadata, const volume::DatasetInfo& source, const PackOptions& options) {
    const double samples = double(source.lattice.count()),
                 stored = std::max(samples, double(metadata.info.lattice.count()));
    const bool resampled = options.lattice != StoredLattice::CC && source.lattice.kind == volume::LatticeKind::CC;
    const double working = resampled ? workingBytes(options.resample) * samples : 0;
    double step = 0, coding = 0, all = 0, last = 0;
    for (const volume::Parameter& parameter : source.parameters) {
        const double bytes = double(volume::byteSize(parameter.type)) + 1; // and a flag
        step = std::max(step, parameter.components * samples * bytes + stored * bytes + working);
        coding = std::max(coding, parameter.components * stored * bytes + 2 * stored * bytes);
        all += parameter.components * samples * bytes;
        last += parameter.components * stored * bytes;
    }
    constexpr double kTimesOfD4 = 6; // that the filter in time may keep
    const bool d4 = options.lattice == StoredLattice::D4;
    const double kept = d4 ? kTimesOfD4 * all : 0;
    const double least = kOwn + kept + std::max(step, coding);
    const double limit = options.memoryMb > 0 ? options.memoryMb * kMega : quarterOfRam();
    if (options.memoryMb > 0 && least > limit)
        throw Error("packing frames of this size takes about " + std::to_string(std::lround(std::ceil(least / kMega))) +
                    " MB, the limit of memory is " + std::to_string(std::lround(options.memoryMb)) + " MB");
    MemoryPlan plan;
    const double frames = source.times.size() > 1 ? (d4 ? 2 : 1) * last : 0;
    plan.keepFrames = least + frames <= limit;
    plan.readAhead = least + (plan.keepFrames ? frames : 0) + step <= limit;
    return plan;
}

} // namespace tessera::codec
