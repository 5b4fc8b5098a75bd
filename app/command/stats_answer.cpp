#include "app/command/stats_answer.h"

#include "app/data/format.h"
#include "app/pane/view_parts.h"
#include "app/session/label_colors.h"
#include "app/ui/ticks.h"
#include "app/views/curves/section_data.h"
#include "app/views/statistics/region_data.h"
#include "codec/container/json_text.h"
#include "volume/base/unit_product.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>

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
    std::vector<RegionRow> rows =
        regionRows(question.info(), query, readRegions(question.source, question.from, query, progress));
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

Answer sectionsAt(const StatsRequest& request, const Question& question, double time, bool first,
                  const Progress& progress) {
    Answer answer;
    const volume::DatasetInfo& info = question.info();
    const SectionMeasure show = request.options.show;
    const SectionCurves curves =
        readSections(question.source, sectionCurvesQuery(request, question, time), progress, question.from);
    answer.csv = sectionCsv(info, curves, first);
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
            if (!curves.errors.empty()) heads.emplace_back("\u00b1");
            Json entry{{"time", time}, {"parameter", name}, {"region", looks[r].name}, {"place", places}};
            for (std::size_t m = 0; m < std::size(kSectionMeasureNames); ++m) {
                const volume::ComposedUnit own =
                    measureUnit(info, curves.query.channels[c], curves.velocity, SectionMeasure(m));
                Json list = Json::array();
                for (const auto& value : values)
                    list.push_back(numberOrNull(measured(value, SectionMeasure(m), own.factor)));
                Json& of = entry[std::string(kSectionMeasureNames[m])];
                of = {{"unit", own.unit}, {"values", std::move(list)}};
                if (curves.errors.empty()) continue;
                of["errors"] = Json::array();
                for (const auto& value : values)
                    of["errors"].push_back(numberOrNull(errorOf(curves, c, value, SectionMeasure(m), own.factor)));
            }
            answer.json.push_back(std::move(entry));
            for (std::size_t p = 0; p < places.size(); ++p) {
                const double value = values[p].area > 0 ? measured(values[p], show, unit.factor) : std::nan("");
                rows[p].push_back(std::isfinite(value) ? numberText(value) : "-");
                if (curves.errors.empty()) continue;
                const double error = errorOf(curves, c, values[p], show, unit.factor);
                rows[p].push_back(std::isfinite(value) && std::isfinite(error) ? numberText(error) : "-");
            }
        }
    answer.text = alignedTable(heads, rows, 0);
    return answer;
}

Answer balanceAt(const StatsRequest& request, const Question& question, double time, bool first,
                 const Progress& progress) {
    Answer answer;
    const RegionBalanceQuery query{question.balance, request.options.velocity, question.label, question.at(time)};
    BalanceTable table = balanceTable(question.info(), readBalance(question.source, question.from, query, progress));
    table.errors = question.errors;
    answer.csv = balanceCsv(table, question.timeTitle(), question.several() ? csvNumber(time) : "", first);
    answer.notes = table.notes;
    std::vector<std::vector<std::string>> rows;
    for (const BalanceRow& row : table.rows) {
        rows.push_back(balanceCells(table, row));
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
        if (table.errors)
            answer.json.back().update({{"error", numberOrNull(row.error)},
                                       {"flowError", numberOrNull(row.flowError)},
                                       {"insideError", numberOrNull(row.insideError)}});
    }
    answer.text = table.parameter + "\n" + alignedTable(balanceHeads(table), rows, 2);
    return answer;
}

Answer regionsAt(const Question& question, double time, bool first, const Progress& progress) {
    Answer answer;
    const std::vector<RegionRow> rows = regionRowsAt(question, time, progress);
    const std::string& unit = question.info().lengthUnit;
    answer.csv =
        regionCsv(rows, unit, question.timeTitle(), question.several() ? csvNumber(time) : "", first, question.errors);
    std::vector<std::vector<std::string>> cells;
    for (const RegionRow& row : rows) {
        cells.push_back(regionCells(row, unit, question.errors));
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
        if (question.errors) answer.json.back()["error"] = numberOrNull(row.error);
    }
    answer.text = alignedTable(regionHeads(question.errors), cells, 2);
    return answer;
}

