#include "app/edits/label_names.h"
#include "app/pages/table_page.h"
#include "app/pane/view_parts.h"
#include "app/queries/async_query.h"
#include "app/queries/extreme_query.h"
#include "app/queries/statistics_query.h"
#include "app/tables/table_view.h"
#include "app/values/place_text.h"
#include "app/values/selection_text.h"
#include "app/views/statistics/region_data.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tessera::app {

namespace {

struct StatisticsCache : ViewCache {
    AsyncStatistics answers;
    AsyncQuery<RegionQuery, RegionNumbers> regions;
    AsyncQuery<RegionBalanceQuery, Balance> balance;
};

/// Which samples numbers are of. Count and volume are weighted by their degree of interest, like everything else.
struct Part {
    volume::Summary volume::ChannelStatistics::*summary;
    double volume::JointHistogram::*correlation;
};
constexpr Part kAllSamples{&volume::ChannelStatistics::all, &volume::JointHistogram::correlation};
constexpr Part kInsideSelection{&volume::ChannelStatistics::inside, &volume::JointHistogram::focusCorrelation};
constexpr Part kOutsideSelection{&volume::ChannelStatistics::outside, &volume::JointHistogram::outsideCorrelation};

/// The joint histogram of two positions, null for a channel with itself.
const volume::JointHistogram* jointOf(const volume::Statistics& statistics, std::size_t a, std::size_t b) {
    for (const volume::JointHistogram& joint : statistics.joint)
        if ((joint.x == static_cast<int>(a) && joint.y == static_cast<int>(b)) ||
            (joint.x == static_cast<int>(b) && joint.y == static_cast<int>(a)))
            return &joint;
    return nullptr;
}

/// Sets the summaries of all samples that are known as computed, unless samples are brushed.
void useKnown(const NumberOrigin& origin, const volume::DatasetInfo& info, const BrushedQuery& query,
              volume::Statistics& statistics) {
    if (query.selection.active()) return;
    for (std::size_t i = 0; i < statistics.channels.size(); ++i)
        if (const RegionQuery of{{query.channels[i]}, -1, query.time}; isKnown(origin, info, of))
            statistics.channels[i].all =
                volume::knownStatistics(*origin.computed, info.times[std::size_t(query.time.earlier)], "",
                                        {info.channel(query.channels[i]).name})
                    ->all.front();
}

/// Where the numbers of the table come from, in words.
std::string tableOrigin(const NumberOrigin& origin, const volume::DatasetInfo& info, const BrushedQuery& query,
                        const std::vector<int>& shown) {
    std::vector<bool> known;
    for (const int channel : shown)
        known.push_back(!query.selection.active() && isKnown(origin, info, {{channel}, -1, query.time}));
    const std::string text = originText(origin, info, shown, known), read = originText(origin, info, shown);
    return text == read ? text : text + "; r of samples " + read;
}

/// Which of the statistics a table has.
struct TableForm {
    std::size_t shown = 0;         ///< positions in the query's channels before this one
    std::vector<std::size_t> with; ///< positions of those that all are correlated with
    bool whole = false;            ///< beside what is selected and the rest
    std::string selected = {};     ///< the name of what is selected
};

Table statisticsTable(const volume::DatasetInfo& info, const StatisticsResult& result, const TableForm& form) {
    std::vector<Part> parts{kAllSamples};
    if (result.brushed)
        parts = form.whole ? std::vector{kAllSamples, kInsideSelection, kOutsideSelection}
                           : std::vector{kInsideSelection, kOutsideSelection};
    const auto channelAt = [&](std::size_t i) { return info.channel(result.query.channels[i]); };
    std::vector<RegionRow> rows;
    for (std::size_t i = 0; i < form.shown; ++i)
        for (const Part& part : parts) {
            RegionRow& row = rows.emplace_back();
            row.parameter = channelAt(i).name;
            row.unit = channelAt(i).unit;
            row.region = part.summary == kInsideSelection.summary    ? form.selected
                         : part.summary == kOutsideSelection.summary ? restName(form.selected)
                                                                     : "all";
            row.summary = result.statistics.channels[i].*part.summary;
            row.range = info.channelRange(channelAt(i));
        }
    Table table = regionTable(rows, volumeUnit(info), false, false);
    for (const std::size_t with : form.with) {
        const std::string& other = channelAt(with).name;
        TableColumn& column =
            table.columns.emplace_back(TableColumn{.name = "correlation with " + other, .head = "r with " + other});
        for (std::size_t i = 0; i < form.shown; ++i)
            for (const Part& part : parts) {
                const volume::JointHistogram* joint = jointOf(result.statistics, i, with);
                const bool any = (result.statistics.channels[i].*part.summary).samples > 0;
                column.numbers.push_back(!any        ? std::nan("")
                                         : i == with ? 1
                                         : joint     ? joint->*part.correlation
                                                     : std::nan(""));
            }
        column.resolutions.assign(column.numbers.size(), 0.001);
    }
    if (!result.brushed) { // then all rows are of all samples
        std::ranges::find(table.columns, "region", &TableColumn::name)->shown = false;
        table.names = 1;
    } else if (std::ranges::find(table.columns, "weightedSamples", &TableColumn::name) != table.columns.end()) {
        table.notes = {"samples are weighted by their degree of interest"};
    }
    return table;
}

/// The same of all samples, whatever level of detail the view has so far.
Table exactTable(const std::shared_ptr<const volume::BrickSource>& source, const NumberOrigin& origin,
                 const BrushedQuery& query, const TableForm& form, const Progress& progress) {
    StatisticsResult result{query, readStatistics(source, query, 0, progress), query.selection.active()};
    useKnown(origin, source->info(), query, result.statistics);
    return statisticsTable(source->info(), result, form);
}

/// A table that is there already, as files and pages.
ViewExport exportOf(const std::string& name, const std::shared_ptr<const Table>& table) {
    return {.name = name,
            .figure = [table](const PageForm& form, const Progress&) { return tablePage(*table, form); },
            .table = [table](const Progress&) { return *table; }};
}

/// A table whose least and greatest values can be clicked: the cross-hair goes there. `ofRow`: what a row is of.
TableLook goingToExtremes(ViewContext& context, std::function<ExtremeQuestion(std::size_t row)> ofRow) {
    if (!context.goTo) return {};
    return {.numberTip = [](std::size_t row, const TableColumn& column) -> std::string {
                const bool extreme = column.name == "min" || column.name == "max";
                return extreme && std::isfinite(column.numbers[row]) ? "Click: the cross-hair goes there" : "";
            },
            .numberClicked =
                [goTo = context.goTo, ofRow = std::move(ofRow)](std::size_t row, const TableColumn& column) {
                    ExtremeQuestion question = ofRow(row);
                    question.greatest = column.name == "max";
                    goTo(question);
                }};
}

/// The table of what is selected and of the rest, or of all samples.
void drawPartsTable(ViewContext& context, const volume::DatasetInfo& info, const StatisticsResult& numbers,
                    const TableForm& form) {
    const std::size_t parts = numbers.brushed ? 2 : 1;
    const TableLook look = goingToExtremes(context, [&](std::size_t row) {
        const int channel = numbers.query.channels[row / parts];
        return ExtremeQuestion{.channel = info.channel(channel).name,
                               .of = parts == 1         ? ExtremeOf::All
                                     : row % parts == 0 ? ExtremeOf::Selected
                                                        : ExtremeOf::Rest};
    });
    drawTable("statistics", statisticsTable(info, numbers, form), look);
}

/// The table of every region, of all samples or of those `selected`.
void drawRegionTable(ViewContext& context, const volume::Parameter& label, const std::vector<RegionRow>& rows,
                     const Table& table, bool selected) {
    Session& session = context.session;
    const auto look = [&](std::size_t row) -> TableRowLook {
        if (rows[row].all) return {.faint = true};
        return {.color = rows[row].color,
                .selected = regionBrushed(session, label, rows[row].value),
                .tip = "Click to brush this region, or to remove the brush"};
    };
    TableLook going = goingToExtremes(context, [&](std::size_t row) {
        ExtremeQuestion question{.channel = rows[row].parameter, .of = selected ? ExtremeOf::Selected : ExtremeOf::All};
        if (!rows[row].all) question.region = rows[row].value;
        return question;
    });
    going.row = look;
    if (const auto clicked = drawTable("regions", table, going))
        toggleRegionBrush(session, label, rows[*clicked].value);
}

/// What flows through every surface of every region.
void drawBalanceTable(const Table& table) {
    const float notes = ImGui::GetTextLineHeightWithSpacing() * 1.2f;
    drawTable("balance", table, {.size = {0, -notes}});
    std::string text;
    for (const std::string& note : table.notes) text += (text.empty() ? "" : "\n") + note;
    ImGui::TextDisabled("convection only, midpoint rule (hover)");
    if (ImGui::IsItemHovered()) tooltip(text.c_str());
}

/// Statistics, or the balance of a parameter.
void chooseBalance(ToolRow& tools, const volume::DatasetInfo& info, StatisticsView& view) {
    if (!tools.next(em() * 10)) return;
    ImGui::SetNextItemWidth(em() * 10);
    const std::string now = view.balance.empty() ? "statistics" : "balance of " + view.balance;
    if (ImGui::BeginCombo("##balance", now.c_str())) {
        if (ImGui::Selectable("statistics", view.balance.empty())) view.balance.clear();
        for (const volume::Parameter& parameter : info.parameters)
            if (!parameter.categorical && parameter.components == 1 &&
                ImGui::Selectable(("balance of " + parameter.name).c_str(), view.balance == parameter.name))
                view.balance = parameter.name;
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered())
        tooltip("Count, mean and standard deviation by volume, and volume; or inflow, outflow and reaction of a "
                "parameter in every region");
}

void drawBalance(ViewContext& context, ToolRow& tools, const std::string& pane, int channel, int label,
                 StatisticsCache& cache) {
    const volume::DatasetInfo& info = context.numbers->info();
    const RegionBalanceQuery query{channel, "", label, volume::timesAround(info.times, context.session.time)};
    const auto balance = cache.balance.get(
        context, context.numbers, {.key = "balance " + pane, .title = "Balance of every region", .quiet = true}, query,
        [origin = context.origin](const auto& source, const RegionBalanceQuery& asked, int, const Progress& progress) {
            return readBalance(source, origin, asked, progress);
        },
        [](const RegionBalanceQuery& a, const RegionBalanceQuery& b) { return a.channel == b.channel; });
    if (!balance) {
        const std::string failure = cache.balance.failure();
        return failure.empty() ? ImGui::TextDisabled("Computing...") : drawHint("No balance", failure.c_str());
    }
    const auto table = std::make_shared<Table>(tableOf(balanceTable(info, *balance)));
    table->notes.insert(table->notes.begin(),
                        "balance of " + info.channel(channel).name); // no column for people says it
    const std::string origin = originText(context.origin, info, {channel}, {isKnown(context.origin, info, query)});
    exportMenu(context, tools, exportOf("balance", table), true, origin);
    drawOriginText(context, tools, origin);
    drawBalanceTable(*table);
}

/// Shows the numbers of every region; false where the view shows those of the selection.
bool drawRegions(ViewContext& context, ToolRow& tools, const std::string& pane, StatisticsView& view,
                 const std::vector<int>& shown, StatisticsCache& cache) {
    const volume::DatasetInfo& info = context.numbers->info();
    const auto label = volume::labelChannel(info);
    if (!label) return false;
    const std::string& name = volume::parameterOf(info, *label).name;
    const std::string by = "by " + name;
    if (tools.next(checkboxWidth(by.c_str()))) {
        ImGui::Checkbox(by.c_str(), &view.byRegion);
        if (ImGui::IsItemHovered()) tooltip(("Numbers of every " + name).c_str());
    }
    if (!view.byRegion) return false;
    const std::string selection = context.session.selection.active() ? selectionName(context.session) : "";
    if (const std::string in = "in " + selection; !selection.empty() && tools.next(checkboxWidth(in.c_str()))) {
        ImGui::Checkbox((in + "##selected").c_str(), &view.selected);
        if (ImGui::IsItemHovered()) tooltip(("Count what is selected in every " + name + " alone").c_str());
    }
    chooseBalance(tools, info, view);
    if (const auto channel = view.balance.empty() ? std::nullopt : info.findChannel(view.balance)) {
        drawBalance(context, tools, pane, *channel, *label, cache);
        return true;
    }
    chooseChannels(tools, info, view.channels, shown);
    RegionQuery query{shown, *label, volume::timesAround(info.times, context.session.time)};
    const bool selected = view.selected && !selection.empty();
    if (selected) query.brushes = brushedQuery(context.session, info, {}, {}, 1, false);
    const auto numbers = cache.regions.get(
        context, context.numbers, {.key = "regions " + pane, .title = "Statistics by region", .quiet = true}, query,
        [origin = context.origin](const auto& source, const RegionQuery& asked, int, const Progress& progress) {
            return readRegions(source, origin, asked, progress);
        },
        [](const RegionQuery& a, const RegionQuery& b) {
            return a.channels == b.channels && a.brushes.selection.active() == b.brushes.selection.active();
        });
    if (!numbers) {
        ImGui::TextDisabled("%s", cache.regions.failure().empty() ? "Counting..." : cache.regions.failure().c_str());
        return true;
    }
    const std::vector<RegionRow> rows = regionRows(info, query, *numbers, selected ? selection : "all");
    const auto table = std::make_shared<Table>(regionTable(rows, volumeUnit(info), showsErrors(rows)));
    std::vector<bool> known;
    for (const int channel : shown)
        known.push_back(isKnown(context.origin, info, {{channel}, *label, query.time, query.brushes}));
    const std::string origin = originText(context.origin, info, shown, known);
    ViewExport made = exportOf("regions", table);
    made.brushed = selected;
    exportMenu(context, tools, std::move(made), true, origin);
    drawOriginText(context, tools, origin);
    drawRegionTable(context, volume::parameterOf(info, *label), rows, *table, selected);
    return true;
}

} // namespace

