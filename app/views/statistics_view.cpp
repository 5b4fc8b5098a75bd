#include "app/ui/widgets.h"
#include "app/views/figure.h"
#include "app/views/statistics_feed.h"
#include "app/views/ticks.h"
#include "app/views/view_parts.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

struct StatisticsCache : ViewCache {
    StatisticsFeed feed;
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

/// Everything at full resolution: summaries and all correlations.
std::string statisticsCsv(const std::shared_ptr<const volume::BrickSource>& source, StatisticsWish wish,
                          std::size_t shown, const Progress& progress) {
    const volume::DatasetInfo& info = source->info();
    const bool brushed = wish.selection.active();
    wish.pairs = volume::allPairs(static_cast<int>(shown));
    wish.bins = 1;
    const volume::Statistics statistics = answer(source, wish, 0, progress);
    const std::vector<volume::Channel> channels = info.channels();
    const auto nameOf = [&](std::size_t i) { return channels[static_cast<std::size_t>(wish.channels[i])].name; };
    std::string csv = "parameter,unit,part,samples,volume [" + info.lengthUnit + "3],mean,deviation,min,max";
    for (std::size_t i = 0; i < shown; ++i) csv += "," + csvField("correlation with " + nameOf(i));
    csv += "\n";
    for (std::size_t i = 0; i < shown; ++i) {
        std::vector<Part> parts = partsOf(statistics.channels[i], brushed);
        if (brushed) parts.insert(parts.begin(), {"all", statistics.channels[i].all});
        for (const Part& part : parts) {
            csv += csvField(nameOf(i)) + "," + csvField(channels[static_cast<std::size_t>(wish.channels[i])].unit) +
                   "," + part.name;
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

void drawTable(const volume::DatasetInfo& info, const StatisticsResult& result, std::size_t shown, std::size_t with) {
    constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp |
                                       ImGuiTableFlags_PadOuterX | ImGuiTableFlags_ScrollY |
                                       ImGuiTableFlags_BordersInnerV;
    const std::vector<volume::Channel> channels = info.channels();
    const std::string other = "r with " + channels[static_cast<std::size_t>(result.wish.channels[with])].name;
    if (!ImGui::BeginTable("statistics", 9, kFlags)) return;
    ImGui::TableSetupScrollFreeze(1, 1);
    for (const char* name : {"Parameter", "Part", "Samples", "Volume", "Mean", "Std. deviation", "Least", "Most"})
        ImGui::TableSetupColumn(name);
    ImGui::TableSetupColumn(other.c_str());
    tableHeader({"Parameter", "Part", "Samples", "Volume", "Mean", "Std. deviation", "Least", "Most", other.c_str()},
                2);
    for (std::size_t i = 0; i < shown; ++i) {
        const volume::Channel& channel = channels[static_cast<std::size_t>(result.wish.channels[i])];
        const Range range = info.channelRange(channel);
        const double digits = (range.hi - range.lo) / 10000;
        bool first = true;
        for (const Part& part : partsOf(result.statistics.channels[i], result.brushed)) {
            const volume::Summary& of = part.summary;
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            if (first) ImGui::TextUnformatted(titleWithUnit(channel.name, channel.unit).c_str());
            first = false;
            ImGui::TableNextColumn();
            ImGui::TextDisabled("%s", part.name);
            const auto cell = [&](const std::string& text) {
                ImGui::TableNextColumn();
                textRight(of.samples > 0 ? text : "-");
            };
            cell(formatCount(std::round(of.samples)));
            cell(formatVolume(of.volume, info.lengthUnit));
            cell(formatNumber(of.mean, digits));
            cell(formatNumber(of.deviation, digits));
            cell(formatNumber(of.min, digits));
            cell(formatNumber(of.max, digits));
            const volume::JointHistogram* joint = jointOf(result.statistics, i, with);
            const double r = joint ? correlationOf(*joint, part.name) : std::nan("");
            cell(i == with ? "1" : std::isnan(r) ? "-" : formatNumber(r, 0.001));
        }
    }
    ImGui::EndTable();
}

} // namespace

void drawStatisticsView(ViewContext& context, const std::string& pane, StatisticsView& view) {
    if (!context.source) {
        drawHint("No data", "Numbers of every parameter inside and outside of the selection appear here.");
        return;
    }
    const volume::DatasetInfo& info = context.source->info();
    StatisticsCache& cache = cacheOf<StatisticsCache>(context, pane);
    const std::vector<int> shown = chosenChannels(info, view.channels, 64);
    if (shown.empty()) return drawHint("No parameters", "This data set holds only labels.");
    const std::vector<volume::Channel> channels = info.channels();
    std::vector<Range> ranges;
    std::size_t with = 0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const volume::Channel& channel = channels[static_cast<std::size_t>(shown[i])];
        ranges.push_back(paddedRange(info.channelRange(channel)));
        if (channel.name == view.correlateWith) with = i;
    }
    StatisticsWish wish = makeWish(context.session, info, shown, ranges, 1, false);
    for (std::size_t i = 0; i < shown.size(); ++i)
        if (i != with) wish.pairs.push_back({static_cast<int>(with), static_cast<int>(i)});
    const auto result = cache.feed.get(context, "statistics " + pane, wish);

    chooseChannels(info, view.channels, shown);
    continueLine(em() * 9);
    ImGui::SetNextItemWidth(em() * 9);
    const std::string current = channels[static_cast<std::size_t>(shown[with])].name;
    if (ImGui::BeginCombo("##with", ("r with " + current).c_str())) {
        for (const int channel : shown) {
            const std::string& name = channels[static_cast<std::size_t>(channel)].name;
            if (ImGui::Selectable(name.c_str(), name == current)) view.correlateWith = name;
        }
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered()) tooltip("Parameter that every other one is correlated with (Pearson's r)");
    continueLine(buttonWidth("Export"));
    exportMenu(context, "statistics", {},
               [source = context.source, wish, count = shown.size()](const Progress& progress) {
                   return statisticsCsv(source, wish, count, progress);
               });
    if (!result) {
        ImGui::TextDisabled("%s", cache.feed.failure().empty() ? "Counting..." : cache.feed.failure().c_str());
        return;
    }
    const std::string state =
        std::string(result->brushed ? "weighted by the degree of interest" : "nothing is brushed") +
        (result->statistics.level > 0 ? ", first estimate" : "");
    continueLine(ImGui::CalcTextSize(state.c_str()).x);
    ImGui::TextDisabled("%s", state.c_str());
    drawTable(info, *result, std::min(shown.size(), result->statistics.channels.size()),
              std::min(with, result->wish.channels.size() - 1));
}

} // namespace tessera::app