/// Colour of a region as views draw it.
glm::vec3 colorOf(const Question& question, const std::string& region) {
    if (question.label < 0) return glm::vec3(0.5f);
    const volume::Parameter& label = volume::parameterOf(question.info(), question.label);
    const std::optional<int> value = volume::labelValue(label, region);
    return value ? labelColor(label, *value) : glm::vec3(0.5f);
}

double numberOf(const Json& number) {
    return number.is_null() ? std::nan("") : number.get<double>();
}

/// The panel of that key; a new one begins with these axes.
FigurePanel& panelOf(std::vector<std::pair<std::string, FigurePanel>>& panels, const std::string& key,
                     const FigurePanel& begin) {
    const auto at = std::ranges::find(panels, key, &std::pair<std::string, FigurePanel>::first);
    return at != panels.end() ? at->second : panels.emplace_back(key, begin).second;
}

FigureSeries& lineOf(FigurePanel& panel, const std::string& name, const FigureSeries& begin) {
    const auto at = std::ranges::find(panel.series, name, &FigureSeries::name);
    return at != panel.series.end() ? *at : panel.series.emplace_back(begin);
}

void addPoint(FigurePanel& panel, FigureSeries& line, double x, double y) {
    line.points.push_back({x, y});
    if (std::isfinite(y)) panel.y.range = {std::min(panel.y.range.lo, y), std::max(panel.y.range.hi, y)};
}

} // namespace

Answer answerAt(const StatsRequest& request, const Question& question, double time, bool first,
                const Progress& progress) {
    Answer answer = request.options.planesAcross() ? sectionsAt(request, question, time, first, progress)
                    : question.balance >= 0        ? balanceAt(request, question, time, first, progress)
                                                   : regionsAt(question, time, first, progress);
    if (question.several()) answer.text = "t = " + formatQuantity(time, question.info().timeUnit) + "\n" + answer.text;
    return answer;
}

std::string textOf(const Answer& answer) {
    const Json json{{"text", answer.text}, {"csv", answer.csv}, {"rows", answer.json}, {"notes", answer.notes}};
    return jsonText(json);
}

void addAnswer(Answer& sum, const std::string& later) {
    Json answer = Json::parse(later);
    sum.text += answer["text"].get<std::string>();
    sum.csv += answer["csv"].get<std::string>();
    for (Json& row : answer["rows"]) sum.json.push_back(std::move(row));
    sum.notes = answer["notes"].get<std::vector<std::string>>();
}

std::vector<FigurePanel> figureOf(const Question& question, const Json& rows) {
    const std::vector<double>& times = question.times;
    const bool balance = question.balance >= 0, bars = balance && times.size() == 1;
    const FigureAxis overTime{question.timeTitle(), {times.front(), times.back()}};
    std::vector<std::pair<std::string, FigurePanel>> panels;
    for (const Json& row : rows) {
        const std::string parameter = row["parameter"], unit = row["unit"], region = row["region"];
        const double time = row["time"];
        if (balance) {
            const std::string surface = row["surface"];
            FigurePanel& panel = panelOf(
                panels, region, {region, overTime, {titleWithUnit("out - in of " + parameter, unit), {0, 0}}, {}, {}});
            FigureSeries& line = lineOf(panel, surface, {surface, {}, labelColor({}, int(panel.series.size()) + 1)});
            line.bars = bars;
            addPoint(panel, line, bars ? double(&line - panel.series.data()) + 1 : time, numberOf(row["net"]));
        } else {
            FigurePanel& panel =
                panelOf(panels, parameter,
                        {{}, overTime, {titleWithUnit("mean of " + parameter, unit), {HUGE_VAL, -HUGE_VAL}}, {}, {}});
            addPoint(panel, lineOf(panel, region, {region, {}, colorOf(question, region)}), time,
                     numberOf(row["mean"]));
        }
    }
    std::vector<FigurePanel> out;
    for (auto& [key, panel] : panels) {
        if (bars) panel.x = {"surface", {0.5, double(panel.series.size()) + 0.5}, false};
        panel.y.range = paddedRange(panel.y.range, 0.05);
        out.push_back(std::move(panel));
    }
    return out;
}

} // namespace tessera::app
