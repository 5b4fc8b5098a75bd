#include "app/views/curves/curves_data.h"

#include "app/pane/view_parts.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/values/selection_text.h"
#include "volume/base/error.h"
#include "volume/field/time_pair.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::app {

namespace {

constexpr std::size_t kMostQuantities = 8; ///< where the user has not chosen
/// What stands between the parentheses of "mean(T)"; "" of other formulas.
std::string argumentOf(const std::string& formula) {
    const std::size_t open = formula.find('(');
    const bool one = open != std::string::npos && open > 0 && formula.find('(', open + 1) == std::string::npos &&
                     formula.find_first_of(")+-*/^") == formula.size() - 1;
    return one ? formula.substr(open + 1, formula.size() - open - 2) : std::string();
}

volume::CurvesQuery queryOf(const PlotCurvesQuery& asked, const volume::DatasetInfo& info, const LabelRegion* region) {
    volume::CurvesQuery query;
    query.x = asked.x;
    query.y = asked.y;
    if (region != nullptr) {
        query.label = region->label;
        query.regions = {region->value};
    }
    if (asked.brushes.selection.active()) {
        query.doi = samplesQuery(asked.brushes, info, 0).doi;
        query.doiChannels = asked.brushes.channels;
    }
    return query;
}

std::string curveLabel(const volume::DatasetInfo& info, const PlotCurvesQuery& asked) {
    return asked.regions.empty() ? std::string() : info.channel(asked.regions.front().label).name;
}

/// Whether a formula has a statistic of a parameter in it, which depends on the region.
bool hasStatistic(const std::string& formula) {
    constexpr std::string_view kStatistics[] = {"mean(",  "min(",    "max(",     "deviation(",
                                                "share(", "volume(", "integral("};
    return std::ranges::any_of(kStatistics, [&](std::string_view word) { return formula.find(word) != formula.npos; });
}

constexpr std::string_view kIn = ") in "; ///< before the region in the name of a curve

std::string withoutRegion(const std::string& name) {
    return name.substr(0, std::min(name.size(), name.find(kIn) + (name.find(kIn) == name.npos ? 0 : 1)));
}

bool sameAxis(const volume::Curves& curves) {
    return curves.x.values == curves.times;
}

} // namespace

Range rangeOf(const std::vector<double>& values, Range range) {
    for (const double value : values)
        if (std::isfinite(value)) range = {std::min(range.lo, value), std::max(range.hi, value)};
    return range;
}

std::vector<LabelRegion> labelRegions(const volume::DatasetInfo& info) {
    std::vector<LabelRegion> out;
    const std::vector<volume::Channel> channels = info.channels();
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const volume::Parameter& parameter = info.parameters[std::size_t(channels[c].parameter)];
        if (!parameter.categorical) continue;
        for (const volume::Label& label : parameter.labels)
            out.push_back({static_cast<int>(c), label.value,
                           parameter.name + " " + std::to_string(label.value) +
                               (label.name.empty() ? "" : " (" + label.name + ")")});
    }
    return out;
}

LabelRegion findRegion(const volume::DatasetInfo& info, const std::string& text) {
    const std::vector<volume::Channel> channels = info.channels();
    std::string known;
    std::vector<LabelRegion> byValue;
    for (const LabelRegion& region : labelRegions(info)) {
        const volume::Parameter& parameter =
            info.parameters[std::size_t(channels[std::size_t(region.label)].parameter)];
        const auto label = std::ranges::find(parameter.labels, region.value, &volume::Label::value);
        const std::string value = std::to_string(region.value);
        if (text == parameter.name + "=" + value || (!label->name.empty() && text == label->name) ||
            text == parameter.name + "=" + label->name)
            return region;
        if (text == value) byValue.push_back(region);
        known += (known.empty() ? "" : ", ") + region.name;
    }
    if (byValue.size() == 1) return byValue.front();
    throw Error(known.empty() ? "the data have no label that names regions"
                              : "no region of this name; known are " + known,
                {}, text);
}

