#include "app/edits/label_names.h"
#include "app/pages/table_page.h"
#include "app/pane/view_parts.h"
#include "app/queries/async_query.h"
#include "app/queries/statistics_query.h"
#include "app/tables/table_view.h"
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

/// Count and volume are of samples weighted by their degree of interest, like everything else.
struct Part {
    const char* name;
    volume::Summary volume::ChannelStatistics::*summary;
    double volume::JointHistogram::*correlation;
};
constexpr Part kAllSamples{"all", &volume::ChannelStatistics::all, &volume::JointHistogram::correlation};
constexpr Part kInsideSelection{"inside", &volume::ChannelStatistics::inside,
                                &volume::JointHistogram::focusCorrelation};
constexpr Part kOutsideSelection{"outside", &volume::ChannelStatistics::outside,
                                 &volume::JointHistogram::outsideCorrelation};

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
    bool whole = false;            ///< beside what is inside and outside of the selection
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
            row.region = part.name;
            row.summary = result.statistics.channels[i].*part.summary;
            row.range = info.channelRange(channelAt(i));
        }
    Table table = regionTable(rows, info.lengthUnit, false, false);
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
    } else {
        table.notes = {"inside and outside of the selection, samples weighted by their degree of interest"};
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

/// The table of every region, without any brush.
void drawRegionTable(Session& session, const volume::Parameter& label, const std::vector<RegionRow>& rows,
                     const Table& table) {
    const auto look = [&](std::size_t row) -> TableRowLook {
        if (rows[row].all) return {.faint = true};
        return {.color = rows[row].color,
                .selected = regionBrushed(session, label, rows[row].value),
                .tip = "Click to brush this region, or to remove the brush"};
    };
    if (const auto clicked = drawTable("regions", table, {.row = look}))
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
        if (ImGui::IsItemHovered()) tooltip(("Numbers of every " + name + ", independent of the brushes").c_str());
    }
    if (!view.byRegion) return false;
    chooseBalance(tools, info, view);
    if (const auto channel = view.balance.empty() ? std::nullopt : info.findChannel(view.balance)) {
        drawBalance(context, tools, pane, *channel, *label, cache);
        return true;
    }
    chooseChannels(tools, info, view.channels, shown);
    const RegionQuery query{shown, *label, volume::timesAround(info.times, context.session.time)};
    const auto numbers = cache.regions.get(
        context, context.numbers, {.key = "regions " + pane, .title = "Statistics by region", .quiet = true}, query,
        [origin = context.origin](const auto& source, const RegionQuery& asked, int, const Progress& progress) {
            return readRegions(source, origin, asked, progress);
        },
        [](const RegionQuery& a, const RegionQuery& b) { return a.channels == b.channels; });
    if (!numbers) {
        ImGui::TextDisabled("%s", cache.regions.failure().empty() ? "Counting..." : cache.regions.failure().c_str());
        return true;
    }
    const std::vector<RegionRow> rows = regionRows(info, query, *numbers);
    const auto table = std::make_shared<Table>(regionTable(rows, info.lengthUnit, showsErrors(rows)));
    std::vector<bool> known;
    for (const int channel : shown) known.push_back(isKnown(context.origin, info, {{channel}, *label, query.time}));
    const std::string origin = originText(context.origin, info, shown, known);
    exportMenu(context, tools, exportOf("regions", table), true, origin);
    drawOriginText(context, tools, origin);
    drawRegionTable(context.session, volume::parameterOf(info, *label), rows, *table);
    return true;
}

} // namespace

void drawStatisticsView(ViewContext& context, const std::string& pane, StatisticsView& view) {
    if (!context.source) {
        drawHint("No data", "Shows statistics of every parameter inside and outside the selection.");
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
    TableForm whole{shown.size(), std::vector<std::size_t>(shown.size()), true};
    std::iota(whole.with.begin(), whole.with.end(), std::size_t(0));
    exportMenu(
        context, tools,
        {.name = "statistics",
         .figure =
             [exact, query, as = TableForm{shown.size(), {with}}](const PageForm& form, const Progress& progress) {
                 return tablePage(exact(query, as, progress), form);
             },
         .table = [exact, everyPair, whole](const Progress& progress) { return exact(everyPair, whole, progress); }},
        true, origin);
    if (!result) {
        ImGui::TextDisabled("%s", cache.answers.failure().empty() ? "Counting..." : cache.answers.failure().c_str());
        return;
    }
    const std::string state =
        std::string(result->brushed ? "weighted by the degree of interest" : "nothing is brushed") +
        (result->statistics.level > 0 ? ", first estimate" : "");
    drawNote(tools, state);
    drawOriginText(context, tools, origin);
    StatisticsResult numbers = *result;
    useKnown(context.origin, info, numbers.query, numbers.statistics);
    const TableForm form{std::min(shown.size(), numbers.statistics.channels.size()),
                         {std::min(with, numbers.query.channels.size() - 1)}};
    drawTable("statistics", statisticsTable(info, numbers, form));
}

} // namespace tessera::app
