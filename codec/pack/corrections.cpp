#include "codec/pack/corrections.h"

#include "codec/pack/error_bound.h"
#include "codec/pack/lossy_field.h"
#include "codec/pack/unpack.h"
#include "volume/base/parallel.h"
#include "volume/field/part_masks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace tessera::codec {

namespace {

using volume::Field;
using volume::ScalarType;

/// Corrections are packed with this bound, relative to ranges that are set to make it the bound of each parameter.
constexpr double kInnerBound = 1.0 / 1024;

/// The bound of a parameter in its unit, as options state it; 0: none. That of a mean error bounds each error.
double statedBound(const PackOptions& options, const volume::Parameter& about) {
    if (about.categorical) return 0;
    const double extent = extentOf(about);
    double bound = std::numeric_limits<double>::infinity();
    if (options.maxError > 0) bound = std::min(bound, options.maxError * extent);
    if (options.absError > 0) bound = std::min(bound, options.absError);
    if (options.psnr > 0) bound = std::min(bound, extent * std::pow(10.0, -options.psnr / 20));
    return std::isfinite(bound) ? bound : 0;
}

/// What of a bound, both in units of stored numbers, the difference may use: less the rounding of both sums, and for
/// integers, which are rounded, up to the next one. `largest`: magnitude of a number.
double boundOfDifference(double bound, const volume::Parameter& about, double largest) {
    constexpr double kHalf = 0.4999, kRounding = 4 * double(std::numeric_limits<float>::epsilon());
    const double rounding = kRounding * largest;
    return (about.type == ScalarType::F32 ? bound : std::floor(bound) + kHalf) - rounding;
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

/// The description of corrections; `bounds` by parameter.
volume::DatasetInfo describe(const volume::DatasetInfo& source, const std::vector<double>& inner) {
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
        about.type = given.categorical ? given.type : inner[p] > 0 ? ScalarType::F32 : ScalarType::U8;
        const std::size_t ranges = given.components == 1 ? 1 : std::size_t(given.components) + 1;
        if (!given.categorical) about.ranges.assign(ranges, {0, inner[p] / kInnerBound});
    }
    return info;
}

} // namespace

Corrections correctionsOf(std::shared_ptr<const Archive> written, const volume::Dataset& source,
                          const PlaceInArchive& place, const PackOptions& options) {
    Corrections out;
    std::vector<double> inner;
    for (std::size_t p = 0; p < source.info.parameters.size(); ++p) {
        const volume::Parameter& about = written->info().parameters[std::size_t(place.parameterOf[p])];
        out.bounds.push_back(statedBound(options, about));
        inner.push_back(out.bounds.back());
        if (inner.back() == 0) continue;
        double largest = 0, scale = 1;
        for (const Range& range : about.ranges) largest = std::max({largest, std::abs(range.lo), std::abs(range.hi)});
        if (about.type != ScalarType::F32) scale = std::abs(source.read(int(p), 0, 0, {0, 1}).scale);
        inner.back() = scale * boundOfDifference(inner.back() / scale, about, largest / scale);
        if (!(inner.back() > 0))
            throw Error("a bound of " + std::to_string(out.bounds.back()) + " is too small to be kept on another "
                            "lattice, for values of this size; pack it on cc",
                        {}, about.name);
    }
    out.options.effort = options.effort;
    out.options.zstdLevel = options.zstdLevel;
    out.options.memoryMb = options.memoryMb;
    if (std::ranges::any_of(inner, [](double bound) { return bound > 0; })) {
        out.options.maxError = kInnerBound;
        out.options.lossless = false;
    }
    out.errors = std::make_shared<std::vector<ResampleError>>(source.info.parameters.size());
    out.data.info = describe(source.info, inner);
    out.data.read = [written, read = volume::withParts(source).read, predict = predictionOf(written, volume::TimeFilter::Cubic),
                     place, inner, errors = out.errors, info = source.info](int parameter, int component, int time) {
        const auto p = std::size_t(parameter);
        const Field given = read(parameter, component, time);
        if (info.parameters[p].categorical) return volume::withoutParts(given);
        const Field predicted = predict(place.parameterOf[p], component, place.firstTime + time, numbersOf(given));
        if (inner[p] > 0) return differenceOf(given, predicted);
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
                p->categorical != corrected.categorical || (p->categorical && p->type != corrected.type))
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
            if (parameter.type == ScalarType::F32 && !parameter.categorical) return true;
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
        if (!correction || about.categorical) return correction;
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
