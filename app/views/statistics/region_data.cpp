#include "app/views/statistics/region_data.h"

#include "app/session/label_colors.h"
#include "app/ui/ticks.h"
#include "app/values/selection_text.h"
#include "volume/base/error.h"
#include "volume/base/unit_product.h"
#include "volume/bricks/source_at_time.h"
#include "volume/flow/flow_channels.h"
#include "volume/flow/sections.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

volume::RegionStatistics countRegions(const std::shared_ptr<const volume::BrickSource>& source,
                                      const RegionQuery& asked, const std::vector<int>& channels,
                                      const Progress& progress) {
    const volume::SourceAtTime shown = volume::sourceAt(source, asked.time);
    volume::RegionStatisticsQuery query;
    query.channels = channels;
    query.label = asked.label;
    query.time = shown.time;
    if (asked.label >= 0)
        query.regions = volume::labelValues(*shown.source, asked.label, shown.time, progress.part(0, 0.2));
    if (asked.brushes.selection.active()) { // brushes ask for channels of their own, after the others
        query.channels.insert(query.channels.end(), asked.brushes.channels.begin(), asked.brushes.channels.end());
        query.doi = [doi = samplesQuery(asked.brushes, source->info(), 0).doi, first = channels.size()](
                        std::span<const float> values, glm::dvec3 at) { return doi(values.subspan(first), at); };
    }
    volume::RegionStatistics out = volume::computeRegionStatistics(*shown.source, query, progress.part(0.2, 1));
    out.all.resize(channels.size());
    for (auto& summary : out.summary) summary.resize(channels.size());
    return out;
}

std::string labelNamed(const volume::DatasetInfo& info, int label) {
    return label >= 0 ? info.channel(label).name : std::string();
}

/// Statistics of one channel from those of several.
struct OfChannel {
    const volume::RegionStatistics* of;
    std::size_t position;
};

/// Statistics of channels from several sources, by the regions of all of them.
volume::RegionStatistics together(const std::vector<OfChannel>& channels) {
    volume::RegionStatistics out = *channels.front().of;
    for (const OfChannel& channel : channels)
        for (std::size_t r = 0; r < channel.of->regions.size(); ++r) {
            const auto at = std::ranges::lower_bound(out.regions, channel.of->regions[r]);
            if (at != out.regions.end() && *at == channel.of->regions[r]) continue;
            const auto place = at - out.regions.begin();
            out.regions.insert(at, channel.of->regions[r]);
            out.samples.insert(out.samples.begin() + place, channel.of->samples[r]);
            out.volume.insert(out.volume.begin() + place, channel.of->volume[r]);
        }
    out.all.clear();
    out.summary.assign(out.regions.size(), std::vector<volume::Summary>(channels.size()));
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const auto& [of, position] = channels[c];
        out.all.push_back(of->all[position]);
        for (std::size_t r = 0; r < of->regions.size(); ++r) {
            const auto to = std::size_t(std::ranges::lower_bound(out.regions, of->regions[r]) - out.regions.begin());
            out.summary[to][c] = of->summary[r][position];
        }
    }
    return out;
}

} // namespace

bool isKnown(const NumberOrigin& origin, const volume::DatasetInfo& info, const RegionQuery& asked) {
    const std::vector<bool> known = knownStatistics(origin, info, asked.channels, labelNamed(info, asked.label),
                                                    {info.times[std::size_t(asked.time.earlier)]});
    return !asked.time.between() && !asked.brushes.selection.active() &&
           std::ranges::all_of(known, [](bool each) { return each; });
}