CurvesView resolvedCurves(const CurvesView& view, const volume::DatasetInfo& info) {
    CurvesView out = view;
    if (out.y.empty()) {
        const volume::CellQuantities cell = volume::cellQuantities(info);
        if (out.x.empty() && !cell.voltage.empty() && !cell.current.empty()) {
            out.x = cell.current;
            out.y = {cell.voltage};
        }
        for (const volume::Quantity& quantity : info.quantities)
            if (out.x != cell.current && quantity.name != out.x && out.y.size() < kMostQuantities)
                out.y.push_back(quantity.name);
        if (out.y.empty())
            for (const int channel : comparedChannels(info)) {
                out.y = {"mean(" + info.channel(channel).name + ")"};
                break;
            }
    }
    if (out.x.empty()) out.x = info.timeName;
    return out;
}

PlotCurvesQuery plotCurvesQuery(const CurvesView& view, const Session& session, const volume::DatasetInfo& info) {
    const CurvesView resolved = resolvedCurves(view, info);
    PlotCurvesQuery query{resolved.x, resolved.y, {}, {}};
    for (const std::string& name : view.apart) {
        const LabelRegion region = findRegion(info, name);
        if (std::ranges::find(query.regions, region) == query.regions.end()) query.regions.push_back(region);
    }
    if (!view.region.empty() && query.regions.empty()) query.regions = {findRegion(info, view.region)};
    if (view.brushed) {
        query.brushes = brushedQuery(session, info, {}, {}, 1, false);
        query.brushes.time = {};
        query.brushes.selection.name = selectionName(session);
    }
    return query;
}

namespace {

volume::Curves readCurvesOf(const volume::BrickSource& source, const NumberOrigin& origin, const PlotCurvesQuery& asked,
                            const LabelRegion* region, const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    volume::CurvesQuery query = queryOf(asked, info, region);
    const std::string label = region != nullptr ? info.channel(region->label).name : std::string();
    if (origin.computed)
        query.known = [&](int channel, int time) -> std::optional<volume::ChannelStatistics> {
            const auto known = volume::knownStatistics(*origin.computed, info.times[std::size_t(time)], label,
                                                       {info.channel(channel).name});
            if (!known) return std::nullopt;
            volume::ChannelStatistics out;
            out.all = known->all.front();
            constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
            out.inside = {0, 0, kNone, kNone, kNone, kNone, 0};
            for (std::size_t r = 0; r < known->regions.size(); ++r)
                if (region != nullptr && known->regions[r] == region->value) out.inside = known->summary[r].front();
            return out;
        };
    return volume::computeCurves(source, query, progress);
}

/// As people read it: names need no back quotes.
void dropQuotes(volume::Curve& curve) {
    std::erase(curve.name, '`');
}

} // namespace

volume::Curves readCurves(const volume::BrickSource& source, const NumberOrigin& origin, const PlotCurvesQuery& asked,
                          const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    const std::size_t count = asked.regions.size();
    if (count > 1 && hasStatistic(asked.x))
        throw Error("curves of several regions need a horizontal axis that is the same for all: time or a quantity", {},
                    asked.x);
    volume::Curves out = readCurvesOf(source, origin, asked, count > 0 ? &asked.regions[0] : nullptr,
                                      progress.part(0, 1 / double(std::max<std::size_t>(1, count))));
    const auto nameRegion = [&](volume::Curve& curve, std::size_t r) {
        curve.name +=
            " in " + volume::labelName(volume::parameterOf(info, asked.regions[r].label), asked.regions[r].value);
    };
    std::vector<volume::Curve> curves;
    for (std::size_t y = 0; y < out.y.size(); ++y) {
        curves.push_back(out.y[y]);
        if (count > 0 && hasStatistic(asked.y[y])) nameRegion(curves.back(), 0);
    }
    for (std::size_t r = 1; r < count; ++r) {
        const volume::Curves other =
            readCurvesOf(source, origin, asked, &asked.regions[r],
                         progress.part(double(r) / double(count), double(r + 1) / double(count)));
        for (std::size_t y = 0; y < other.y.size(); ++y) {
            if (!hasStatistic(asked.y[y])) continue;
            curves.push_back(other.y[y]);
            nameRegion(curves.back(), r);
        }
    }
    // A parameter that a region does not have has no curve there, unless it has none at all.
    const auto empty = [](const volume::Curve& curve) {
        return std::ranges::none_of(curve.values, [](double value) { return std::isfinite(value); });
    };
    if (count > 1 && !std::ranges::all_of(curves, empty)) std::erase_if(curves, empty);
    out.y = std::move(curves);
    dropQuotes(out.x);
    for (volume::Curve& curve : out.y) dropQuotes(curve);
    return out;
}

