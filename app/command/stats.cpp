#include "app/command/command.h"
#include "app/command/derive_option.h"
#include "app/command/format.h"
#include "app/command/import_options.h"
#include "app/open.h"
#include "app/session/describe_cli.h"
#include "app/session/import_memory.h"
#include "app/sources.h"
#include "app/views/region_data.h"
#include "app/views/section_data.h"
#include "app/views/ticks.h"
#include "app/views/view_parts.h"
#include "volume/analysis/flow_channels.h"
#include "volume/atomic_file.h"
#include "volume/error.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace tessera::app {

namespace {

struct StatsOptions {
    std::optional<double> time;
    bool allTimes = false;
    std::string by, of, along, line, balance, velocity, regions;
    volume::SectionWeight weight = volume::SectionWeight::Area;
    SectionMeasure show = SectionMeasure::Mean;
    int planes = 100;
    bool json = false;
    static void describe(auto& self, auto&& visit) {
        visit(self.time, FieldInfo{.key = "time", .unit = "", .doc = "Time, in the unit of the data (last)"});
        visit(self.allTimes, FieldInfo{.key = "allTimes", .unit = "", .doc = "Every time instead of one"});
        visit(self.by, FieldInfo{.key = "by",
                                 .unit = "",
                                 .doc = "Label whose values are the regions, or none (first label of the data)"});
        visit(self.regions,
              FieldInfo{.key = "regions", .unit = "", .doc = "Only these regions, by name or value: cathode,3"});
        visit(self.of, FieldInfo{.key = "of", .unit = "", .doc = "Only these parameters: O2,H2O (all)"});
        visit(self.along,
              FieldInfo{.key = "along", .unit = "", .doc = "Averages over planes across an axis: x, y or z"});
        visit(
            self.line,
            FieldInfo{.key = "line",
                      .unit = "",
                      .doc = "Averages over planes across a line: x,y,z,x,y,z of its ends, in the data's length unit"});
        visit(self.planes,
              FieldInfo{.key = "planes", .unit = "", .doc = "Planes across the line", .range = Range{1, 100000}});
        visit(self.weight, FieldInfo{.key = "weight",
                                     .unit = "",
                                     .doc = "What the mean over a plane is weighted by",
                                     .names = volume::kSectionWeightNames});
        visit(self.show, FieldInfo{.key = "show",
                                   .unit = "",
                                   .doc = "What of the planes is printed and drawn (CSV has all of it)",
                                   .names = kSectionMeasureNames});
        visit(
            self.balance,
            FieldInfo{.key = "balance", .unit = "", .doc = "What of this parameter flows in and out of every region"});
        visit(self.velocity,
              FieldInfo{.key = "velocity", .unit = "", .doc = "Vector that carries (found by its name and unit)"});
        visit(self.json, FieldInfo{.key = "json", .unit = "", .doc = "Print JSON with stable keys"});
    }
};

struct StatsRequest {
    std::vector<std::string> inputs;
    std::string output;
    StatsOptions options;
    std::vector<volume::DerivedParameter> derived;
    volume::ImportOptions import;
};

std::vector<std::string> splitList(const std::string& text) {
    std::vector<std::string> parts;
    std::string part;
    for (const char c : text + ",")
        if (c != ',')
            part += c;
        else if (!part.empty())
            parts.push_back(std::exchange(part, {}));
    return parts;
}

Sources openInput(const StatsRequest& request, const Progress& progress) {
    DataRef data;
    const std::vector<std::string> models = volume::modelNames();
    if (request.inputs.size() == 1 && std::ranges::find(models, request.inputs[0]) != models.end() &&
        !std::filesystem::exists(request.inputs[0]))
        data.model = request.inputs[0];
    else
        data = dataOf(request.inputs, recallOptions(request.inputs, request.import, progress.part(0, 0.2)));
    data.lattice = PictureLattice::Grid; // no picture is made
    data.derived = request.derived;
    std::vector<std::string> messages;
    Sources sources = openSources(data, messages, progress.part(0.2, 1));
    checkDerived(request.derived, volume::underived(sources.numbers)->info());
    for (const std::string& message : messages) std::fprintf(stderr, "tessera: %s\n", message.c_str());
    return sources;
}

/// Everything about the request that the data decide.
struct Question {
    std::shared_ptr<const volume::BrickSource> source;
    NumberOrigin origin;
    std::vector<int> channels;
    int label = -1, balance = -1;
    std::vector<int> regions; ///< stated ones; empty: all
    std::vector<glm::dvec3> line;
    std::vector<double> times;
    const volume::DatasetInfo& info() const { return source->info(); }
    volume::TimePair at(double time) const { return volume::timesAround(info().times, time); }
    bool several() const { return info().times.size() > 1; }
    std::string timeTitle() const {
        return info().timeName + (info().timeUnit.empty() ? "" : " [" + info().timeUnit + "]");
    }
};

int channelNamed(const Question& question, const std::string& name) {
    if (const auto channel = question.info().findChannel(name)) return *channel;
    std::string known;
    for (const volume::Channel& channel : question.info().channels())
        known += (known.empty() ? "" : ", ") + channel.name;
    throw Error("there is no parameter \"" + name + "\"; there are " + known, question.info().name);
}

Question questionOf(const StatsRequest& request, const Sources& sources) {
    const StatsOptions& options = request.options;
    Question out{sources.numbers, sources.origin, {}, -1, -1, {}, {}, {}};
    const volume::DatasetInfo& info = out.info();
    for (const std::string& name : splitList(options.of)) out.channels.push_back(channelNamed(out, name));
    if (out.channels.empty()) out.channels = comparedChannels(info);
    if (options.by != "none") {
        const auto label = volume::labelChannel(info, options.by);
        if (!label && !options.by.empty())
            throw Error("there is no label \"" + options.by + "\" that says which region a sample is in", info.name);
        out.label = label.value_or(-1);
    }
    if (!options.balance.empty()) out.balance = channelNamed(out, options.balance);
    for (const std::string& name : splitList(options.regions)) {
        const auto value =
            out.label < 0 ? std::nullopt : volume::labelValue(volume::parameterOf(info, out.label), name);
        if (!value) throw Error("there is no region \"" + name + "\"", info.name);
        out.regions.push_back(*value);
    }
    if (!options.line.empty()) {
        const std::vector<std::string> parts = splitList(options.line);
        glm::dvec3 ends[2];
        bool numbers = parts.size() == 6;
        for (std::size_t i = 0; numbers && i < 6; ++i) {
            char* end = nullptr;
            ends[i / 3][static_cast<int>(i % 3)] = std::strtod(parts[i].c_str(), &end);
            numbers = *end == '\0';
        }
        if (!numbers) throw Error("wants x,y,z,x,y,z, not \"" + options.line + "\"", "--line");
        out.line = {ends[0], ends[1]};
    }
    if (!options.along.empty() && options.along != "x" && options.along != "y" && options.along != "z")
        throw Error("wants x, y or z, not \"" + options.along + "\"", "--along");
    out.times = options.allTimes ? info.times : std::vector<double>{options.time.value_or(info.times.back())};
    return out;
}

SectionWish sectionWish(const StatsRequest& request, const Question& question, double time) {
    SectionWish wish;
    wish.channels = question.channels;
    if (!request.options.along.empty()) wish.axis = volume::SpaceAxis(request.options.along[0] - 'x');
    wish.line = question.line;
    wish.planes = request.options.planes;
    wish.weight = request.options.weight;
    wish.velocity = request.options.velocity;
    wish.label = question.label;
    wish.time = question.at(time);
    wish.regions = question.regions;
    return wish;
}

std::vector<RegionRow> regionRowsAt(const Question& question, double time, const Progress& progress) {
    const RegionWish wish{question.channels, question.label, question.at(time)};
    std::vector<RegionRow> rows = regionRows(question.info(), wish, readRegions(question.source, wish, progress));
    std::erase_if(rows, [&](const RegionRow& row) {
        return !question.regions.empty() && std::ranges::none_of(question.regions, [&](int value) {
            return row.region == volume::labelName(volume::parameterOf(question.info(), question.label), value);
        });
    });
    return rows;
}

/// The numbers at one time as rows of a text, of CSV, and of JSON.
struct Answer {
    std::string text, csv;
    Json json = Json::array();
    std::vector<std::string> notes;
    std::vector<FigurePanel> panels;
};

Json numberOrNull(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

void addSections(Answer& answer, const StatsRequest& request, const Question& question, double time,
                 const Progress& progress) {
    const volume::DatasetInfo& info = question.info();
    const SectionMeasure show = request.options.show;
    const SectionCurves curves = readSections(question.source, sectionWish(request, question, time), progress);
    answer.csv += sectionCsv(info, curves, answer.csv.empty());
    answer.notes = sectionNotes(info, curves);
    answer.panels = sectionPanels(info, curves, show);
    const std::vector<CurveLook> looks = curveLooks(info, curves.wish);
    const std::vector<volume::Channel> channels = info.channels();
    const auto& places = curves.sections.place;
    const LengthUnit length =
        suitableLength(info.lengthUnit, places.empty() ? 0 : std::abs(places.back() - places.front()));
    std::vector<std::string> heads{titleWithUnit(placeTitle(curves.wish), length.name)};
    std::vector<std::vector<std::string>> rows(places.size());
    for (std::size_t p = 0; p < places.size(); ++p) rows[p] = {numberText(places[p] * length.perUnit)};
    for (std::size_t c = 0; c < curves.wish.channels.size(); ++c)
        for (std::size_t r = 0; r < looks.size(); ++r) {
            const auto& values = curves.sections.values[r][c];
            if (std::ranges::none_of(values, [](const auto& value) { return value.area > 0; })) continue;
            const volume::ComposedUnit unit = measureUnit(info, curves.wish.channels[c], curves.velocity, show);
            const std::string& name = channels[static_cast<std::size_t>(curves.wish.channels[c])].name;
            heads.push_back(titleWithUnit(name + (looks.size() > 1 ? " " + looks[r].name : ""), unit.unit));
            Json entry{{"time", time}, {"parameter", name}, {"region", looks[r].name}, {"place", places}};
            for (std::size_t m = 0; m < std::size(kSectionMeasureNames); ++m) {
                const volume::ComposedUnit own =
                    measureUnit(info, curves.wish.channels[c], curves.velocity, SectionMeasure(m));
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

void addBalance(Answer& answer, const StatsRequest& request, const Question& question, double time,
                const Progress& progress) {
    const BalanceWish wish{question.balance, request.options.velocity, question.label, question.at(time)};
    const BalanceTable table = balanceTable(question.info(), readBalance(question.source, wish, progress));
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
std::vector<FigurePanel> overTimePanels(const Question& question, const Progress& progress) {
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

std::string stateOf(const Question& question) {
    const glm::ivec3 size = question.source->grid().lattice.size;
    return question.info().name + ", " + std::to_string(size.x) + " x " + std::to_string(size.y) + " x " +
           std::to_string(size.z) + " samples, numbers " +
           originText(question.origin, question.info(), question.channels);
}

void run(const StatsRequest& request) {
    const StatsOptions& options = request.options;
    const bool sections = !options.along.empty() || !options.line.empty(), svg = hasEnding(request.output, ".svg");
    if (!request.output.empty() && !svg && !hasEnding(request.output, ".csv") && !hasEnding(request.output, ".json"))
        throw Error("statistics are written as .csv, .svg or .json", request.output);
    if (sections && !options.balance.empty())
        throw Error("balances are of whole regions: leave out --along and --line", "--balance");
    if (svg && !sections && (!options.allTimes || !options.balance.empty()))
        throw Error("a figure is drawn of --along, --line, or --all-times", request.output);
    if (svg && sections && options.allTimes) throw Error("a figure shows one time: state --time", request.output);
    const Progress progress = terminalProgress("stats");
    const Question question = questionOf(request, openInput(request, progress.part(0, 0.3)));
    rememberStated(request.import, question.info().name);
    Answer answer;
    const double count = double(question.times.size());
    for (std::size_t t = 0; t < question.times.size(); ++t) {
        const double time = question.times[t];
        const Progress part = progress.part(0.3 + 0.7 * double(t) / count, 0.3 + 0.7 * double(t + 1) / count);
        if (question.several()) answer.text += "t = " + formatQuantity(time, question.info().timeUnit) + "\n";
        if (sections)
            addSections(answer, request, question, time, part);
        else if (question.balance >= 0)
            addBalance(answer, request, question, time, part);
        else
            addRegions(answer, question, time, part);
    }
    if (svg && !sections) answer.panels = overTimePanels(question, {});
    progress.advance(1);
    const std::string state = stateOf(question);
    const std::string json = Json{{"kind", "statistics"},
                                  {"data", question.info().name},
                                  {"samples", state},
                                  {"lengthUnit", question.info().lengthUnit},
                                  {"timeUnit", question.info().timeUnit},
                                  {"notes", answer.notes},
                                  {"rows", std::move(answer.json)}}
                                 .dump(1) +
                             "\n";
    if (!request.output.empty()) {
        AtomicFile file(request.output);
        const std::string origin = originText(question.origin, question.info(), question.channels);
        const std::string line = originLine(question.origin, question.info(), question.channels);
        file.write(svg                                 ? withDescription(figureSvg(answer.panels, 2), origin)
                   : hasEnding(request.output, ".csv") ? line + answer.csv
                                                       : json);
        file.commit();
    }
    if (options.json) {
        std::fputs(json.c_str(), stdout);
    } else if (request.output.empty()) {
        std::printf("%s\n%s", state.c_str(), answer.text.c_str());
        for (const std::string& note : answer.notes) std::printf("  %s\n", note.c_str());
    }
}

} // namespace

void addStatsCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "stats", "Numbers of every region: mean, spread, volume; averages along an axis or line; balances");
    const auto request = std::make_shared<StatsRequest>();
    command->add_option("IN", request->inputs, "Archive, data files that belong together, or a built-in model")
        ->required();
    command->add_option("-o,--output", request->output, "File to write: .csv, .svg or .json");
    addDescribed(*command, request->options);
    addDeriveOption(*command, request->derived);
    addImportOptions(*command, request->import);
    command->callback([request] { run(*request); });
}

} // namespace tessera::app