RegionNumbers readRegions(const std::shared_ptr<const volume::BrickSource>& source, const NumberOrigin& origin,
                          const RegionQuery& asked, const Progress& progress) {
    const volume::DatasetInfo& info = source->info();
    const double time = info.times[std::size_t(asked.time.earlier)];
    const std::string label = labelNamed(info, asked.label);
    std::vector<std::optional<volume::RegionStatistics>> known(asked.channels.size());
    std::vector<int> others;
    for (std::size_t c = 0; c < asked.channels.size(); ++c) {
        if (origin.computed && !asked.time.between() && !asked.brushes.selection.active())
            known[c] = volume::knownStatistics(*origin.computed, time, label, {info.channel(asked.channels[c]).name});
        if (!known[c]) others.push_back(asked.channels[c]);
    }
    volume::RegionStatistics counted;
    if (!others.empty() || asked.channels.empty()) counted = countRegions(source, asked, others, progress);
    if (asked.channels.empty()) return {counted};
    std::vector<OfChannel> channels;
    RegionNumbers out;
    std::size_t next = 0;
    for (std::size_t c = 0; c < asked.channels.size(); ++c) {
        const volume::Channel channel = info.channel(asked.channels[c]);
        channels.push_back(known[c] ? OfChannel{&*known[c], 0} : OfChannel{&counted, next++});
        out.errors.push_back(known[c] ? 0 : numberError(origin, info, channel));
    }
    out.statistics = together(channels);
    return out;
}

std::vector<RegionRow> regionRows(const volume::DatasetInfo& info, const RegionQuery& asked,
                                  const RegionNumbers& numbers, const std::string& whole) {
    const volume::RegionStatistics& statistics = numbers.statistics;
    std::vector<RegionRow> rows;
    const std::vector<volume::Channel> channels = info.channels();
    for (std::size_t c = 0; c < asked.channels.size(); ++c) {
        const volume::Channel& channel = channels.at(static_cast<std::size_t>(asked.channels[c]));
        const double existing = statistics.all[c].samples;
        const auto add = [&](const std::string& region, int value, glm::vec3 color, bool all,
                             const volume::Summary& summary) {
            rows.push_back({channel.name, channel.unit, region, value, color, all,
                            summary.samples / statistics.allSamples, existing > 0 ? summary.samples / existing : 0,
                            summary, info.channelRange(channel), c < numbers.errors.size() ? numbers.errors[c] : 0});
        };
        for (std::size_t r = 0; r < statistics.regions.size(); ++r) {
            const volume::Parameter& label = volume::parameterOf(info, asked.label);
            const int value = statistics.regions[r];
            if (statistics.summary[r][c].samples > 0)
                add(volume::labelName(label, value), value, labelColor(label, value), false, statistics.summary[r][c]);
        }
        add(whole, 0, glm::vec3(0.5f), true, statistics.all[c]);
    }
    return rows;
}

bool showsErrors(const std::vector<RegionRow>& rows) {
    return std::ranges::any_of(rows, [](const RegionRow& row) { return row.error > 0; });
}

Table regionTable(const std::vector<RegionRow>& rows, const LengthUnit& volumes, bool errors, bool shares) {
    Table table{.columns = {}, .names = 2};
    const auto add = [&](TableColumn column, auto of) -> TableColumn& {
        return addColumn(table, rows, std::move(column), of);
    };
    const auto ofSummary = [](double volume::Summary::*member) {
        return [member](const RegionRow& row) { return row.summary.*member; };
    };
    TableColumn& parameter = add({.name = "parameter", .head = "Parameter"}, &RegionRow::parameter);
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (!rows[i].unit.empty()) parameter.words[i] = titleWithUnit(rows[i].parameter, rows[i].unit);
    add({.name = "unit", .shown = false}, &RegionRow::unit);
    add({.name = "region", .head = "Region"}, &RegionRow::region);
    // Values come first: in a narrow pane the last columns are out of sight.
    const auto addValue = [&](const char* name, const char* head, double volume::Summary::*member) {
        TableColumn& column = add({.name = name, .head = head}, ofSummary(member));
        for (const RegionRow& row : rows) column.resolutions.push_back((row.range.hi - row.range.lo) / 10000);
    };
    addValue("mean", "Mean", &volume::Summary::mean);
    addValue("deviation", "Std. deviation", &volume::Summary::deviation);
    addValue("min", "Minimum", &volume::Summary::min);
    addValue("max", "Maximum", &volume::Summary::max);
    if (errors) {
        TableColumn& error =
            add({.name = "error", .head = "Within \u00b1", .kind = NumberKind::Bound}, &RegionRow::error);
        for (std::size_t i = 0; i < rows.size(); ++i)
            if (rows[i].error == 0) error.words[i] = "as computed";
    }
    add({.name = "samples", .head = "Samples", .kind = NumberKind::Count}, ofSummary(&volume::Summary::samples));
    sayWeighted(table.columns.back());
    if (shares) {
        add({.name = "shareOfAll", .head = "Of all", .kind = NumberKind::Share}, &RegionRow::ofAll);
        add({.name = "shareOfExisting", .head = "Of its own", .kind = NumberKind::Share}, &RegionRow::ofExisting);
    }
    const bool cubes = volumes.name.empty() || volumes.name.ends_with('3');
    add({.name = "volume",
         .head = "Volume",
         .unit = volumes.name,
         .kind = cubes ? NumberKind::Volume : NumberKind::Plain},
        [&](const RegionRow& row) { return row.summary.volume * volumes.perUnit; });
    return table;
}

