#pragma once

#include "volume/field/dataset.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// A small data set of which every number follows from a formula of place and time, so that whatever the program says
/// of it can be computed again in another way.
namespace tessera::app::formula {

inline constexpr int kSize[3] = {8, 7, 9};
inline constexpr double kSpacing[3] = {1e-3, 2e-3, 5e-4}, kOrigin[3] = {0.01, 0, -0.002};
inline constexpr double kTimes[3] = {0, 0.5, 2};
inline constexpr int kWest = 1, kEast = 3; ///< values of the label: x index below 4, and above

struct Place {
    int x = 0, y = 0, z = 0;
};

inline int region(Place at) {
    return at.x < 4 ? kWest : kEast;
}

/// A parameter by name at a sample and a stored time, as a file would hold it; nothing where it is absent: c exists in
/// the west alone.
inline std::optional<float> value(std::string_view name, Place at, int time) {
    const double u = at.x / 7.0, v = at.y / 6.0, w = at.z / 8.0, t = kTimes[time];
    if (name == "region") return float(region(at));
    if (name == "T") return float(300.0131 + 20.17 * u + 10.3 * v * (1 + t) + 5.71 * w + 7.1 * t * t + 3.3 * u * w);
    if (name == "c") return at.x < 4 ? std::optional(float(2.0173 + u + 1.37 * t * w - 0.31 * v)) : std::nullopt;
    const double components[3] = {0.1 + u, -0.3 * v * (1 + t), 1 + w};
    if (name == "U.x") return float(components[0]);
    if (name == "U.y") return float(components[1]);
    if (name == "U.z") return float(components[2]);
    if (name == "|U|") {
        double sum = 0;
        for (const double each : components) sum += double(float(each)) * double(float(each));
        return float(std::sqrt(sum));
    }
    return std::nullopt;
}

/// The same between the stored times around `time`, both weighted; where either is absent, so is it. The length of U is
/// that of such a vector.
inline std::optional<double> valueAt(std::string_view name, Place at, double time) {
    if (name == "|U|") {
        double sum = 0;
        for (const char* component : {"U.x", "U.y", "U.z"}) {
            const double own = valueAt(component, at, time).value();
            sum += own * own;
        }
        return std::sqrt(sum);
    }
    int later = 0;
    while (later < 2 && kTimes[later] < time) ++later;
    const int earlier = later > 0 ? later - 1 : 0;
    const auto a = value(name, at, earlier), b = value(name, at, later);
    if (!a || !b) return std::nullopt;
    const double length = kTimes[later] - kTimes[earlier];
    const double weight = length > 0 ? std::min(1.0, (time - kTimes[earlier]) / length) : 0;
    return (1 - weight) * double(*a) + weight * double(*b);
}

template <class Visit> void forEachPlace(Visit&& visit) {
    for (int z = 0; z < kSize[2]; ++z)
        for (int y = 0; y < kSize[1]; ++y)
            for (int x = 0; x < kSize[0]; ++x) visit(Place{x, y, z});
}

/// Least and most of a channel over all times.
inline Range rangeOf(std::string_view name) {
    Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (int time = 0; time < 3; ++time)
        forEachPlace([&](Place at) {
            const auto v = value(name, at, time);
            if (v) range = {std::min(range.lo, double(*v)), std::max(range.hi, double(*v))};
        });
    return range;
}

/// How much of the cell of a sample lies in the box: half of it at a face, along each axis.
inline double cellShare(Place at) {
    const int index[3] = {at.x, at.y, at.z};
    double share = 1;
    for (int axis = 0; axis < 3; ++axis) share *= index[axis] == 0 || index[axis] == kSize[axis] - 1 ? 0.5 : 1;
    return share;
}

/// Plain statistics: mean and deviation by volume, the rest of samples.
struct Sum {
    double samples = 0, mean = 0, least = 1e300, most = -1e300, deviation = 0;
};

/// Of a channel over the samples that `counts` says.
template <class Counts> Sum summed(const std::string& channel, double time, Counts&& counts) {
    Sum sum;
    std::vector<std::pair<double, double>> values; // and the share of the cell
    double volume = 0;
    forEachPlace([&](Place at) {
        const auto v = valueAt(channel, at, time);
        if (!v || !counts(at)) return;
        values.emplace_back(*v, cellShare(at));
        volume += cellShare(at);
    });
    for (const auto& [v, share] : values) {
        ++sum.samples;
        sum.mean += share * v / volume;
        sum.least = std::min(sum.least, v), sum.most = std::max(sum.most, v);
    }
    for (const auto& [v, share] : values) sum.deviation += share * (v - sum.mean) * (v - sum.mean) / volume;
    sum.deviation = std::sqrt(sum.deviation);
    return sum;
}

/// A channel between samples: linear along each axis, as T is.
inline double between(const std::string& channel, glm::dvec3 at, double time) {
    double cell[3], sum = 0;
    int base[3];
    for (int axis = 0; axis < 3; ++axis) {
        const double place = (at[axis] - kOrigin[axis]) / kSpacing[axis];
        base[axis] = std::clamp(int(std::floor(place + 1e-9)), 0, kSize[axis] - 2);
        cell[axis] = place - base[axis];
    }
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1;
        int index[3];
        for (int axis = 0; axis < 3; ++axis) {
            const int up = corner >> axis & 1;
            weight *= up ? cell[axis] : 1 - cell[axis];
            index[axis] = base[axis] + up;
        }
        sum += weight * valueAt(channel, {index[0], index[1], index[2]}, time).value();
    }
    return sum;
}