namespace {

/// What statistics are of: ", in anode channel, of starved"; "": everything.
std::string placeOf(const volume::DatasetInfo& info, const PlotCurvesQuery& asked) {
    std::string text;
    for (const LabelRegion& region : asked.regions)
        text += (text.empty() ? ", in " : " and ") +
                volume::labelName(volume::parameterOf(info, region.label), region.value);
    return text + (asked.brushes.selection.active() ? ", of " + asked.brushes.selection.name : "");
}

} // namespace

std::string curvesOrigin(const volume::DatasetInfo& info, const NumberOrigin& origin, const PlotCurvesQuery& asked) {
    std::vector<int> channels;
    const auto count = int(info.channels().size());
    bool integrals = false;
    for (int channel = 0; channel < count; ++channel) {
        const std::string argument = "(" + info.channel(channel).name + ")";
        const auto names = [&](const std::string& formula) { return formula.find(argument) != formula.npos; };
        if (names(asked.x) || std::ranges::any_of(asked.y, names)) channels.push_back(channel);
    }
    for (const std::string& formula : asked.y) integrals = integrals || formula.find("integral(") != formula.npos;
    if (channels.empty() || integrals || asked.brushes.selection.active() || asked.regions.size() > 1)
        return originText(origin, info, channels) + (channels.empty() ? "" : placeOf(info, asked));
    return originText(origin, info, channels,
                      knownStatistics(origin, info, channels, curveLabel(info, asked), info.times)) +
           placeOf(info, asked);
}

std::vector<std::vector<std::size_t>> curveGroups(const volume::Curves& curves) {
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t i = 0; i < curves.y.size(); ++i) {
        const auto same = std::ranges::find_if(groups, [&](const std::vector<std::size_t>& group) {
            return !curves.y[i].unit.empty() && curves.y[group.front()].unit == curves.y[i].unit;
        });
        if (same == groups.end())
            groups.push_back({i});
        else
            same->push_back(i);
    }
    return groups;
}

std::string groupTitle(const volume::Curves& curves, const std::vector<std::size_t>& group) {
    std::vector<std::string> names;
    std::string list, shared = argumentOf(withoutRegion(curves.y[group.front()].name));
    for (const std::size_t y : group) {
        const std::string name = withoutRegion(curves.y[y].name);
        if (argumentOf(name) != shared) shared.clear();
        if (std::ranges::find(names, name) != names.end()) continue;
        names.push_back(name);
        list += (list.empty() ? "" : ", ") + name;
    }
    return names.size() > 1 && !shared.empty() ? shared : list;
}

glm::dvec2 curvePoint(const volume::Curves& curves, std::size_t y, double time) {
    const volume::TimePair at = volume::timesAround(curves.times, time);
    const auto value = [&at](const std::vector<double>& values) {
        const double earlier = values[std::size_t(at.earlier)];
        return at.between() ? (1 - at.weight) * earlier + at.weight * values[std::size_t(at.later)] : earlier;
    };
    return {value(curves.x.values), value(curves.y[y].values)};
}