bool isKnown(const NumberOrigin& origin, const volume::DatasetInfo& info, const RegionBalanceQuery& asked) {
    const auto velocity = volume::velocityChannels(info, asked.velocity);
    return origin.computed && velocity && !asked.time.between() &&
           volume::knownBalance(*origin.computed, info.times[std::size_t(asked.time.earlier)],
                                labelNamed(info, asked.label), info.channel(asked.channel).name,
                                volume::parameterOf(info, (*velocity)[0]).name);
}

Balance readBalance(const std::shared_ptr<const volume::BrickSource>& source, const NumberOrigin& origin,
                    const RegionBalanceQuery& asked, const Progress& progress) {
    const volume::DatasetInfo& info = source->info();
    const auto velocity = volume::velocityChannels(info, asked.velocity);
    if (!velocity && !asked.velocity.empty()) throw Error("there is no vector \"" + asked.velocity + "\"");
    if (!velocity) throw Error("a balance needs a velocity, and no vector has the name or unit of one");
    const std::string carrier = volume::parameterOf(info, (*velocity)[0]).name;
    if (isKnown(origin, info, asked))
        return {asked, carrier,
                *volume::knownBalance(*origin.computed, info.times[std::size_t(asked.time.earlier)],
                                      labelNamed(info, asked.label), info.channel(asked.channel).name, carrier)};
    const volume::SourceAtTime shown = volume::sourceAt(source, asked.time);
    volume::BalanceQuery query;
    query.channel = asked.channel;
    query.velocity = *velocity;
    query.label = asked.label;
    query.time = shown.time;
    if (asked.label >= 0)
        query.regions = volume::labelValues(*shown.source, asked.label, shown.time, progress.part(0, 0.1));
    query.carriedError = numberError(origin, info, info.channel(asked.channel));
    bool exact = query.carriedError == 0, bounded = std::isfinite(query.carriedError);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        query.velocityError[axis] = numberError(origin, info, info.channel((*velocity)[axis]));
        exact = exact && query.velocityError[axis] == 0;
        bounded = bounded && std::isfinite(query.velocityError[axis]);
    }
    return {asked, carrier, volume::computeBalance(*shown.source, query, progress.part(0.1, 1)), exact, bounded};
}

