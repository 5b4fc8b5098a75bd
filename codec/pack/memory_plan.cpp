#include "codec/pack/memory_plan.h"

#include "codec/archive/brick_access.h"
#include "codec/archive/coded_bricks.h"
#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/resample/series.h"
#include "volume/system/free_memory.h"
#include "volume/system/launched.h"

#include <algorithm>
#include <cmath>

namespace tessera::codec {

namespace {

constexpr double kMega = 1e6;
constexpr double kOwn = 64 * kMega; ///< the program itself, its threads and tables

/// Shared by the processes that a launcher started on this machine.
double quarterOfRam() {
    return double(volume::machineMemory()) / 4 / launched().onThisMachine;
}

bool isSpline(const volume::ResampleOptions& options) {
    return options.filter == volume::ResampleFilter::BSpline3 || options.filter == volume::ResampleFilter::BSpline5;
}

/// Working memory of resampling besides source and result, in bytes per source sample.
double workingBytes(const volume::ResampleOptions& options) {
    constexpr double kLines = 1.25; // line buffers, and overhead of the allocator
    return (isSpline(options) ? kLines * double(sizeof(double)) : 0) +
           (options.sharpen > 0 ? double(sizeof(float)) + 1 : 0);
}

/// Whether the coefficients of a parameter may be quantised, for which bricks need more memory.
bool isBounded(const volume::Parameter& parameter, const PackOptions& options) {
    const bool bounded = options.maxError > 0 || options.absError > 0 || options.psnr > 0 || options.sizeMb > 0;
    return !parameter.categorical && bounded;
}

/// Memory of the bricks being coded, in bytes: samples, flags, codes and coefficients on every thread. Where
/// coefficients are quantised, what a reader will decode is computed beside them, and the time before is predicted
/// from, or what is decoded compared.
double bytesOfBricks(const volume::BrickGrid& grid, const volume::Parameter& parameter, const PackOptions& options) {
    constexpr double kCodes = 12, kWithDecoded = 36;
    const double codes = isBounded(parameter, options) ? kWithDecoded : kCodes;
    const std::size_t brick = brickBytes(grid, parameter.type),
                      atOnce = std::min({std::size_t(mostThreads()), batchOf(brick), grid.brickCount()});
    const double samples = double(brick) / double(volume::byteSize(parameter.type));
    return double(atOnce) * (double(brick) + (1 + codes) * samples);
}

/// Memory of packing in slabs, in bytes.
class SlabCosts {
public:
    SlabCosts(const Metadata& metadata, const volume::DatasetInfo& source, const PackOptions& options)
        : metadata_(metadata), source_(source), options_(options),
          bcc_(metadata.info.lattice.kind == volume::LatticeKind::BCC), d4_(metadata.alternating),
          resampled_(d4_ || (bcc_ && source.lattice.kind == volume::LatticeKind::CC)),
          sourceSlice_(double(source.lattice.size.x) * source.lattice.size.y),
          slice_(double(metadata.info.lattice.size.x) * metadata.info.lattice.size.y) {}

