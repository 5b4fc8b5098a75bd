#include "app/command/stats_answer.h"

#include "app/data/format.h"
#include "app/pane/view_parts.h"
#include "app/session/label_colors.h"
#include "app/ui/ticks.h"
#include "app/views/curves/section_data.h"
#include "app/views/statistics/region_data.h"
#include "volume/base/unit_product.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tessera::app {

namespace {

SectionCurvesQuery sectionCurvesQuery(const StatsRequest& request, const Question& question, double time) {
    SectionCurvesQuery query;
    query.channels = question.channels;
    if (!request.options.along.empty()) query.axis = volume::SpaceAxis(request.options.along[0] - 'x');
    query.line = question.line;
    query.planes = request.options.planes;
    query.weight = request.options.weight;
    query.velocity = request.options.velocity;
    query.label = question.label;
    query.time = question.at(time);
    query.regions = question.regions;
    return query;
}

std::vector<RegionRow> regionRowsAt(const Question& question, double time, const Progress& progress) {
    const RegionQuery query{question.channels, question.label, question.at(time)};
    std::vector<RegionRow> rows = regionRows(question.info(), query, readRegions(question.source, query, progress));
    std::erase_if(rows, [&](const RegionRow& row) {
        return !question.regions.empty() && std::ranges::none_of(question.regions, [&](int value) {
            return row.region == volume::labelName(volume::parameterOf(question.info(), question.label), value);
        });
    });
    return rows;
}

Json numberOrNull(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

void addSections(Answer& answer, const StatsRequest& request, const Question& question, double time,
                 const Progress& progress) {
    const volume::DatasetInfo& info = question.info();
    const SectionMeasure show = request.options.show;
    const SectionCurves curves = readSections(question.source, sectionCurvesQuery(request, question, time), progress);
    answer.csv += sectionCsv(info, curves, answer.csv.empty());
    answer.notes = sectionNotes(info, curves);
    answer.panels = sectionPanels(info, curves, show);
    const std::vector<CurveLook> looks = curveLooks(info, curves.query);
    const std::vector<volume::Channel> channels = info.channels();
    const auto& places = curves.sections.place;
    const LengthUnit length =
        suitableLength(info.lengthUnit, places.empty() ? 0 : std::abs(places.back() - places.front()));
    std::vector<std::string> heads{titleWithUnit(placeTitle(curves.query), length.name)};
    std::vector<std::vector<std::string>> rows(places.size());
    for (std::size_t p = 0; p < places.size(); ++p) rows[p] = {numberText(places[p] * length.perUnit)};
    for (std::size_t c = 0; c < curves.query.channels.size(); ++c)
        for (std::size_t r = 0; r < looks.size(); ++r) {
            const auto& values = curves.sections.values[r][c];
            if (std::ranges::none_of(values, [](const auto& value) { return value.area > 0; })) continue;
            const volume::ComposedUnit unit = measureUnit(info, curves.query.channels[c], curves.velocity, show);
            const std::string& name = channels[static_cast<std::size_t>(curves.query.channels[c])].name;
            heads.push_back(titleWithUnit(name + (looks.size() > 1 ? " " + looks[r].name : ""), unit.unit));
            Json entry{{"time", time}, {"parameter", name}, {"region", looks[r].name}, {"place", places}};
            for (std::size_t m = 0; m < std::size(kSectionMeasureNames); ++m) {
                const volume::ComposedUnit own =
                    measureUnit(info, curves.query.channels[c], curves.velocity, SectionMeasure(m));
                Json list = Json::array();
                for (const auto& value : values)
                    list.push_back(numberOrNull(measured(value, SectionMeasure(m), own.factor)));
                entry[std::string(kSectionMeasureNames[m])] = {{"unit", own.unit}, {"values", std::move(list)}};
            }
            answer.json.push_back(std::move(entry));
            for (std::size_t p = 0; p < places.size(); ++p) {
                const double value = values[p].area > 0 ? measured(values[p], show, unit.factor) : std::nan("");
                rows[p].push_back(std::isfinite(value) ? numberText(value) : "-");
            }
        }
    answer.text += alignedTable(heads, rows, 0);
}

BalanceTable balanceAt(const StatsRequest& request, const Question& question, double time, const Progress& progress) {
    const RegionBalanceQuery query{question.balance, request.options.velocity, question.label, question.at(time)};
    return balanceTable(question.info(), readBalance(question.source, query, progress));
}

void addBalance(Answer& answer, const StatsRequest& request, const Question& question, double time,
                const Progress& progress) {
    const BalanceTable table = balanceAt(request, question, time, progress);
    answer.csv +=
        balanceCsv(table, question.timeTitle(), question.several() ? csvNumber(time) : "", answer.csv.empty());
    answer.notes = table.notes;
    std::vector<std::vector<std::string>> rows;
    for (const BalanceRow& row : table.rows) {
        rows.push_back(balanceCells(row));
        answer.json.push_back({{"time", time},
                               {"parameter", table.parameter},
                               {"unit", table.unit},
                               {"region", row.region},
                               {"surface", row.surface},
                               {"total", row.total},
                               {"in", row.in},
                               {"out", row.out},
                               {"net", row.net},
                               {"relative", numberOrNull(row.relative)},
                               {"flow", row.flow},
                               {"area", row.area},
                               {"inside", numberOrNull(row.inside)}});
    }
    answer.text += table.parameter + "\n" + alignedTable(balanceHeads(table), rows, 2);
}

void addRegions(Answer& answer, const Question& question, double time, const Progress& progress) {
    const std::vector<RegionRow> rows = regionRowsAt(question, time, progress);
    const std::string& unit = question.info().lengthUnit;
    answer.csv +=
        regionCsv(rows, unit, question.timeTitle(), question.several() ? csvNumber(time) : "", answer.csv.empty());
    std::vector<std::vector<std::string>> cells;
    for (const RegionRow& row : rows) {
        cells.push_back(regionCells(row, unit));
        answer.json.push_back({{"time", time},
                               {"parameter", row.parameter},
                               {"unit", row.unit},
                               {"region", row.region},
                               {"samples", row.summary.samples},
                               {"shareOfAll", row.ofAll},
                               {"shareOfExisting", row.ofExisting},
                               {"volume", row.summary.volume},
                               {"mean", numberOrNull(row.summary.mean)},
                               {"deviation", numberOrNull(row.summary.deviation)},
                               {"min", numberOrNull(row.summary.min)},
                               {"max", numberOrNull(row.summary.max)}});
    }
    answer.text += alignedTable(regionHeads(), cells, 2);
}

/// Means over time, a panel for each parameter and a line for each region.
std::vector<FigurePanel> meansOverTime(const Question& question, const Progress& progress) {
    const volume::DatasetInfo& info = question.info();
    std::map<std::string, FigurePanel> panels;
    std::vector<std::string> order;
    for (std::size_t t = 0; t < info.times.size(); ++t)
        for (const RegionRow& row : regionRowsAt(
                 question, info.times[t],
                 progress.part(double(t) / double(info.times.size()), double(t + 1) / double(info.times.size())))) {
            FigurePanel& panel = panels[row.parameter];
            if (panel.y.title.empty()) {
                order.push_back(row.parameter);
                panel.x = {question.timeTitle(), {info.times.front(), info.times.back()}};
                panel.y = {titleWithUnit("mean of " + row.parameter, row.unit), {HUGE_VAL, -HUGE_VAL}};
            }
            auto line = std::ranges::find_if(panel.series, [&](const auto& s) { return s.name == row.region; });
            if (line == panel.series.end())
                line = panel.series.insert(panel.series.end(), FigureSeries{row.region, {}, row.color});
            line->points.push_back({info.times[t], row.summary.mean});
            if (!std::isfinite(row.summary.mean)) continue;
            panel.y.range = {std::min(panel.y.range.lo, row.summary.mean),
                             std::max(panel.y.range.hi, row.summary.mean)};
        }
    std::vector<FigurePanel> out;
    for (const std::string& name : order) {
        panels[name].y.range = paddedRange(panels[name].y.range, 0.05);
        out.push_back(panels[name]);
    }
    return out;
}

/// Outflow minus inflow through every surface of each region.
std::vector<FigurePanel> balancePanels(const StatsRequest& request, const Question& question,
                                       const Progress& progress) {
    const std::vector<double>& times = question.times;
    std::vector<FigurePanel> panels;
    for (std::size_t t = 0; t < times.size(); ++t) {
        const Progress part = progress.part(double(t) / double(times.size()), double(t + 1) / double(times.size()));
        const BalanceTable table = balanceAt(request, question, times[t], part);
        for (const BalanceRow& row : table.rows) {
            auto panel = std::ranges::find(panels, row.region, &FigurePanel::title);
            if (panel == panels.end())
                panel = panels.insert(panels.end(),
                                      FigurePanel{row.region,
                                                  {question.timeTitle(), {times.front(), times.back()}},
                                                  {titleWithUnit("out - in of " + table.parameter, table.unit), {0, 0}},
                                                  {},
                                                  {}});
            auto line = std::ranges::find(panel->series, row.surface, &FigureSeries::name);
            if (line == panel->series.end())
                line = panel->series.insert(
                    panel->series.end(), FigureSeries{row.surface, {}, labelColor({}, int(panel->series.size()) + 1)});
            const bool bars = times.size() == 1;
            line->bars = bars;
            line->points.push_back({bars ? double(line - panel->series.begin()) + 1 : times[t], row.net});
            panel->y.range = {std::min(panel->y.range.lo, row.net), std::max(panel->y.range.hi, row.net)};
        }
    }
    for (FigurePanel& panel : panels) {
        if (times.size() == 1) panel.x = {"surface", {0.5, double(panel.series.size()) + 0.5}};
        panel.y.range = paddedRange(panel.y.range, 0.05);
    }
    return panels;
}

} // namespace

void addAnswer(Answer& answer, const StatsRequest& request, const Question& question, double time,
               const Progress& progress) {
    if (request.options.planesAcross())
        addSections(answer, request, question, time, progress);
    else if (question.balance >= 0)
        addBalance(answer, request, question, time, progress);
    else
        addRegions(answer, question, time, progress);
}

std::vector<FigurePanel> figureOf(const StatsRequest& request, const Question& question, const Progress& progress) {
    return question.balance >= 0 ? balancePanels(request, question, progress) : meansOverTime(question, progress);
}

} // namespace tessera::app
