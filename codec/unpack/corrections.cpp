#include "codec/unpack/corrections.h"

#include "volume/field/part_masks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace tessera::codec {

namespace {

using volume::Field;
using volume::ScalarType;

/// Corrections are packed with this bound, relative to ranges that are set to make it the bound of each parameter.
constexpr double kInnerBound = 1.0 / 1024;

/// What a correction says of a parameter: the unit of its numbers in the archive inside.
constexpr const char *kPresence = "presence", *kDifference = "difference", *kSample = "sample";

/// The bound of a parameter in its unit, as options state it; 0: none. That of a mean error bounds each error.
double statedBound(const PackOptions& options, const volume::Parameter& about) {
    if (about.categorical) return 0;
    double extent = extentOf(about);
    for (int c = 0; options.ofComponents && c < std::min(about.components, int(about.ranges.size())); ++c) {
        const Range& own = about.ranges[std::size_t(c)];
        if (own.hi > own.lo) extent = std::min(extent, own.hi - own.lo);
    }
    double bound = std::numeric_limits<double>::infinity();
    if (options.maxError > 0) bound = std::min(bound, options.maxError * extent);
    if (options.absError > 0) bound = std::min(bound, options.absError);
    if (options.psnr > 0) bound = std::min(bound, extent * std::pow(10.0, -options.psnr / 20));
    return std::isfinite(bound) ? bound : 0;
}

/// What of a bound, both in units of stored numbers, a difference may use: less the rounding of differences to floats,
/// for floats also that of the sums, and for integers, which are rounded, up to the next one. `largest`: magnitude of a
/// number; `extent`: of its range.
double boundOfDifference(double bound, const volume::Parameter& about, double largest, double extent) {
    constexpr double kHalf = 0.4999, kRounding = 0.55 * double(std::numeric_limits<float>::epsilon());
    if (about.type != ScalarType::F32) return std::floor(bound) + kHalf - kRounding * extent;
    return bound - kRounding * (largest + 2 * extent);
}

/// The numbers of parts for every sample, 0 where it is absent.
std::shared_ptr<const volume::Mask> numbersOf(const Field& field) {
    return field.mask ? field.mask : std::make_shared<const volume::Mask>(field.count(), std::uint8_t(1));
}

/// The stored number of a sample in the units of another field.
double numberIn(const Field& field, std::size_t i, const Field& units) {
    return (field.value(i) - units.offset) / units.scale;
}
bool sameUnits(const Field& a, const Field& b) {
    return a.offset == b.offset && a.scale == b.scale;
}

/// A prediction with its correction.
Field sumOf(const Field& predicted, const Field& correction) {
    Field out = predicted;
    out.offset = correction.offset;
    out.scale = correction.scale;
    out.mask = correction.mask;
    const bool differs = correction.type == ScalarType::F32, same = sameUnits(predicted, correction);
    if (!differs && same) return out;
    volume::dispatch(out.type, [&]<class T>(T) {
        const auto from = predicted.as<T>();
        const auto to = out.as<T>();
        const float* const added = differs ? correction.as<float>().data() : nullptr;
        for (std::size_t i = 0; i < to.size(); ++i) {
            if (!out.present(i)) continue;
            double number = same ? double(from[i]) : numberIn(predicted, i, out);
            if (added != nullptr) number += double(added[i]);
            if constexpr (std::is_floating_point_v<T>)
                to[i] = static_cast<T>(number);
            else
                to[i] = static_cast<T>(std::nearbyint(std::clamp(number, double(std::numeric_limits<T>::lowest()),
                                                                 double(std::numeric_limits<T>::max()))));
        }
    });
    return out;
}

/// An empty correction with the units and the presence of a source.
Field emptyCorrection(const Field& source, ScalarType type) {
    Field out = volume::makeField(source.lattice, type);
    out.offset = source.offset;
    out.scale = source.scale;
    out.mask = source.mask;
    return volume::withoutParts(std::move(out));
}

Field differenceOf(const Field& source, const Field& predicted) {
    Field out = emptyCorrection(source, ScalarType::F32);
    const auto to = out.as<float>();
    const bool same = sameUnits(source, predicted);
    volume::dispatch(source.type, [&]<class T>(T) {
        const auto number = source.as<T>(), from = predicted.as<T>();
        for (std::size_t i = 0; i < to.size(); ++i)
            if (out.present(i))
                to[i] = float(double(number[i]) - (same ? double(from[i]) : numberIn(predicted, i, source)));
    });
    return out;
}

ResampleError errorOf(const Field& source, const Field& back) {
    ResampleError error;
    double squares = 0;
    for (std::size_t i = 0; i < source.count(); ++i) {
        if (!source.present(i)) continue;
        const double apart = std::abs(source.value(i) - back.value(i));
        if (!std::isfinite(apart)) continue;
        squares += apart * apart;
        error.largest = std::max(error.largest, apart);
        error.samples += 1;
    }
    error.meanSquare = error.samples > 0 ? squares / error.samples : 0;
    return error;
}

/// How a parameter is corrected.
struct Way {
    const char* kind = kSample;
    double bound = 0; ///< of the numbers of the correction, in the unit of the parameter
};

/// The way of a parameter of an archive whose stored bound is `bound`; `scale`: of its stored numbers.
Way wayOf(const volume::Parameter& about, double bound, double scale) {
    if (about.categorical) return {kSample, 0};
    if (bound == 0) return {kPresence, 0};
    double largest = 0;
    for (const Range& range : about.ranges) largest = std::max({largest, std::abs(range.lo), std::abs(range.hi)});
    const double left = scale * boundOfDifference(bound / scale, about, largest / scale, extentOf(about) / scale);
    // Where differences of floats are too coarse the samples themselves are packed within the bound.
    return left > 0.5 * bound || (left > 0 && about.type != ScalarType::F32) ? Way{kDifference, left}
                                                                             : Way{kSample, bound};
}

/// The description of corrections; `ways` by parameter.
volume::DatasetInfo describe(const volume::DatasetInfo& source, const std::vector<Way>& ways) {
    volume::DatasetInfo info;
    info.name = "corrections";
    info.lattice = source.lattice;
    info.bounds = source.bounds;
    info.times = source.times;
    for (std::size_t p = 0; p < source.parameters.size(); ++p) {
        const volume::Parameter& given = source.parameters[p];
        volume::Parameter& about = info.parameters.emplace_back();
        about.name = given.name;
        about.components = given.components;
        about.categorical = given.categorical;
        about.unit = ways[p].kind;
        about.type = ways[p].kind == kSample       ? given.type
                     : ways[p].kind == kDifference ? ScalarType::F32
                                                   : ScalarType::U8;
        const std::size_t ranges = given.components == 1 ? 1 : std::size_t(given.components) + 1;
        if (!given.categorical) about.ranges.assign(ranges, {0, ways[p].bound / kInnerBound});
    }
    return info;
}

} // namespace

