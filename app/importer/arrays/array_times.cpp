#include "app/importer/arrays/array_times.h"

#include "app/importer/arrays/conventions.h"
#include "volume/base/unit_conversion.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>

namespace tessera::importer {

namespace {

/// The times of one axis in rising order, and the index of each along it.
struct Series {
    int axis = -1;
    std::size_t arrays = 0;
    std::vector<double> times;
    std::vector<std::size_t> index;
    TimeUnit unit;
    bool stated = false;
};

Series seriesOf(const StoredAxis& axis, int number, std::vector<std::string>& notes) {
    Series series;
    series.axis = number;
    series.unit = timeUnitOf(axis.unit);
    series.index.resize(axis.length);
    std::iota(series.index.begin(), series.index.end(), std::size_t(0));
    if (axis.places.size() == axis.length) {
        series.times = axis.places;
        std::ranges::stable_sort(series.index, {}, [&](std::size_t i) { return series.times[i]; });
        std::ranges::sort(series.times);
        series.stated = std::ranges::all_of(series.times, [](double time) { return std::isfinite(time); }) &&
                        std::ranges::adjacent_find(series.times) == series.times.end();
        if (!series.stated)
            notes.push_back("times of \"" + leafOf(axis.name) + "\" are not all different numbers: they count steps");
    }
    if (series.stated) return series;
    std::iota(series.index.begin(), series.index.end(), std::size_t(0));
    series.times.resize(axis.length);
    std::iota(series.times.begin(), series.times.end(), 0.0);
    series.unit = {};
    return series;
}

/// Whether frames may follow each other along an axis that is none of time: not that of components or channels.
bool isSwept(const StoredAxis& axis) {
    if (axis.kind != AxisKind::Other || axis.length <= 4 || axis.name.empty()) return false;
    const std::string word = lowered(leafOf(axis.name));
    return word != "c" && !word.starts_with("comp") && !word.starts_with("vec") && !word.starts_with("chan") &&
           !word.starts_with("band") && !word.starts_with("species") && !word.starts_with("categ");
}

/// Converts the times of one axis to the unit and the zero of another, if that can be done.
bool convert(Series& series, const TimeUnit& to) {
    if (series.unit.unit == to.unit && series.unit.since == to.since) return true;
    const auto factor = volume::unitConversion(series.unit.unit, to.unit);
    const auto seconds = volume::unitConversion("s", to.unit);
    if (!factor) return false;
    double shift = 0;
    if (series.unit.since != to.since) {
        if (!series.unit.epoch || !to.epoch || !seconds) return false;
        shift = (*series.unit.epoch - *to.epoch) * seconds->factor;
    }
    for (double& time : series.times) time = time * factor->factor + shift;
    return true;
}

/// Axes of frames in the order in which most arrays have them.
std::vector<Series> allSeries(const ArrayFile& file, const std::vector<const StoredArray*>& drawn,
                              std::vector<std::string>& notes) {
    std::map<int, std::size_t> counted;
    for (const bool swept : {false, true}) {
        for (const StoredArray* array : drawn) {
            int longest = -1;
            for (const int axis : array->axes)
                if (swept ? isSwept(file.axes[axis]) : file.axes[axis].kind == AxisKind::Time)
                    if (longest < 0 || file.axes[axis].length > file.axes[longest].length) longest = axis;
            if (longest < 0) continue;
            ++counted[longest];
            refuseEndless(array->name, file.axes[longest].length);
        }
        if (!counted.empty()) break;
    }
    std::vector<Series> all;
    for (const auto& [axis, arrays] : counted) {
        if (file.axes[axis].length == 0) continue;
        all.push_back(seriesOf(file.axes[axis], axis, notes));
        all.back().arrays = arrays;
    }
    std::ranges::stable_sort(all, std::greater(), [](const Series& one) {
        return std::pair(one.stated || one.times.size() > 1, one.arrays);
    });
    return all;
}

} // namespace

void refuseEndless(const std::string& name, std::size_t times) {
    constexpr std::size_t kMostTimes = 10'000'000;
    if (times > kMostTimes)
        throw std::runtime_error("array \"" + name + "\" states " + std::to_string(times) + " times, more than " +
                                 std::to_string(kMostTimes));
}

int timeAxisOf(const TimesOfArrays& times, const StoredArray& array) {
    int longest = -1;
    std::size_t length = 0;
    for (std::size_t a = 0; a < array.axes.size(); ++a)
        if (times.along.contains(array.axes[a]) && (longest < 0 || array.dims[a] > length)) {
            longest = array.axes[a];
            length = array.dims[a];
        }
    return longest;
}

TimesOfArrays timesOf(const ArrayFile& file, std::vector<const StoredArray*>& drawn, std::vector<std::string>& notes) {
    TimesOfArrays out;
    std::vector<Series> all = allSeries(file, drawn, notes);
    if (all.empty()) return out;
    const Series first = all.front();
    std::set<double> times;
    std::set<int> refused;
    for (Series& series : all) {
        const bool alike = series.stated == first.stated || series.times.size() == 1;
        if (!alike || (series.stated && !convert(series, first.unit)) ||
            (!series.stated && series.times.size() != first.times.size() && series.times.size() > 1))
            refused.insert(series.axis);
        else if (series.stated == first.stated)
            times.insert(series.times.begin(), series.times.end());
    }
    std::erase_if(drawn, [&](const StoredArray* array) {
        const bool bad = std::ranges::any_of(array->axes, [&](int axis) { return refused.contains(axis); });
        if (bad)
            notes.push_back(
                "\"" + array->name + "\" left out: its times (\"" +
                leafOf(file.axes[*std::ranges::find_if(array->axes, [&](int axis) { return refused.contains(axis); })]
                           .name) +
                "\") do not fit those of the other arrays");
        return bad;
    });
    out.times.assign(times.begin(), times.end());
    std::set<std::size_t> shown;
    for (const Series& series : all) {
        if (refused.contains(series.axis)) continue;
        std::vector<int>& along = out.along[series.axis];
        along.assign(out.times.size(), -1);
        if (series.stated != first.stated) along.assign(out.times.size(), 0); // a single one beside a series
        for (std::size_t i = 0; i < series.times.size() && series.stated == first.stated; ++i) {
            const auto at = std::ranges::lower_bound(out.times, series.times[i]) - out.times.begin();
            along[std::size_t(at)] = int(series.index[i]);
        }
        const auto present = std::ranges::find_if(along, [](int index) { return index >= 0; });
        if (present != along.end()) shown.insert(std::size_t(present - along.begin()));
    }
    out.shownAt.assign(shown.begin(), shown.end());
    const StoredAxis& axis = file.axes[first.axis];
    if (!first.stated && out.times.size() == 1) out.times.clear();
    out.unit = first.stated ? first.unit.unit : "step";
    if (axis.kind == AxisKind::Other) out.name = leafOf(axis.name);
    if (axis.kind == AxisKind::Other && !first.stated) out.unit.clear();
    if (out.times.empty()) out.unit.clear();
    if (!first.unit.since.empty()) notes.push_back("times count from " + first.unit.since);
    return out;
}

} // namespace tessera::importer
