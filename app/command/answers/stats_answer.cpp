#include "app/command/answers/stats_answer.h"

#include "app/pane/view_parts.h"
#include "app/session/label_colors.h"
#include "app/ui/ticks.h"
#include "app/values/place_text.h"
#include "app/values/table_json.h"
#include "app/views/curves/section_data.h"
#include "app/views/statistics/region_data.h"
#include "codec/container/json_text.h"
#include "volume/base/error.h"
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

/// What a legend calls one of several requested times.
const std::string& stateName(const Question& question, double time) {
    return question.states.at(std::size_t(std::ranges::lower_bound(question.times, time) - question.times.begin()));
}

/// Behind the time, where several are requested.
void addState(Table& table, const Question& question, double time) {
    if (question.times.size() < 2) return;
    const std::vector<std::string> texts(rowsOf(table), stateName(question, time));
    table.columns.insert(table.columns.begin() + 1, {.name = "state", .shown = false, .texts = texts});
}

void addState(Json& row, const Question& question, double time) {
    if (question.times.size() > 1) row["state"] = stateName(question, time);
}

Answer sectionsAt(const StatsRequest& request, const Question& question, double time, bool first,
                  const Progress& progress) {
    Answer answer;
    const volume::DatasetInfo& info = question.info();
    const SectionMeasure show = request.options.show;
    const SectionCurves curves =
        readSections(question.source, sectionCurvesQuery(request, question, time), progress, question.from);
    Table table = sectionTable(info, {curves});
    addState(table, question, time);
    answer.csv = csvOf(table, first);
    answer.notes = sectionNotes(info, curves);
    if (curves.velocity.empty() && (show == SectionMeasure::Flux || show == SectionMeasure::Flow))
        throw Error("a flux needs a velocity, and no vector has the name or unit of one");
    const std::vector<CurveLook> looks = curveLooks(info, curves.query);
    const std::vector<volume::Channel> channels = info.channels();
    const auto& places = curves.sections.place;
    const LengthUnit length =
        placeUnit(info, curves.query, places.empty() ? 0 : std::abs(places.back() - places.front()));
    Table shown;
    addColumn(shown, places, {.name = placeTitle(info, curves.query), .unit = length.name},
              [&](double place) { return place * length.perUnit; });
    for (std::size_t c = 0; c < curves.query.channels.size(); ++c)
        for (std::size_t r = 0; r < looks.size(); ++r) {
            const auto& values = curves.sections.values[r][c];
            if (std::ranges::none_of(values, [](const auto& value) { return value.area > 0; })) continue;
            const volume::ComposedUnit unit = measureUnit(info, curves.query.channels[c], curves.velocity, show);
            const std::string& name = channels[static_cast<std::size_t>(curves.query.channels[c])].name;
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
            addState(entry, question, time);
            answer.json.push_back(std::move(entry));
            const auto valueOf = [&](const auto& plane) {
                return plane.area > 0 ? measured(plane, show, unit.factor) : std::nan("");
            };
            addColumn(shown, values, {.name = name + (looks.size() > 1 ? " " + looks[r].name : ""), .unit = unit.unit},
                      valueOf);
            if (curves.errors.empty()) continue;
            addColumn(shown, values, {.name = "error of " + name, .head = "\u00b1", .kind = NumberKind::Bound},
                      [&](const auto& plane) {
                          const double error = errorOf(curves, c, plane, show, unit.factor);
                          return std::isfinite(valueOf(plane)) && std::isfinite(error) ? error : std::nan("");
                      });
        }
    answer.text = textOf(shown);
    return answer;
}

/// A table as text, CSV and JSON; the last two state the time.
Answer answerOf(Table table, const Question& question, double time, bool first) {
    Answer answer;
    answer.text = textOf(table);
    answer.notes = table.notes;
    answer.json = jsonOf(table);
    answer.units = unitsOf(table);
    for (Json& row : answer.json) {
        row["time"] = time;
        addState(row, question, time);
    }
    if (question.several()) addTime(table, question.info().timeName, question.info().timeUnit, time);
    addState(table, question, time);
    answer.csv = csvOf(table, first);
    return answer;
}