    /// For one parameter, independent of the number of layers.
    double always(const volume::Parameter& parameter) const {
        const std::size_t brick = brickBytes(metadata_.grid, parameter.type);
        return bytesOfBricks(metadata_.grid, parameter, options_) + double(batchOf(brick) * brick);
    }
    double ofLayers(const volume::Parameter& parameter, int layers) const {
        const double bytes = double(volume::byteSize(parameter.type)) + 1; // plus a flag
        const double texels =
            std::min(double(layers) * metadata_.grid.brickSize, double(metadata_.info.lattice.texels().z));
        constexpr double kMargin = 8;   // texels on both sides
        constexpr double kSmoothed = 2; // smoothed samples for importance, bytes per sample
        const double stored = slice_ * texels * (bcc_ ? 2 : 1), around = slice_ * kMargin * (bcc_ ? 2 : 1);
        double made = stored * (bytes + 1);
        if (resampled_) {
            const double slices = (texels + kMargin) * metadata_.info.lattice.spacing.z / source_.lattice.spacing.z +
                                  2 * volume::kMostOrder;
            const double coefficients = isSpline(options_.resample) ? sizeof(double) : 0,
                         edges = options_.resample.sharpen > 0 ? 2 * (d4_ ? sizeof(float) + 1 : bytes) : 0;
            // On D4* a float blend of as many frames as the filter spans is resampled.
            const double blended = d4_ ? sizeof(float) + 1 : bytes;
            const double read = d4_ ? volume::framesSpanned(options_.resample) * bytes + blended : bytes;
            made = sourceSlice_ * std::min(slices, double(source_.lattice.size.z)) *
                       (read + blended + coefficients + edges) +
                   (stored + around) * (bytes + blended + 1 + edges);
        }
        return std::max(made, (stored + around) * (bytes + kSmoothed));
    }
    /// Per slice, while a frame is scanned for its ranges or prefiltered.
    double ofSlice(const volume::Parameter& parameter) const {
        const double bytes = double(volume::byteSize(parameter.type)) + 1;
        return sourceSlice_ *
               (parameter.components * bytes + (isSpline(options_.resample) ? 2 * sizeof(double) + 1 : 0));
    }

private:
    const Metadata& metadata_;
    const volume::DatasetInfo& source_;
    const PackOptions& options_;
    bool bcc_, d4_, resampled_;
    double sourceSlice_, slice_; ///< in samples
};

void refuse(double least, double limit) {
    throw Error("packing data of this size needs about " + std::to_string(std::lround(std::ceil(least / kMega))) +
                " MB, but the limit of memory is " + std::to_string(std::lround(limit / kMega)) + " MB");
}

/// A plan with as many layers as fit (or `layers`, if not 0), and slices that need no more memory than these. `whole`:
/// the memory for whole frames.
MemoryPlan planSlabs(const Metadata& metadata, const volume::DatasetInfo& source, const PackOptions& options,
                     int layers, double whole, double limit) {
    const SlabCosts costs(metadata, source, options);
    const auto most = [&](auto&& bytesOf) {
        double bytes = 0;
        for (const volume::Parameter& parameter : source.parameters) bytes = std::max(bytes, bytesOf(parameter));
        return bytes;
    };
    const double always = kOwn + most([&](const volume::Parameter& parameter) { return costs.always(parameter); });
    const auto ofLayers = [&](int number) {
        return most([&](const volume::Parameter& parameter) { return costs.ofLayers(parameter, number); });
    };
    const double least = always + ofLayers(1);
    if (options.memoryMb > 0 && least > limit) refuse(std::min(least, whole), limit);
    MemoryPlan plan{.keepFrames = false, .readAhead = false, .slabLayers = 1, .slabStep = 1};
    if (layers > 0) plan.slabLayers = layers;
    while (layers == 0 && plan.slabLayers < metadata.grid.count().z && always + ofLayers(plan.slabLayers + 1) <= limit)
        ++plan.slabLayers;
    const double slice = most([&](const volume::Parameter& parameter) { return costs.ofSlice(parameter); });
    plan.slabStep = std::clamp(int(ofLayers(plan.slabLayers) / slice), 1, source.lattice.size.z);
    if (metadata.alternating) { // a slice is blended from many, for all components at once
        const double components = most([](const volume::Parameter& parameter) { return double(parameter.components); });
        plan.slabStep = std::max(1, int(plan.slabLayers * metadata.grid.brickSize / (1 + components)));
    }
    return plan;
}

/// What numbers of regions need at least: a label with a parameter, or with a component and a velocity, of whole frames
/// or of three layers of bricks; twice, since half of it is for bricks.
double bytesForNumbers(const volume::Dataset& dataset) {
    constexpr double kLayers = 3 * 32;
    const volume::DatasetInfo& info = dataset.info;
    double label = 0, most = 0, scalar = 0, vector = 0;
    for (const volume::Parameter& parameter : info.parameters) {
        const double bytes = parameter.components * (double(volume::byteSize(parameter.type)) + 1);
        if (parameter.categorical) label = std::max(label, bytes);
        if (parameter.components == 1) scalar = std::max(scalar, bytes);
        if (parameter.components == 3) vector = std::max(vector, bytes);
        most = std::max(most, bytes);
    }
    const bool inParts = dataset.read.inParts() && info.lattice.kind == volume::LatticeKind::CC;
    const double slices = inParts ? std::min(kLayers, double(info.lattice.size.z)) : double(info.lattice.size.z);
    return 2 * double(info.lattice.size.x) * info.lattice.size.y * slices * (label + std::max(most, scalar + vector));
}

} // namespace

MemoryPlan planMemory(const Metadata& metadata, const volume::Dataset& dataset, const PackOptions& options,
                      int slabLayers) {
    const volume::DatasetInfo& source = dataset.info;
    const double samples = double(source.lattice.count()),
                 stored = std::max(samples, double(metadata.info.lattice.count()));
    const bool resampled = options.lattice != StoredLattice::CC && source.lattice.kind == volume::LatticeKind::CC;
    const double working = resampled ? workingBytes(options.resample) * samples : 0;
    double step = 0, coding = 0, all = 0, last = 0;
    for (const volume::Parameter& parameter : source.parameters) {
        const double bytes = double(volume::byteSize(parameter.type)) + 1; // plus a flag
        step = std::max(step, parameter.components * samples * bytes + stored * bytes + working);
        const bool rounds = isBounded(parameter, options) && parameter.type != volume::ScalarType::F32;
        coding = std::max(coding, (parameter.components + (rounds ? 3 : 2)) * stored * bytes +
                                      bytesOfBricks(metadata.grid, parameter, options));
        all += parameter.components * samples * bytes;
        last += parameter.components * stored * bytes;
    }
    constexpr double kTimesOfD4 = 6; // times kept by the temporal filter
    const bool d4 = options.lattice == StoredLattice::D4;
    const double kept = d4 ? kTimesOfD4 * all : 0;
    const double least = kOwn + kept + std::max(step, coding);
    const double limit = options.memoryMb > 0 ? options.memoryMb * kMega : quarterOfRam();
    // Of a component: source, stored samples, these prefiltered, prediction, and difference, which is coded and kept;
    // of D4* frames of every component too.
    constexpr double kCorrecting = 64, kFramesOfD4 = 10;
    const bool isD4 = options.lattice == StoredLattice::D4;
    const double components = isD4 ? double(componentCount(source)) : 0;
    const bool corrects = kOwn + (kCorrecting + kFramesOfD4 * components) * samples <= limit;
    const double numbers = bytesForNumbers(dataset);
    const auto numberBytes = [&](double held) {
        const double left = limit - kOwn - held;
        return left >= numbers ? static_cast<std::size_t>(left) : 0;
    };
    if (dataset.read.inParts() && (slabLayers > 0 || least > limit)) {
        MemoryPlan slabs = planSlabs(metadata, source, options, slabLayers, least, limit);
        slabs.corrects = corrects;
        slabs.numberBytes = numberBytes(0);
        return slabs;
    }
    if (options.memoryMb > 0 && least > limit) refuse(least, limit);
    MemoryPlan plan;
    plan.corrects = corrects;
    const double frames = source.times.size() > 1 ? (d4 ? 2 : 1) * last : 0;
    plan.keepFrames = least + frames <= limit;
    plan.numberBytes = numberBytes(plan.keepFrames ? frames : 0);
    plan.readAhead = least + (plan.keepFrames ? frames : 0) + step <= limit;
    return plan;
}

} // namespace tessera::codec