Corrections correctionsOf(std::shared_ptr<const Archive> written, const volume::Dataset& source,
                          const PlaceInArchive& place, const PackOptions& options) {
    Corrections out;
    std::vector<Way> ways;
    for (std::size_t p = 0; p < source.info.parameters.size(); ++p) {
        const volume::Parameter& about = written->info().parameters[std::size_t(place.parameterOf[p])];
        out.bounds.push_back(statedBound(options, about));
        const bool scales = about.type != ScalarType::F32 && out.bounds.back() > 0;
        const double scale = scales ? std::abs(source.read(int(p), 0, 0, {0, 1}).scale) : 1;
        ways.push_back(wayOf(about, out.bounds.back(), scale));
    }
    out.options.effort = options.effort;
    out.options.zstdLevel = options.zstdLevel;
    if (std::ranges::any_of(ways, [](const Way& way) { return way.bound > 0; })) {
        out.options.maxError = kInnerBound;
        out.options.lossless = false;
    }
    out.errors = std::make_shared<std::vector<ResampleError>>(source.info.parameters.size());
    out.data.info = describe(source.info, ways);
    out.data.read = [written, read = volume::withParts(source).read,
                     predict = predictionOf(written, volume::TimeFilter::Cubic), place, ways,
                     errors = out.errors](int parameter, int component, int time) {
        const auto p = std::size_t(parameter);
        const Field given = read(parameter, component, time);
        if (ways[p].kind == kSample) return volume::withoutParts(given);
        const Field predicted = predict(place.parameterOf[p], component, place.firstTime + time, numbersOf(given));
        if (ways[p].kind == kDifference) return differenceOf(given, predicted);
        Field correction = emptyCorrection(given, ScalarType::U8);
        (*errors)[p].add(errorOf(given, sumOf(predicted, correction)));
        return correction;
    };
    return out;
}