/// The data set; `unit` is that of T.
inline volume::Dataset makeCell(const std::string& unit = "K") {
    volume::Dataset cell;
    volume::DatasetInfo& info = cell.info;
    info.name = "formula";
    info.lattice.size = {kSize[0], kSize[1], kSize[2]};
    info.lattice.spacing = {kSpacing[0], kSpacing[1], kSpacing[2]};
    info.lattice.origin = {kOrigin[0], kOrigin[1], kOrigin[2]};
    info.bounds = {info.lattice.origin,
                   info.lattice.origin + info.lattice.spacing * glm::dvec3(kSize[0] - 1, kSize[1] - 1, kSize[2] - 1)};
    info.times = {kTimes[0], kTimes[1], kTimes[2]};
    info.quantities = {{"voltage", "V", {0.7, 0.62, 0.5}}, {"current", "A/m2", {6000, 9000, 17000}}};
    const auto add = [&](const char* name, const std::string& of, std::vector<Range> ranges) -> volume::Parameter& {
        volume::Parameter& made = info.parameters.emplace_back();
        made.name = name, made.unit = of, made.ranges = std::move(ranges);
        return made;
    };
    add("T", unit, {rangeOf("T")});
    add("c", "mol/m3", {rangeOf("c")});
    add("U", "m/s", {rangeOf("U.x"), rangeOf("U.y"), rangeOf("U.z"), rangeOf("|U|")}).components = 3;
    volume::Parameter& label = add("region", "", {rangeOf("region")});
    label.type = volume::ScalarType::U8, label.categorical = true;
    label.labels = {{kWest, "west"}, {kEast, "east"}};
    cell.read = [lattice = info.lattice](int parameter, int component, int time) {
        static constexpr std::string_view kNames[] = {"T", "c", "U", "region"};
        static constexpr std::string_view kComponents[] = {"U.x", "U.y", "U.z"};
        const std::string_view name = parameter == 2 ? kComponents[component] : kNames[parameter];
        volume::Field field =
            volume::makeField(lattice, parameter == 3 ? volume::ScalarType::U8 : volume::ScalarType::F32);
        auto mask = std::make_shared<volume::Mask>(field.count(), std::uint8_t(1));
        bool absent = false;
        std::size_t i = 0;
        forEachPlace([&](Place at) {
            const auto v = value(name, at, time);
            if (!v) {
                (*mask)[i] = 0;
                absent = true;
            }
            if (parameter == 3)
                field.as<std::uint8_t>()[i] = std::uint8_t(v.value_or(0));
            else
                field.as<float>()[i] = v.value_or(0);
            ++i;
        });
        if (absent) field.mask = std::move(mask);
        return field;
    };
    return cell;
}

} // namespace tessera::app::formula
