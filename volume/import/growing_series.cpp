#include "volume/import/growing_series.h"

#include "volume/base/error.h"
#include "volume/base/number_text.h"
#include "volume/field/quantities.h"
#include "volume/import/absent.h"
#include "volume/import/opened_series.h"
#include "volume/import/parts_rules.h"

#include <algorithm>
#include <utility>

namespace tessera::volume {

namespace {

std::vector<SeriesFile> entriesOf(const std::vector<std::string>& paths, const ImportOptions& options) {
    std::vector<SeriesFile> entries = expandPaths(paths, outsideBy(options));
    for (SeriesFile& entry : entries) {
        if (!entry.slices.empty()) throw Error("holds a slice of a volume, not a time of a series", entry.path);
        entry.growing = true;
    }
    return entries;
}

/// States the parts of all parameters that no rule names.
void stateParts(const DatasetInfo& info, std::vector<std::string>& rules) {
    const auto isRuled = [stated = rules](const std::string& name) {
        return std::ranges::any_of(stated, [&](const std::string& text) {
            const PartsRule rule = parsePartsRule(text);
            return rule.parameter == name || rule.parameter == "*";
        });
    };
    // Without a label nothing is found.
    if (std::ranges::none_of(info.parameters, &Parameter::categorical)) return;
    for (const Parameter& parameter : info.parameters)
        if (!parameter.categorical && !isRuled(parameter.name)) rules.push_back(partsRule(parameter));
}

} // namespace

GrowingSeries growingSeries(const std::string& first, const ImportOptions& stated, const Progress& progress) {
    if (!stated.times.empty()) throw Error("a series that grows has times of its own", {}, "--times");
    if (!stated.overTime.empty())
        throw Error("a table over time is read with the whole series, not while it grows", {}, "--over-time");
    const OpenedSeries opened = openSeries(entriesOf({first}, stated), stated, true, progress, false);
    GrowingSeries series{first, stated, opened.dataset.info};
    series.options.absent = opened.absent;
    series.options.autoAbsent = false;
    stateParts(series.info, series.options.parts);
    return series;
}

Dataset openOfSeries(const GrowingSeries& series, const std::string& path, const Progress& progress) {
    const bool isFirst = path == series.first;
    const std::vector<std::string> paths = isFirst ? std::vector{path} : std::vector{series.first, path};
    Dataset both = openSeries(entriesOf(paths, series.options), series.options, true, progress, false).dataset;
    if (isFirst) return both;
    const std::vector<double>& known = series.info.times;
    std::vector<int> own;
    for (std::size_t t = 0; t < both.info.times.size(); ++t)
        if (std::ranges::find(known, both.info.times[t]) == known.end()) own.push_back(int(t));
    // Files that all state the same time are told apart by their numbers, which changes the first file's time.
    if (own.size() + known.size() != both.info.times.size())
        throw Error("states the same time as " + series.first + ", so that the times of the series are not known",
                    path);
    for (const Parameter& parameter : both.info.parameters)
        if (std::ranges::find(series.info.parameters, parameter.name, &Parameter::name) == series.info.parameters.end())
            throw Error("holds other arrays than " + series.first + ": " + parameter.name, path);
    if (own.empty()) throw Error("holds other arrays than " + series.first, path);
    return withTimes(std::move(both), own);
}

Dataset timesAfter(Dataset data, double time, const std::string& path) {
    std::vector<int> later;
    for (std::size_t t = 0; t < data.info.times.size(); ++t)
        if (data.info.times[t] > time) later.push_back(int(t));
    if (later.size() == data.info.times.size()) return data;
    if (later.empty())
        throw Error(
            "its time, " + exactText(data.info.times.back()) + ", is not after the last one, " + exactText(time), path);
    return withTimes(std::move(data), later);
}

} // namespace tessera::volume