namespace {

/// Where the corrections of a parameter at a time of the source are; archive null: there are none.
struct Place {
    std::shared_ptr<const Archive> archive;
    int parameter = 0, time = 0;
};

/// Whether a correction has the type that its kind says.
bool fits(const volume::Parameter& correction, const volume::Parameter& of) {
    if (correction.unit == kSample) return correction.type == of.type;
    return !of.categorical && ((correction.unit == kPresence && correction.type == ScalarType::U8) ||
                               (correction.unit == kDifference && correction.type == ScalarType::F32));
}

/// [time of the source][parameter]
std::vector<std::vector<Place>> placesOf(const Archive& archive) {
    const Metadata& metadata = archive.metadata();
    const std::vector<double>& times = metadata.alternating ? metadata.sourceTimes : metadata.info.times;
    std::vector<std::vector<Place>> places(times.size(), std::vector<Place>(metadata.info.parameters.size()));
    for (const std::shared_ptr<const Archive>& inner : archive.corrections())
        for (std::size_t q = 0; q < inner->info().parameters.size(); ++q) {
            const volume::Parameter& corrected = inner->info().parameters[q];
            const auto p = std::ranges::find(metadata.info.parameters, corrected.name, &volume::Parameter::name);
            if (p == metadata.info.parameters.end() || p->components != corrected.components ||
                p->categorical != corrected.categorical || !fits(corrected, *p))
                throw Error("there are corrections of no parameter", archive.path(), corrected.name);
            for (std::size_t t = 0; t < inner->info().times.size(); ++t) {
                const auto at = std::ranges::find(times, inner->info().times[t]);
                if (at == times.end()) continue; // of a growing archive
                places[std::size_t(at - times.begin())][std::size_t(p - metadata.info.parameters.begin())] = {
                    inner, int(q), int(t)};
            }
        }
    return places;
}

} // namespace

bool isCorrected(const Archive& archive) {
    const auto places = placesOf(archive);
    return std::ranges::all_of(places, [](const auto& ofTime) {
        return std::ranges::all_of(ofTime, [](const Place& place) { return place.archive != nullptr; });
    });
}

bool hasDifferences(const Archive& archive) {
    for (const std::shared_ptr<const Archive>& inner : archive.corrections())
        for (const volume::Parameter& parameter : inner->info().parameters)
            if (parameter.unit == kDifference) return true;
    return false;
}

CorrectedReader correctedReader(std::shared_ptr<const Archive> archive, Prediction prediction) {
    struct KeptLabel {
        int parameter = -1, time = -1;
        Field field;
    };
    return [archive, prediction = std::move(prediction), places = placesOf(*archive),
            kept = std::make_shared<KeptLabel>()](int parameter, int component, int time) -> std::optional<Field> {
        const auto fieldAt = [&](int p, int c) -> std::optional<Field> {
            const Place& place = places[std::size_t(time)][std::size_t(p)];
            if (!place.archive) return std::nullopt;
            Field field = readField(*place.archive, place.parameter, c, place.time);
            field.lattice = archive->metadata().source;
            return field;
        };
        const volume::Parameter& about = archive->info().parameters[std::size_t(parameter)];
        std::optional<Field> correction = fieldAt(parameter, component);
        if (!correction) return std::nullopt;
        const Place& own = places[std::size_t(time)][std::size_t(parameter)];
        const bool isSample = own.archive->info().parameters[std::size_t(own.parameter)].unit == kSample;
        if (isSample) return correction;
        Field parted = *correction;
        if (const int label = volume::labelOf(archive->info(), about); label >= 0) {
            if (kept->parameter != label || kept->time != time) {
                std::optional<Field> labels = fieldAt(label, 0);
                if (!labels) return std::nullopt;
                *kept = {label, time, std::move(*labels)};
            }
            parted = volume::withParts(std::move(parted), kept->field, about.parts);
        }
        return sumOf(prediction(parameter, component, time, numbersOf(parted)), *correction);
    };
}

} // namespace tessera::codec
