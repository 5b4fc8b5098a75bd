#include "app/views/derived_list.h"
#include "app/views/statistics_feed.h"
#include "app/views/ticks.h"
#include "app/views/view_parts.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>

namespace tessera::app {

namespace {

struct DataCache : ViewCache {
    StatisticsFeed feed;
    DerivedDraft derived;
};

void row(const char* label, const std::string& text) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", label);
    ImGui::TableNextColumn();
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
}

std::string latticeText(const volume::DatasetInfo& info) {
    const volume::Lattice& lattice = info.lattice;
    const std::string samples = std::to_string(lattice.size.x) + " \u00d7 " + std::to_string(lattice.size.y) +
                                " \u00d7 " + std::to_string(lattice.size.z) + " = " +
                                formatCount(static_cast<double>(lattice.count())) + " samples";
    if (lattice.kind == volume::LatticeKind::CC) return "Cartesian (CC), " + samples;
    // The grid it came from has sqrt 2 finer cells over the same box.
    double cc = 1;
    for (int axis = 0; axis < 3; ++axis)
        cc *= std::round(info.bounds.size()[axis] / lattice.spacing[axis] * volume::kBccSpacing) + 1;
    return "body-centred (BCC), " + samples + ", " + formatShare(static_cast<double>(lattice.count()) / cc) +
           " of a Cartesian grid's";
}

std::string sizeText(const volume::DatasetInfo& info) {
    std::string text;
    for (int axis = 0; axis < 3; ++axis) {
        const double size = info.bounds.size()[axis];
        const LengthUnit unit = suitableLength(info.lengthUnit, size);
        text += (axis ? " \u00d7 " : "") + formatQuantity(size * unit.perUnit, unit.name, size * unit.perUnit / 1000);
    }
    return text;
}

void drawSummary(const volume::DatasetInfo& info) {
    if (!ImGui::BeginTable("summary", 2)) return;
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, em() * 5.5f);
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
    row("Name", info.name.empty() ? "unnamed" : info.name);
    row("Samples", latticeText(info));
    row("Size", sizeText(info));
    std::string times = formatCount(static_cast<double>(info.times.size()));
    if (info.times.size() > 1)
        times += ", " + formatNumber(info.times.front()) + " to " + formatQuantity(info.times.back(), info.timeUnit);
    row("Times", times);
    if (!info.provenance.empty()) row("Origin", info.provenance);
    ImGui::EndTable();
}

void drawParameters(const volume::DatasetInfo& info) {
    constexpr ImGuiTableFlags kFlags =
        ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_PadOuterX;
    if (!ImGui::BeginTable("parameters", 4, kFlags)) return;
    ImGui::TableSetupColumn("Parameter", 0, 1.6f);
    ImGui::TableSetupColumn("Least", 0, 1);
    ImGui::TableSetupColumn("Most", 0, 1);
    ImGui::TableSetupColumn("Stored as", 0, 1.1f);
    tableHeader({"Parameter", "Least", "Most", "Stored as"});
    for (const volume::Channel& channel : info.channels()) {
        const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(channel.parameter)];
        const Range range = info.channelRange(channel);
        const double digits = parameter.categorical ? 1 : (range.hi - range.lo) / 1000;
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(titleWithUnit(channel.name, channel.unit).c_str());
        if (parameter.categorical && ImGui::IsItemHovered() && !parameter.labels.empty()) {
            std::string labels;
            for (const volume::Label& label : parameter.labels)
                labels += (labels.empty() ? "" : "\n") + std::to_string(label.value) + "  " + label.name;
            tooltip(labels.c_str());
        }
        ImGui::TableNextColumn();
        textRight(parameter.ranges.empty() ? "-" : formatNumber(range.lo, digits));
        ImGui::TableNextColumn();
        textRight(parameter.ranges.empty() ? "-" : formatNumber(range.hi, digits));
        ImGui::TableNextColumn();
        textRight(channel.magnitude       ? "computed"
                  : parameter.categorical ? "label"
                                          : std::string(volume::name(parameter.type)),
                  true);
    }
    ImGui::EndTable();
}

std::string rangeText(const volume::Summary& summary, double digits) {
    if (summary.samples == 0) return "-";
    return formatNumber(summary.min, digits) + " .. " + formatNumber(summary.max, digits);
}

