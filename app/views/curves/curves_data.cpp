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

volume::CurvesQuery queryOf(const PlotCurvesQuery& asked, const volume::DatasetInfo& info) {
    volume::CurvesQuery query;
    query.x = asked.x;
    query.y = asked.y;
    query.label = asked.label;
    query.regions = asked.regions;
    if (asked.brushes.selection.active()) {
        query.doi = samplesQuery(asked.brushes, info, 0).doi;
        query.doiChannels = asked.brushes.channels;
    }
    return query;
}

std::string labelOf(const volume::DatasetInfo& info, const PlotCurvesQuery& asked) {
    return asked.label >= 0 ? info.channel(asked.label).name : std::string();
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
    PlotCurvesQuery query{resolved.x, resolved.y, -1, {}, {}};
    if (!view.region.empty()) {
        const LabelRegion region = findRegion(info, view.region);
        query.label = region.label;
        query.regions = {region.value};
    }
    if (view.brushed) {
        query.brushes = brushedQuery(session, info, {}, {}, 1, false);
        query.brushes.time = {};
        query.brushes.selection.name = selectionName(session);
    }
    return query;
}

volume::Curves readCurves(const volume::BrickSource& source, const NumberOrigin& origin, const PlotCurvesQuery& asked,
                          const Progress& progress) {
    const volume::DatasetInfo& info = source.info();
    volume::CurvesQuery query = queryOf(asked, info);
    if (origin.computed && asked.regions.size() <= 1)
        query.known = [&](int channel, int time) -> std::optional<volume::ChannelStatistics> {
            const auto known = volume::knownStatistics(*origin.computed, info.times[std::size_t(time)],
                                                       labelOf(info, asked), {info.channel(channel).name});
            if (!known) return std::nullopt;
            volume::ChannelStatistics out;
            out.all = known->all.front();
            constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
            out.inside = {0, 0, kNone, kNone, kNone, kNone, 0};
            for (std::size_t r = 0; r < known->regions.size(); ++r)
                if (!asked.regions.empty() && known->regions[r] == asked.regions.front())
                    out.inside = known->summary[r].front();
            return out;
        };
    return volume::computeCurves(source, query, progress);
}

namespace {

/// What statistics are of: ", in anode channel, of starved"; "": everything.
std::string placeOf(const volume::DatasetInfo& info, const PlotCurvesQuery& asked) {
    std::string text;
    for (const int value : asked.regions)
        text += (text.empty() ? ", in " : " and ") + volume::labelName(volume::parameterOf(info, asked.label), value);
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
                      knownStatistics(origin, info, channels, labelOf(info, asked), info.times)) +
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
    std::string names, shared = argumentOf(curves.y[group.front()].name);
    for (const std::size_t y : group) {
        const std::string& name = curves.y[y].name;
        names += (names.empty() ? "" : ", ") + name;
        if (argumentOf(name) != shared) shared.clear();
    }
    return group.size() > 1 && !shared.empty() ? shared : names;
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

std::vector<Plot> curvesPlots(const volume::Curves& curves, std::optional<double> time, bool dark) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::vector<Plot> plots;
    for (const std::vector<std::size_t>& group : curveGroups(curves)) {
        Plot& plot = plots.emplace_back();
        plot.x = {.title = curves.x.name == "time" ? "t" : curves.x.name,
                  .range = paddedRange(rangeOf(curves.x.values, {kInfinity, -kInfinity}), 0.04),
                  .unit = curves.x.unit};
        Range range{kInfinity, -kInfinity};
        for (std::size_t n = 0; n < group.size(); ++n) {
            const volume::Curve& curve = curves.y[group[n]];
            range = rangeOf(curve.values, range);
            PlotSeries& line = plot.series.emplace_back();
            line.name = titleWithUnit(curve.name, curve.unit);
            line.color = plotInk(n, dark);
            line.dots = true;
            for (std::size_t t = 0; t < curves.times.size(); ++t)
                line.points.push_back({curves.x.values[t], curve.values[t]});
            if (!time) continue;
            plot.marks.push_back(curvePoint(curves, group[n], *time));
            if (std::isfinite(plot.marks.back().y)) line.value = groupedNumber(plot.marks.back().y);
        }
        plot.y = {.title = groupTitle(curves, group),
                  .range = paddedRange(range, 0.06),
                  .unit = curves.y[group.front()].unit};
    }
    return plots;
}

VectorPage curvesDrawing(const volume::Curves& curves, std::optional<double> time, const PageForm& form) {
    return plotPage(curvesPlots(curves, time, form.dark), 0, form);
}

} // namespace tessera::app