BalanceTable balanceTable(const volume::DatasetInfo& info, const Balance& balance) {
    static constexpr const char* kFaces[] = {"x from below", "x from above", "y from below",
                                             "y from above", "z from below", "z from above"};
    const volume::Channel channel = info.channel(balance.query.channel);
    std::string speed;
    for (const volume::Parameter& parameter : info.parameters)
        if (parameter.name == balance.velocity) speed = parameter.unit;
    BalanceTable table;
    table.notes = {"carried by " + balance.velocity + " (convection only, without diffusion)",
                   "midpoint rule at the samples: faces of the box use the first or last samples, borders between "
                   "regions the mean of both sides; borders to where the parameter or " +
                       balance.velocity + " is absent the samples before them",
                   "reacts = out - in, in the row of totals; it includes reactions, diffusion through the surfaces, "
                   "and the change of what is stored over time"};
    if (speed.empty()) {
        speed = info.speedUnit();
        table.notes.push_back(balance.velocity + " has no unit: taken as " + speed);
    }
    const auto composed = [](std::vector<volume::UnitPower> factors) { return volume::composedUnit(factors); };
    const std::string length = info.lengthFactor();
    const volume::ComposedUnit unit = composed({{channel.unit, 1}, {speed, 1}, {length, 2}}),
                               flow = composed({{speed, 1}, {length, 2}}), area = composed({{info.lengthUnit, 2}}),
                               inside = composed({{channel.unit, 1}, {length, 3}});
    table.parameter = channel.name;
    table.unit = unit.unit;
    table.flowUnit = flow.unit;
    table.areaUnit = area.unit;
    table.insideUnit = inside.unit;
    const double none = std::nan("");
    const auto errorOf = [&](double error) { return balance.computed ? 0 : balance.bounded ? error : none; };
    table.errors = !balance.computed && balance.bounded;
    for (const volume::RegionBalance& region : balance.regions) {
        if (!(region.volume > 0)) continue;
        const volume::Parameter* label =
            balance.query.label >= 0 ? &volume::parameterOf(info, balance.query.label) : nullptr;
        const std::string name = label ? volume::labelName(*label, region.region) : "all";
        const auto add = [&](const std::string& surface, const volume::Crossing& crossing, bool total) {
            if (!(crossing.area > 0) && !total) return;
            table.rows.push_back({name, surface, crossing.in * unit.factor, crossing.out * unit.factor,
                                  crossing.net() * unit.factor, crossing.flow * flow.factor,
                                  crossing.area * area.factor, total,
                                  total && crossing.in > 0 ? crossing.net() / crossing.in : none,
                                  total ? region.amount * inside.factor : none, errorOf(crossing.error * unit.factor),
                                  errorOf(crossing.flowError * flow.factor),
                                  total ? errorOf(region.amountError * inside.factor) : none});
        };
        for (std::size_t face = 0; face < 6; ++face) add(kFaces[face], region.faces[face], false);
        for (const volume::BorderCrossing& border : region.borders)
            add("border to " + volume::labelName(*label, border.region), border.crossing, false);
        add("border to where it is absent", region.absent, false);
        add("border to no region", region.unlabelled, false);
        add("total: reacts", region.total(), true);
    }
    return table;
}

Table tableOf(const BalanceTable& balance) {
    Table table{.columns = {}, .names = 2, .notes = balance.notes};
    const auto add = [&](TableColumn column, auto of) { addColumn(table, balance.rows, std::move(column), of); };
    add({.name = "parameter", .head = "Parameter", .shown = false},
        [&](const BalanceRow&) { return balance.parameter; });
    add({.name = "unit", .shown = false}, [&](const BalanceRow&) { return balance.unit; });
    add({.name = "region", .head = "Region"}, &BalanceRow::region);
    add({.name = "surface", .head = "Surface"}, &BalanceRow::surface);
    add({.name = "total", .kind = NumberKind::Flag, .shown = false}, &BalanceRow::total);
    add({.name = "in", .head = "In", .unit = balance.unit}, &BalanceRow::in);
    add({.name = "out", .head = "Out", .unit = balance.unit}, &BalanceRow::out);
    add({.name = "net", .head = "Out - in", .unit = balance.unit}, &BalanceRow::net);
    add({.name = "relative", .head = "Of in", .kind = NumberKind::Change}, &BalanceRow::relative);
    add({.name = "flow", .head = "Volume flow", .unit = balance.flowUnit}, &BalanceRow::flow);
    add({.name = "area", .head = "Area", .unit = balance.areaUnit}, &BalanceRow::area);
    add({.name = "inside", .head = "Inside", .unit = balance.insideUnit}, &BalanceRow::inside);
    if (!balance.errors) return table;
    const auto addError = [&](const char* name, const char* head, const std::string& unit, double BalanceRow::*of) {
        add({.name = name, .head = head, .unit = unit, .kind = NumberKind::Bound}, of);
    };
    addError("error", "Within \u00b1", balance.unit, &BalanceRow::error);
    addError("flowError", "Flow \u00b1", balance.flowUnit, &BalanceRow::flowError);
    addError("insideError", "Inside \u00b1", balance.insideUnit, &BalanceRow::insideError);
    return table;
}

} // namespace tessera::app
