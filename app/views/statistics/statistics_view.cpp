#include "app/edits/label_names.h"
#include "app/pane/figure.h"
#include "app/pane/view_parts.h"
#include "app/queries/async_query.h"
#include "app/queries/statistics_query.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "app/views/statistics/region_data.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>

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
    volume::Summary summary;
};

std::vector<Part> partsOf(const volume::ChannelStatistics& channel, bool brushed) {
    if (!brushed) return {{"all", channel.all}};
    return {{"inside", channel.inside}, {"outside", channel.outside}};
}

double correlationOf(const volume::JointHistogram& joint, const char* part) {
    return std::string_view(part) == "inside"    ? joint.focusCorrelation
           : std::string_view(part) == "outside" ? joint.outsideCorrelation
                                                 : joint.correlation;
}

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

/// Everything at full resolution: summaries and all correlations.
std::string statisticsCsv(const std::shared_ptr<const volume::BrickSource>& source, const NumberOrigin& origin,
                          BrushedQuery query, std::size_t shown, const Progress& progress) {
    const volume::DatasetInfo& info = source->info();
    const bool brushed = query.selection.active();
    query.pairs = volume::allPairs(static_cast<int>(shown));
    query.bins = 1;
    volume::Statistics statistics = readStatistics(source, query, 0, progress);
    useKnown(origin, info, query, statistics);
    const std::vector<volume::Channel> channels = info.channels();
    const auto nameOf = [&](std::size_t i) { return channels[static_cast<std::size_t>(query.channels[i])].name; };
    const std::string cubes = info.lengthUnit.empty() ? "" : " [" + info.lengthUnit + "3]";
    std::string csv = "parameter,unit,part,samples,volume" + cubes + ",mean,deviation,min,max";
    for (std::size_t i = 0; i < shown; ++i) csv += "," + csvField("correlation with " + nameOf(i));
    csv += "\n";
    for (std::size_t i = 0; i < shown; ++i) {
        std::vector<Part> parts = partsOf(statistics.channels[i], brushed);
        if (brushed) parts.insert(parts.begin(), {"all", statistics.channels[i].all});
        for (const Part& part : parts) {
            csv += csvField(nameOf(i)) + "," + csvField(channels[static_cast<std::size_t>(query.channels[i])].unit) +
                   "," + csvField(part.name);
            const volume::Summary& of = part.summary;
            for (const double value : {of.samples, of.volume, of.mean, of.deviation, of.min, of.max})
                csv += "," + csvNumber(value);
            for (std::size_t k = 0; k < shown; ++k) {
                const volume::JointHistogram* joint = jointOf(statistics, i, k);
                csv += "," + (joint ? csvNumber(correlationOf(*joint, part.name)) : std::string("1"));
            }
            csv += "\n";
        }
    }
    return csv;
}

/// Begins a table whose heads stay, with the first `frozen` columns: stretched to the width if all texts fit, else as
/// wide as its texts with a scroll bar: a truncated number would be wrong.
bool beginTable(const char* id, const std::vector<std::string>& heads,
                const std::vector<std::vector<std::string>>& rows, int frozen, ImVec2 size) {
    std::vector<float> widths;
    float wanted = ImGui::GetStyle().ScrollbarSize;
    for (std::size_t c = 0; c < heads.size(); ++c) {
        float width = ImGui::CalcTextSize(heads[c].c_str()).x;
        for (const std::vector<std::string>& row : rows) width = std::max(width, ImGui::CalcTextSize(row[c].c_str()).x);
        widths.push_back(width + em()); // space for the mark in the region's colour
        wanted += widths.back() + 2 * ImGui::GetStyle().CellPadding.x + 1;
    }
    const bool room = wanted <= ImGui::GetContentRegionAvail().x;
    const ImGuiTableFlags flags =
        ImGuiTableFlags_RowBg | ImGuiTableFlags_PadOuterX | ImGuiTableFlags_ScrollY | ImGuiTableFlags_BordersInnerV |
        (room ? ImGuiTableFlags_SizingStretchProp : ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollX);
    // ImGui stores the widths per table, so each layout has an id of its own.
    const std::string name = id + std::string(room ? "" : " scrolled");
    if (!beginScrolledTable(name.c_str(), static_cast<int>(heads.size()), flags, size)) return false;
    ImGui::TableSetupScrollFreeze(frozen, 1);
    for (std::size_t c = 0; c < heads.size(); ++c)
        ImGui::TableSetupColumn(heads[c].c_str(), room ? ImGuiTableColumnFlags_None : ImGuiTableColumnFlags_WidthFixed,
                                room ? 0 : widths[c]);
    return true;
}