Table curvesTable(const volume::Curves& curves) {
    Table table;
    table.columns.push_back({.name = curves.timeName, .unit = curves.timeUnit});
    if (!sameAxis(curves)) table.columns.push_back({.name = curves.x.name, .unit = curves.x.unit});
    for (const volume::Curve& curve : curves.y) table.columns.push_back({.name = curve.name, .unit = curve.unit});
    for (const std::vector<double>& row : volume::curveRows(curves))
        for (std::size_t i = 0; i < row.size(); ++i) table.columns[i].numbers.push_back(row[i]);
    return table;
}

namespace {

/// Adds the curves of a group; `first`: how many inks others have used. Returns their axis.
PlotAxis addGroup(Plot& plot, const volume::Curves& curves, const std::vector<std::size_t>& group,
                  std::optional<double> time, bool dark, std::size_t first) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Range range{kInfinity, -kInfinity};
    for (std::size_t n = 0; n < group.size(); ++n) {
        const volume::Curve& curve = curves.y[group[n]];
        range = rangeOf(curve.values, range);
        PlotSeries& line = plot.series.emplace_back();
        line.name = titleWithUnit(curve.name, curve.unit);
        line.color = plotInk(first + n, dark);
        line.dots = true;
        for (std::size_t t = 0; t < curves.times.size(); ++t)
            line.points.push_back({curves.x.values[t], curve.values[t]});
        if (!time) continue;
        plot.marks.push_back(curvePoint(curves, group[n], *time));
        if (std::isfinite(plot.marks.back().y)) line.value = groupedNumber(plot.marks.back().y);
    }
    return {
        .title = groupTitle(curves, group), .range = paddedRange(range, 0.06), .unit = curves.y[group.front()].unit};
}

/// Moves what was added for another axis there: its series, and its marks to their places on the left one.
void turnRight(Plot& plot, const PlotAxis& axis, std::size_t firstSeries, std::size_t firstMark) {
    for (std::size_t i = firstSeries; i < plot.series.size(); ++i) plot.series[i].right = true;
    const Range from = axis.range, to = plot.y.range;
    for (std::size_t i = firstMark; i < plot.marks.size(); ++i)
        plot.marks[i].y = to.lo + (plot.marks[i].y - from.lo) / (from.hi - from.lo) * (to.hi - to.lo);
    plot.right = axis;
    if (firstSeries == 1) plot.y.ink = plot.series.front().color;
    if (plot.series.size() == firstSeries + 1) plot.right->ink = plot.series.back().color;
}

} // namespace

std::vector<Plot> curvesPlots(const volume::Curves& curves, std::optional<double> time, bool dark, bool together) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::vector<Plot> plots;
    const std::vector<std::vector<std::size_t>> groups = curveGroups(curves);
    for (const std::vector<std::size_t>& group : groups) {
        if (together && groups.size() == 2 && !plots.empty()) {
            Plot& shared = plots.front();
            const std::size_t series = shared.series.size(), marks = shared.marks.size();
            const PlotAxis axis = addGroup(shared, curves, group, time, dark, series);
            turnRight(shared, axis, series, marks);
            continue;
        }
        Plot& plot = plots.emplace_back();
        plot.x = {.title = curves.x.name == "time" ? "t" : curves.x.name,
                  .range = paddedRange(rangeOf(curves.x.values, {kInfinity, -kInfinity}), 0.04),
                  .unit = curves.x.unit};
        plot.y = addGroup(plot, curves, group, time, dark, 0);
    }
    return plots;
}

VectorPage curvesDrawing(const volume::Curves& curves, std::optional<double> time, const PageForm& form,
                         bool together) {
    return plotPage(curvesPlots(curves, time, form.dark, together), 0, form);
}

} // namespace tessera::app