void drawStatisticsView(ViewContext& context, const std::string& pane, StatisticsView& view) {
    if (!context.source) {
        drawHint("No data", "Shows statistics of every parameter in the selection and in the rest.");
        return;
    }
    const volume::DatasetInfo& info = context.numbers->info();
    StatisticsCache& cache = cacheOf<StatisticsCache>(context, pane);
    const std::vector<int> shown = chosenChannels(info, view.channels, 64);
    if (shown.empty()) return drawHint("No parameters", "This data set has only labels.");
    ToolRow tools(context);
    if (drawRegions(context, tools, pane, view, shown, cache)) return;
    const std::vector<volume::Channel> channels = info.channels();
    std::vector<Range> ranges;
    std::size_t with = 0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const volume::Channel& channel = channels[static_cast<std::size_t>(shown[i])];
        ranges.push_back(paddedRange(info.channelRange(channel)));
        if (channel.name == view.correlateWith) with = i;
    }
    BrushedQuery query = brushedQuery(context.session, info, shown, ranges, 1, false);
    for (std::size_t i = 0; i < shown.size(); ++i)
        if (i != with) query.pairs.push_back({static_cast<int>(with), static_cast<int>(i)});
    const auto result = cache.answers.get(context, "statistics " + pane, query);

    chooseChannels(tools, info, view.channels, shown);
    const std::string current = channels[static_cast<std::size_t>(shown[with])].name;
    if (tools.next(em() * 9)) {
        ImGui::SetNextItemWidth(em() * 9);
        if (ImGui::BeginCombo("##with", ("r with " + current).c_str())) {
            for (const int channel : shown) {
                const std::string& name = channels[static_cast<std::size_t>(channel)].name;
                if (ImGui::Selectable(name.c_str(), name == current)) view.correlateWith = name;
            }
            ImGui::EndCombo();
        }
        if (ImGui::IsItemHovered())
            tooltip("Parameter with which the correlation of the others is shown (Pearson's r)");
    }
    const std::string origin = tableOrigin(context.origin, info, query, shown);
    const auto exact = [source = context.numbers, from = context.origin](const BrushedQuery& of, const TableForm& form,
                                                                         const Progress& progress) {
        return exactTable(source, from, of, form, progress);
    };
    BrushedQuery everyPair = query; // which files have
    everyPair.pairs = volume::allPairs(static_cast<int>(shown.size()));
    const std::string selected = selectionName(context.session);
    TableForm whole{shown.size(), std::vector<std::size_t>(shown.size()), true, selected};
    std::iota(whole.with.begin(), whole.with.end(), std::size_t(0));
    exportMenu(
        context, tools,
        {.name = "statistics",
         .figure = [exact, query, as = TableForm{shown.size(), {with}, false, selected}](
                       const PageForm& form,
                       const Progress& progress) { return tablePage(exact(query, as, progress), form); },
         .table = [exact, everyPair, whole](const Progress& progress) { return exact(everyPair, whole, progress); },
         .brushed = !selected.empty()},
        true, origin);
    if (!result) {
        ImGui::TextDisabled("%s", cache.answers.failure().empty() ? "Counting..." : cache.answers.failure().c_str());
        return;
    }
    const std::string state = std::string(result->brushed ? "in and outside of " + selected : "nothing is brushed") +
                              (result->statistics.level > 0 ? ", first estimate" : "");
    drawNote(tools, state);
    drawOriginText(context, tools, origin);
    StatisticsResult numbers = *result;
    useKnown(context.origin, info, numbers.query, numbers.statistics);
    const TableForm form{std::min(shown.size(), numbers.statistics.channels.size()),
                         {std::min(with, numbers.query.channels.size() - 1)},
                         false,
                         selected};
    drawPartsTable(context, info, numbers, form);
}

} // namespace tessera::app