Answer balanceAt(const StatsRequest& request, const Question& question, double time, bool first,
                 const Progress& progress) {
    const RegionBalanceQuery query{question.balance, request.options.velocity, question.label, question.at(time)};
    BalanceTable balance = balanceTable(question.info(), readBalance(question.source, question.from, query, progress));
    balance.errors = question.errors;
    Answer answer = answerOf(tableOf(balance), question, time, first);
    answer.text.insert(0, balance.parameter + "\n");
    return answer;
}

Answer regionsAt(const Question& question, double time, bool first, const Progress& progress) {
    const std::vector<RegionRow> rows = regionRowsAt(question, time, progress);
    return answerOf(regionTable(rows, volumeUnit(question.info()), question.errors), question, time, first);
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
Plot& panelOf(std::vector<std::pair<std::string, Plot>>& panels, const std::string& key, const Plot& begin) {
    const auto at = std::ranges::find(panels, key, &std::pair<std::string, Plot>::first);
    return at != panels.end() ? at->second : panels.emplace_back(key, begin).second;
}

PlotSeries& lineOf(Plot& panel, const std::string& name, const PlotSeries& begin) {
    const auto at = std::ranges::find(panel.series, name, &PlotSeries::name);
    return at != panel.series.end() ? *at : panel.series.emplace_back(begin);
}

void addPoint(Plot& panel, PlotSeries& line, double x, double y) {
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
    const Json json{{"text", answer.text},
                    {"csv", answer.csv},
                    {"rows", answer.json},
                    {"units", answer.units},
                    {"notes", answer.notes}};
    return jsonText(json);
}

void addAnswer(Answer& sum, const std::string& later) {
    Json answer = Json::parse(later);
    sum.text += answer["text"].get<std::string>();
    sum.csv += answer["csv"].get<std::string>();
    for (Json& row : answer["rows"]) sum.json.push_back(std::move(row));
    sum.units = std::move(answer["units"]);
    sum.notes = answer["notes"].get<std::vector<std::string>>();
}

std::vector<Plot> sectionFigure(const StatsRequest& request, const Question& question, const Progress& progress) {
    std::vector<SectionCurves> states;
    const auto count = static_cast<double>(question.times.size());
    for (const double time : question.times) {
        const auto done = static_cast<double>(states.size());
        states.push_back(readSections(question.source, sectionCurvesQuery(request, question, time),
                                      progress.part(done / count, (done + 1) / count), question.from));
    }
    return sectionPanels(question.info(), states, request.options.show);
}

std::vector<Plot> figureOf(const Question& question, const Json& rows) {
    const std::vector<double>& times = question.times;
    const bool balance = question.balance >= 0, one = times.size() == 1;
    const PlotAxis overTime{question.timeTitle(), {times.front(), times.back()}};
    std::vector<std::pair<std::string, Plot>> panels;
    for (const Json& row : rows) {
        const std::string parameter = row["parameter"], unit = row["unit"], region = row["region"];
        const std::string key = balance ? region : parameter, name = balance ? std::string(row["surface"]) : region;
        const PlotAxis up{.title = (balance ? "out - in of " : "mean of ") + parameter,
                          .range = balance ? Range{0, 0} : Range{HUGE_VAL, -HUGE_VAL},
                          .unit = unit};
        Plot& panel = panelOf(panels, key, {balance ? region : std::string(), overTime, up, {}, {}});
        const glm::vec3 color = balance ? labelColor({}, int(panel.series.size()) + 1) : colorOf(question, region);
        PlotSeries& line = lineOf(panel, name, {name, {}, color});
        line.bars = one && balance;
        line.dots = one;
        addPoint(panel, line, one ? double(&line - panel.series.data()) + 1 : double(row["time"]),
                 numberOf(row[balance ? "net" : "mean"]));
    }
    std::vector<Plot> out;
    for (auto& [key, panel] : panels) {
        if (one) panel.x = {balance ? "surface" : "region", {0.5, double(panel.series.size()) + 0.5}, false};
        panel.y.range = paddedRange(panel.y.range, 0.05);
        out.push_back(std::move(panel));
    }
    return out;
}

} // namespace tessera::app