/// Rows of the table: parameter, part, samples, volume, mean, deviation, least, most, correlation.
std::vector<std::vector<std::string>> statisticsRows(const volume::DatasetInfo& info, const StatisticsResult& result,
                                                     std::size_t shown, std::size_t with) {
    const std::vector<volume::Channel> channels = info.channels();
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < shown; ++i) {
        const volume::Channel& channel = channels[static_cast<std::size_t>(result.query.channels[i])];
        const Range range = info.channelRange(channel);
        const double digits = (range.hi - range.lo) / 10000;
        for (const Part& part : partsOf(result.statistics.channels[i], result.brushed)) {
            const volume::Summary& of = part.summary;
            const volume::JointHistogram* joint = jointOf(result.statistics, i, with);
            const double r = joint ? correlationOf(*joint, part.name) : std::nan("");
            std::vector<std::string> row{titleWithUnit(channel.name, channel.unit), part.name};
            for (const std::string& text :
                 {formatCount(std::round(of.samples)), formatVolume(of.volume, info.lengthUnit),
                  formatNumber(of.mean, digits), formatNumber(of.deviation, digits), formatNumber(of.min, digits),
                  formatNumber(of.max, digits),
                  i == with       ? std::string("1")
                  : std::isnan(r) ? std::string("-")
                                  : formatNumber(r, 0.001)})
                row.push_back(of.samples > 0 ? text : "-");
            rows.push_back(std::move(row));
        }
    }
    return rows;
}

void drawTable(const volume::DatasetInfo& info, const StatisticsResult& result, std::size_t shown, std::size_t with) {
    const std::string other = "r with " + info.channel(result.query.channels[with]).name;
    const std::vector<std::vector<std::string>> rows = statisticsRows(info, result, shown, with);
    if (!beginTable("statistics",
                    {"Parameter", "Part", "Samples", "Volume", "Mean", "Std. deviation", "Minimum", "Maximum", other},
                    rows, 2, {}))
        return;
    tableHeader(
        {"Parameter", "Part", "Samples", "Volume", "Mean", "Std. deviation", "Minimum", "Maximum", other.c_str()}, 2);
    std::string last;
    for (const std::vector<std::string>& row : rows) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        if (row[0] != last) ImGui::TextUnformatted(row[0].c_str());
        last = row[0];
        ImGui::TableNextColumn();
        ImGui::TextDisabled("%s", row[1].c_str());
        for (std::size_t c = 2; c < row.size(); ++c) {
            ImGui::TableNextColumn();
            textRight(row[c]);
        }
    }
    ImGui::EndTable();
}

