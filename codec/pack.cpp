#include "codec/pack.h"

#include "codec/archive_writer.h"
#include "codec/brick_access.h"
#include "codec/continuation.h"
#include "volume/resample.h"
#include "volume/series_dataset.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>

namespace tessera::codec {

namespace {

using volume::Field;
using volume::LatticeKind;
using volume::ScalarType;

/// Adds the seconds of its life to a sum.
class Stopwatch {
public:
    explicit Stopwatch(double& sum) : sum_(sum) {}
    ~Stopwatch() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

private:
    double& sum_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

constexpr Range kNothing{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

void include(Range& range, double value) {
    if (!std::isfinite(value)) return;
    range.lo = std::min(range.lo, value);
    range.hi = std::max(range.hi, value);
}

/// Widens the ranges of a parameter (components, then magnitude) by one time of it.
void gatherRanges(const std::vector<Field>& components, std::vector<Range>& ranges) {
    const std::size_t n = components.size();
    ranges.resize(n == 1 ? 1 : n + 1, kNothing);
    for (std::size_t c = 0; c < n; ++c) {
        const Field& field = components[c];
        Range range = kNothing;
        volume::dispatch(field.type, [&]<class T>(T) {
            const auto stored = field.as<T>();
            for (std::size_t i = 0; i < stored.size(); ++i)
                if (field.present(i)) include(range, static_cast<double>(stored[i]));
        });
        if (range.lo > range.hi) continue;
        include(ranges[c], field.offset + field.scale * range.lo);
        include(ranges[c], field.offset + field.scale * range.hi);
    }
    for (std::size_t i = 0; n > 1 && i < components.front().count(); ++i) {
        double square = 0;
        bool present = true;
        for (const Field& field : components) {
            present = present && field.present(i);
            const double value = field.value(i);
            square += value * value;
        }
        if (present) include(ranges[n], std::sqrt(square));
    }
}

void settleRanges(volume::DatasetInfo& info, const std::vector<std::vector<Range>>& gathered) {
    for (std::size_t p = 0; p < info.parameters.size(); ++p) {
        std::vector<Range>& ranges = info.parameters[p].ranges;
        if (!ranges.empty() || gathered[p].empty()) continue; // known, or not read yet
        ranges = gathered[p];
        for (Range& range : ranges)
            if (range.lo > range.hi) range = {0, 0}; // no sample is present anywhere
    }
}

int defaultLevels(const volume::Lattice& lattice, int brickSize) {
    const glm::ivec3 texels = lattice.texels();
    const int longest = std::min(brickSize, std::max({texels.x, texels.y, texels.z}));
    int levels = 1;
    while (longest >> levels >= 4) ++levels;
    return levels;
}

volume::BrickGrid gridFor(const volume::Lattice& lattice, const PackOptions& options) {
    volume::BrickGrid grid{lattice, options.brickSize, options.levels,
                           levelPhase(waveletOf(options.wavelet).value_or(Wavelet::W22))};
    if (options.brickSize < 4 || options.brickSize > 128 || !std::has_single_bit(unsigned(options.brickSize)))
        throw Error("the brick size must be a power of two from 4 to 128, not " + std::to_string(options.brickSize));
    if (grid.levels == 0) grid.levels = defaultLevels(lattice, grid.brickSize);
    if (grid.levels < 1 || grid.levels > int(std::bit_width(unsigned(grid.brickSize))))
        throw Error(std::to_string(grid.levels) + " levels do not fit bricks of " + std::to_string(grid.brickSize));
    return grid;
}

/// Extent of all components of a parameter: what an error bound refers to.
double extentOf(const volume::Parameter& parameter) {
    double extent = 0;
    for (std::size_t c = 0; c < std::min(parameter.ranges.size(), std::size_t(parameter.components)); ++c)
        extent = std::max(extent, parameter.ranges[c].hi - parameter.ranges[c].lo);
    return extent;
}

/// A bound on the error of stored numbers that gives at least `psnr` dB, found by trial on the frame itself: the error
/// of a quantised number is spread about evenly, so the first guess is rarely far off.
double boundForPsnr(const Field& field, double extent, double psnr) {
    const double wanted = extent * std::pow(10.0, -psnr / 20);
    double bound = std::sqrt(3.0) * wanted;
    const auto samples = field.as<float>();
    for (int trial = 0; trial < 200; ++trial, bound *= 0.97) {
        const NumberCoding numbers = chooseCoding(field, bound);
        if (numbers.kind != NumberKind::Quantised) return bound;
        double squares = 0, count = 0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (!field.present(i) || !std::isfinite(samples[i])) continue;
            const double error = double(sampleOf<float>(numbers, codeOf(numbers, samples[i]))) - double(samples[i]);
            squares += error * error, ++count;
        }
        if (count == 0 || std::sqrt(squares / count) <= wanted) return bound;
    }
    return 0;
}

/// The strictest of the bounds asked for, in stored numbers; 0: exact.
double boundFor(const PackOptions& options, const volume::Parameter& parameter, const Field& field) {
    if (parameter.categorical || field.type != ScalarType::F32) return 0;
    double bound = std::numeric_limits<double>::infinity();
    const double scale = std::abs(field.scale), extent = extentOf(parameter);
    if (options.maxError > 0) bound = std::min(bound, options.maxError * extent / scale);
    if (options.absError > 0) bound = std::min(bound, options.absError / scale);
    if (options.psnr > 0) bound = std::min(bound, boundForPsnr(field, extent / scale, options.psnr));
    return std::isfinite(bound) ? bound : 0;
}

Field loadChecked(volume::Dataset& dataset, int parameter, int component, int time) {
    Field field = dataset.load(parameter, component, time);
    const volume::Parameter& about = dataset.info.parameters[std::size_t(parameter)];
    if (field.lattice.size != dataset.info.lattice.size || field.type != about.type)
        throw Error("frame " + std::to_string(time) + " of " + about.name + " has another size or type");
    return field;
}

/// The parameters with the ranges known so far.
std::vector<volume::Parameter> withRanges(std::vector<volume::Parameter> parameters,
                                          const std::vector<std::vector<Range>>& gathered) {
    volume::DatasetInfo info;
    info.parameters = std::move(parameters);
    settleRanges(info, gathered);
    return std::move(info.parameters);
}

/// One time of every component of a parameter.
std::vector<Field> loadParameter(volume::Dataset& dataset, int parameter, int time) {
    std::vector<Field> fields;
    for (int c = 0; c < dataset.info.parameters[std::size_t(parameter)].components; ++c)
        fields.push_back(loadChecked(dataset, parameter, c, time));
    return fields;
}

} // namespace

PackOptions resolved(PackOptions options) {
    const PackOptions defaults;
    const auto set = [](auto& value, const auto& before, const auto& wanted) {
        if (value == before) value = wanted;
    };
    switch (options.preset) {
    case PackPreset::None:
        break;
    case PackPreset::Lossless:
        set(options.lattice, defaults.lattice, StoredLattice::CC);
        break;
    case PackPreset::Visual:
        set(options.maxError, defaults.maxError, 1e-3);
        break;
    case PackPreset::Small:
        set(options.maxError, defaults.maxError, 1e-2);
        set(options.zstdLevel, defaults.zstdLevel, 19);
        break;
    case PackPreset::Thesis:
        set(options.wavelet, defaults.wavelet, WaveletChoice::W22);
        set(options.brickSize, defaults.brickSize, 16);
        set(options.levels, defaults.levels, 3);
        break;
    }
    options.preset = PackPreset::None;
    return options;
}

namespace {

/// Packs into a new archive, or behind what is in `grown`, whose options `asked` are then.
PackSummary packInto(volume::Dataset& source, const PackOptions& asked, const std::string& path, const Archive* grown,
                     const Progress& progress) {
    const PackOptions options = resolved(asked);
    PackSummary summary;
    if (source.info.parameters.empty() || source.info.times.empty()) throw Error("there is nothing to pack");
    if (!(options.maxError >= 0 && options.maxError < 1)) throw Error("the error bound must be from 0 to below 1");
    if (!(options.absError >= 0) || !(options.psnr >= 0)) throw Error("error bounds must not be negative");
    const bool exact = options.maxError == 0 && options.absError == 0 && options.psnr == 0;
    if (!options.lossless && exact) throw Error("without lossless an error bound is needed");
    if (options.lattice == StoredLattice::CC && source.info.lattice.kind == LatticeKind::BCC)
        throw Error("the data lies on BCC; it cannot be packed as CC");

    Metadata metadata;
    metadata.source = source.info.lattice;
    metadata.alternating = options.lattice == StoredLattice::D4;
    if (metadata.alternating) metadata.sourceTimes = source.info.times;
    volume::Dataset dataset = metadata.alternating ? volume::toD4(source, options.resample) : source;
    volume::DatasetInfo& info = dataset.info;
    const bool toBcc = options.lattice == StoredLattice::BCC && info.lattice.kind == LatticeKind::CC;
    const bool resamples = toBcc || metadata.alternating;
    metadata.info = info;
    metadata.info.lattice = toBcc ? volume::bccFor(info.lattice) : info.lattice;
    metadata.grid = gridFor(metadata.info.lattice, options);
    metadata.lossless = exact;
    metadata.program = "tessera";
    metadata.options = options;
    const Continuation place = grown ? continuationOf(*grown, metadata) : Continuation(info);

    const std::size_t parameters = info.parameters.size(), times = info.times.size();
    std::vector<std::vector<Range>> ranges(parameters);
    Progress work = progress;
    {
        Stopwatch all(summary.seconds);
        // A bound relative to the range of all times needs a pass of its own; one time is read once.
        const bool relative = options.maxError > 0 || options.psnr > 0;
        if (relative && (times > 1 || grown)) {
            const Progress first = progress.part(0, 0.3);
            work = progress.part(0.3, 1);
            for (std::size_t p = 0; p < parameters; ++p)
                for (std::size_t t = 0; t < times && info.parameters[p].ranges.empty(); ++t) {
                    first.advance(double(p * times + t) / double(parameters * times), "ranges");
                    Stopwatch load(summary.loadSeconds);
                    gatherRanges(loadParameter(dataset, int(p), int(t)), ranges[p]);
                }
            settleRanges(info, ranges);
            if (grown) place.widen(info, metadata.info);
        }

        const auto opened =
            grown ? std::make_unique<ArchiveWriter>(*grown, metadata) : std::make_unique<ArchiveWriter>(path, metadata);
        ArchiveWriter& writer = *opened;
        const double frames = double(times) * double(componentCount(info));
        double done = 0;
        // With the ranges known so far; a reader may come at any time.
        const auto soFar = [&] {
            volume::DatasetInfo read = info;
            read.parameters = withRanges(info.parameters, ranges);
            Metadata now = metadata;
            place.widen(read, now.info);
            return now;
        };
        for (std::size_t t = 0; t < times; ++t) {
            for (std::size_t p = 0; p < parameters; ++p) {
                const volume::Parameter& parameter = info.parameters[p];
                std::vector<Field> fields;
                work.advance(done / frames, parameter.name);
                {
                    Stopwatch load(summary.loadSeconds);
                    fields = loadParameter(dataset, int(p), int(t));
                    if (parameter.ranges.empty()) gatherRanges(fields, ranges[p]);
                    if (times == 1) settleRanges(info, ranges);
                }
                FrameOptions frame;
                frame.wavelet = parameter.categorical ? Wavelet::N1 : waveletOf(options.wavelet);
                frame.zstdLevel = options.zstdLevel;
                frame.keepsAbsent = exact && !resamples;
                for (std::size_t c = 0; c < fields.size(); ++c, ++done) {
                    Field field = std::move(fields[c]);
                    if (!metadata.alternating) {
                        summary.sourceSamples += field.count();
                        summary.sourceBytes += field.samples.size();
                    } else if (t < source.info.times.size()) { // as many times as the source has
                        summary.sourceSamples += source.info.lattice.count();
                        summary.sourceBytes += source.info.lattice.count() * volume::byteSize(field.type);
                    }
                    if (toBcc) {
                        Stopwatch resample(summary.resampleSeconds);
                        field =
                            volume::toBcc(field, parameter.categorical, options.resample, Progress{{}, progress.stop});
                    }
                    summary.storedSamples += field.count();
                    // Bounds refer to the range of the whole archive, where that is known by now.
                    const volume::Parameter& whole =
                        grown && relative ? metadata.info.parameters[std::size_t(place.parameterOf[p])] : parameter;
                    frame.maxError = exact ? 0 : boundFor(options, whole, field);
                    const double extent = extentOf(whole);
                    if (extent > 0)
                        metadata.maxError =
                            std::max(metadata.maxError, frame.maxError * std::abs(field.scale) / extent);
                    Stopwatch code(summary.codeSeconds);
                    writer.addFrame(place.parameterOf[p], int(c), int(place.firstTime + t), field, frame,
                                    work.part(done / frames, (done + 1) / frames));
                }
            }
            if (place.wholeTimes && !metadata.alternating) writer.commit(soFar(), place.firstTime + t + 1);
        }
        settleRanges(info, ranges);
        source.info.parameters = info.parameters;
        summary.archiveBytes = writer.finish(soFar());
        summary.addedBytes = summary.archiveBytes - (grown ? grown->fileBytes() : 0);
    }
    progress.advance(1);
    return summary;
}

} // namespace

PackSummary pack(volume::Dataset& source, const PackOptions& options, const std::string& path,
                 const Progress& progress) {
    return packInto(source, options, path, nullptr, progress);
}

PackSummary append(volume::Dataset& source, const std::string& path, const Progress& progress) {
    const Archive grown(path);
    if (grown.metadata().alternating)
        throw Error("an archive of D4* frames does not grow: its last frames are made of all times to their end", path);
    return packInto(source, grown.metadata().options, path, &grown, progress);
}

} // namespace tessera::codec