void drawSelection(ViewContext& context, const StatisticsResult* result) {
    const volume::DatasetInfo& info = context.source->info();
    if (!context.session.selection.active()) {
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled("Nothing is brushed: drag in a plot of the scatterplot matrix.");
        ImGui::PopTextWrapPos();
        if (!result) return;
    } else if (!result) {
        ImGui::TextDisabled("Counting...");
        return;
    }
    const volume::Statistics& statistics = result->statistics;
    // The parameter that exists at most points stands for the whole.
    const volume::ChannelStatistics* whole = nullptr;
    for (const volume::ChannelStatistics& channel : statistics.channels)
        if (!whole || channel.all.samples > whole->all.samples) whole = &channel;
    double inside = 0, volume = 0;
    for (const volume::ChannelStatistics& channel : statistics.channels) {
        inside = std::max(inside, channel.inside.samples);
        volume = std::max(volume, channel.inside.volume);
    }
    if (whole && whole->all.samples > 0 && result->brushed) {
        ImGui::Text("%s of %s samples in focus, %s", formatCount(std::round(inside)).c_str(),
                    formatCount(whole->all.samples).c_str(), formatShare(inside / whole->all.samples).c_str());
        if (statistics.level > 0) {
            ImGui::SameLine();
            ImGui::TextDisabled("(first estimate)");
        }
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled("%s, %s of the volume that has data", formatVolume(volume, info.lengthUnit).c_str(),
                            formatShare(whole->all.volume > 0 ? volume / whole->all.volume : 0).c_str());
        ImGui::PopTextWrapPos();
    }
    constexpr ImGuiTableFlags kFlags =
        ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_PadOuterX;
    const bool brushed = result->brushed;
    if (!ImGui::BeginTable("selection", brushed ? 3 : 2, kFlags)) return;
    ImGui::TableSetupColumn("Parameter", 0, 1);
    ImGui::TableSetupColumn(brushed ? "In focus" : "Mean and range", 0, 1.2f);
    if (brushed) ImGui::TableSetupColumn("Outside", 0, 1.2f);
    if (brushed)
        tableHeader({"Parameter", "In focus", "Outside"});
    else
        tableHeader({"Parameter", "Mean and range now"});
    const std::vector<volume::Channel> channels = info.channels();
    for (std::size_t i = 0; i < statistics.channels.size(); ++i) {
        const volume::Channel& channel = channels[static_cast<std::size_t>(result->wish.channels[i])];
        const volume::ChannelStatistics& own = statistics.channels[i];
        const Range range = info.channelRange(channel);
        const double digits = (range.hi - range.lo) / 1000;
        // Mean above, range below: side by side they do not fit a narrow pane.
        const auto cell = [&](const volume::Summary& summary) {
            ImGui::TableNextColumn();
            textRight(summary.samples > 0 ? formatNumber(summary.mean, digits) : "-");
            textRight(rangeText(summary, digits * 10), true);
        };
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(titleWithUnit(channel.name, channel.unit).c_str());

        cell(brushed ? own.inside : own.all);
        if (brushed) cell(own.outside);
    }
    ImGui::EndTable();
    if (context.runCommand && ImGui::SmallButton("Open the full table")) context.runCommand("New: Statistics");
}

} // namespace

void drawDataView(ViewContext& context, const std::string& pane, DataView&) {
    if (!context.source) {
        drawHint("No data", "What is in the data, and what is selected, is listed here.");
        return;
    }
    DataCache& cache = cacheOf<DataCache>(context, pane);
    const volume::DatasetInfo& info = context.source->info();
    const std::vector<int> channels = comparedChannels(info);
    std::shared_ptr<const StatisticsResult> result;
    if (!channels.empty()) {
        std::vector<Range> ranges;
        const std::vector<volume::Channel> all = info.channels();
        for (int channel : channels)
            ranges.push_back(paddedRange(info.channelRange(all[static_cast<std::size_t>(channel)])));
        result =
            cache.feed.get(context, "summary " + pane, makeWish(context.session, info, channels, ranges, 16, false));
    }
    ImGui::BeginChild("data");
    if (ImGui::CollapsingHeader("Data set", ImGuiTreeNodeFlags_DefaultOpen)) drawSummary(info);
    // Above what is computed from them, which comes and goes while a formula is edited.
    if (ImGui::CollapsingHeader("Derived parameters", ImGuiTreeNodeFlags_DefaultOpen))
        drawDerivedList(context, cache.derived);
    if (ImGui::CollapsingHeader("Selection", ImGuiTreeNodeFlags_DefaultOpen)) drawSelection(context, result.get());
    if (ImGui::CollapsingHeader("Parameters over all times", ImGuiTreeNodeFlags_DefaultOpen)) drawParameters(info);
    if (!cache.feed.failure().empty()) ImGui::TextWrapped("%s", cache.feed.failure().c_str());
    ImGui::EndChild();
}

} // namespace tessera::app