/// The table of every region, without any brush.
void drawRegionTable(Session& session, const volume::DatasetInfo& info, const volume::Parameter& label,
                     const std::vector<RegionRow>& rows) {
    const std::vector<std::string> heads = regionHeads(showsErrors(rows));
    std::vector<std::vector<std::string>> texts;
    for (const RegionRow& row : rows) texts.push_back(regionCells(row, info.lengthUnit, showsErrors(rows)));
    if (!beginTable("regions", heads, texts, 2, {})) return;
    tableHeader(heads, 2);
    std::string last;
    for (const RegionRow& row : rows) {
        const std::vector<std::string>& cells = texts[static_cast<std::size_t>(&row - rows.data())];
        ImGui::TableNextRow();
        for (std::size_t c = 0; c < cells.size(); ++c) {
            ImGui::TableNextColumn();
            if (c == 0) {
                if (cells[0] != last) ImGui::TextUnformatted(cells[0].c_str());
            } else if (c == 1) {
                const ImVec2 at = ImGui::GetCursorScreenPos();
                const glm::vec3 color = row.color;
                if (!row.all)
                    ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + em() * 0.15f},
                                                              {at.x + em() * 0.7f, at.y + em() * 0.85f},
                                                              toColor({color.r, color.g, color.b}));
                ImGui::SetCursorPosX(ImGui::GetCursorPosX() + em());
                if (row.all)
                    ImGui::TextDisabled("%s", cells[1].c_str());
                else if (ImGui::Selectable((cells[1] + "##" + std::to_string(&row - rows.data())).c_str(),
                                           regionBrushed(session, label, row.value)))
                    toggleRegionBrush(session, label, row.value);
                if (!row.all && ImGui::IsItemHovered()) tooltip("Click to brush this region, or to remove the brush");
            } else {
                textRight(cells[c], row.all);
            }
        }
        last = cells[0];
    }
    ImGui::EndTable();
}

/// What flows through every surface of every region.
void drawBalanceTable(const BalanceTable& table) {
    const std::vector<std::string> heads = balanceHeads(table);
    std::vector<std::vector<std::string>> texts;
    for (const BalanceRow& row : table.rows) texts.push_back(balanceCells(table, row));
    const float notes = ImGui::GetTextLineHeightWithSpacing() * 1.2f;
    if (beginTable("balance", heads, texts, 2, {0, -notes})) {
        ImGui::TableHeadersRow();
        std::string last;
        for (const BalanceRow& row : table.rows) {
            const std::vector<std::string>& cells = texts[static_cast<std::size_t>(&row - table.rows.data())];
            ImGui::TableNextRow();
            for (std::size_t c = 0; c < cells.size(); ++c) {
                ImGui::TableNextColumn();
                if (c > 1)
                    textRight(cells[c], !row.total && c == 4);
                else if (c == 1 || cells[0] != last)
                    ImGui::TextUnformatted(cells[c].c_str());
            }
            last = cells[0];
        }
        ImGui::EndTable();
    }
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
        tooltip("Count, mean, standard deviation and volume; or inflow, outflow and reaction of a parameter in every "
                "region");
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
    const auto table = std::make_shared<BalanceTable>(balanceTable(info, *balance));
    const std::string origin = originText(context.origin, info, {channel}, {isKnown(context.origin, info, query)});
    exportMenu(context, tools,
               {.name = "balance", .csv = [table](const Progress&) { return balanceCsv(*table, "", ""); }}, true,
               origin);
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
    const auto rows = std::make_shared<std::vector<RegionRow>>(regionRows(info, query, *numbers));
    std::vector<bool> known;
    for (const int channel : shown) known.push_back(isKnown(context.origin, info, {{channel}, *label, query.time}));
    const std::string origin = originText(context.origin, info, shown, known);
    exportMenu(context, tools,
               {.name = "regions",
                .csv = [rows, unit = info.lengthUnit](
                           const Progress&) { return regionCsv(*rows, unit, "", "", true, showsErrors(*rows)); }},
               true, origin);
    drawOriginText(context, tools, origin);
    drawRegionTable(context.session, info, volume::parameterOf(info, *label), *rows);
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
    exportMenu(context, tools,
               {.name = "statistics",
                .csv = [source = context.numbers, from = context.origin, query, count = shown.size()](
                           const Progress& progress) { return statisticsCsv(source, from, query, count, progress); }},
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
    drawTable(info, numbers, std::min(shown.size(), result->statistics.channels.size()),
              std::min(with, result->query.channels.size() - 1));
}

} // namespace tessera::app
