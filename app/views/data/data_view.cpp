#include "app/data/sources.h"
#include "app/edits/label_names.h"
#include "app/pane/view_parts.h"
#include "app/queries/extreme_query.h"
#include "app/queries/focus_share.h"
#include "app/queries/statistics_query.h"
#include "app/session/label_colors.h"
#include "app/tools/brush_list.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/ui/widgets.h"
#include "app/values/place_text.h"
#include "app/values/selection_text.h"
#include "app/views/data/derived_list.h"
#include "app/views/data/glyph_part_list.h"
#include "app/views/data/plane_setting.h"
#include "app/views/data/selection_rows.h"
#include "codec/archive/archive.h"
#include "codec/container/exactness.h"
#include "volume/derived/derived.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>
#include <imgui_stdlib.h>

namespace tessera::app {

namespace {

struct DataCache : ViewCache {
    AsyncStatistics answers;
    DerivedDraft derived;
};

void row(const char* label, const std::string& text) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", label);
    ImGui::TableNextColumn();
    ImGui::PushTextWrapPos(0); // for words wider than the column; numbers must not break at their points
    ImGui::TextUnformatted(wrappedAtSpaces(text, ImGui::GetContentRegionAvail().x).c_str());
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
        const LengthUnit unit = axis == info.timeAxis() ? LengthUnit{info.timeUnit, info.plane->timePerLength}
                                                        : suitableLength(info.lengthUnit, size);
        text += (axis ? " \u00d7 " : "") + formatQuantity(size * unit.perUnit, unit.name, size * unit.perUnit / 1000);
    }
    return text + (info.lengthUnit.empty() ? ", no unit stated" : "");
}

void drawSummary(const ViewContext& context) {
    const volume::DatasetInfo& info = context.numbers->info();
    // In a narrow pane texts stand below their names: the next column of a table of one is the next row.
    const bool narrow = ImGui::GetContentRegionAvail().x < em() * 16;
    if (!ImGui::BeginTable("summary", narrow ? 1 : 2)) return;
    if (!narrow) ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, em() * 5.5f);
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
    row("Name", info.name.empty() ? "unnamed" : info.name);
    row("Samples", latticeText(info));
    row("Numbers", originText(context));
    if (const auto* archive = dynamic_cast<const codec::Archive*>(volume::underived(context.numbers).get()))
        row("Archive", codec::exactnessText(archive->metadata()));
    if (context.source != context.numbers) row("Drawn from", latticeText(context.source->info()));
    row("Size", sizeText(info));
    std::string times = formatCount(static_cast<double>(info.times.size()));
    if (info.times.size() > 1)
        times += ", " + (timeWord(info) == "t" ? "" : timeWord(info) + " ") + formatNumber(info.times.front()) +
                 " to " + formatQuantity(info.times.back(), info.timeUnit);
    row("Times", times);
    std::string quantities;
    for (const volume::Quantity& quantity : info.quantities)
        quantities += (quantities.empty() ? "" : ", ") + titleWithUnit(quantity.name, quantity.unit);
    if (!quantities.empty()) row("Over time", quantities);
    if (!info.provenance.empty()) row("Origin", info.provenance);
    for (std::size_t n = 0; n < info.notes.size(); ++n) row(n == 0 ? "Notes" : "", info.notes[n]);
    ImGui::EndTable();
}

/// The unit of lengths of data that state none, to be chosen.
void chooseLengthUnit(Session& session, const volume::DatasetInfo& info) {
    std::string& stated = session.data.import.lengthUnit;
    if (!info.lengthUnit.empty() && stated.empty()) return;
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("Unit of lengths");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(em() * 6);
    if (ImGui::BeginCombo("##length unit", stated.empty() ? "not stated" : stated.c_str())) {
        for (const char* unit : {"", "m", "cm", "mm", "um", "nm"})
            if (ImGui::Selectable(*unit == 0 ? "not stated" : unit, stated == unit)) stated = unit;
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered()) tooltip("The file states none: positions, lengths and volumes are in this unit");
}

/// Names and colours of a label's values, to be typed and chosen.
void editLabels(Session& session, const volume::Parameter& parameter) {
    constexpr int kColors = 8;
    if (!ImGui::BeginPopup("labels")) return;
    ImGui::TextDisabled("Names for the values of %s; remembered for these data", parameter.name.c_str());
    volume::Parameter named = parameter;
    named.labels = statedLabels(session, parameter);
    for (const volume::Label& label : named.labels) {
        ImGui::PushID(label.value);
        const glm::vec3 color = labelColor(named, label.value);
        if (ImGui::ColorButton("##color", {color.r, color.g, color.b, 1}, ImGuiColorEditFlags_NoTooltip))
            ImGui::OpenPopup("colors");
        if (ImGui::IsItemHovered()) tooltip("Click to change the colour");
        if (ImGui::BeginPopup("colors")) {
            for (int i = 0; i < kColors; ++i) {
                const glm::vec3 other(vis::colormapColor("labels", (i + 0.5) / kColors));
                if (i > 0) ImGui::SameLine();
                if (!ImGui::ColorButton(("##" + std::to_string(i)).c_str(), {other.r, other.g, other.b, 1},
                                        ImGuiColorEditFlags_NoTooltip))
                    continue;
                stateLabel(session, parameter, {label.value, "", colorText(other)});
                ImGui::CloseCurrentPopup();
            }
            ImGui::EndPopup();
        }
        ImGui::SameLine();
        ImGui::AlignTextToFramePadding();
        ImGui::Text("%d", label.value);
        ImGui::SameLine(em() * 4);
        std::string text = label.name;
        ImGui::SetNextItemWidth(em() * 12);
        if (ImGui::InputText("##name", &text)) {
            if (text.empty())
                unstateLabelName(session, parameter, label.value);
            else
                stateLabel(session, parameter, {label.value, text, ""});
        }
        if (ImGui::IsItemHovered()) tooltip("Leave empty to use the name from the data");
        ImGui::PopID();
    }
    ImGui::EndPopup();
}

void drawParameters(ViewContext& context, const volume::DatasetInfo& info) {
    Session& session = context.session;
    const auto extreme = [&](const volume::Channel& channel, bool greatest, const std::string& text) {
        ImGui::TableNextColumn();
        const bool somewhere = context.goTo && !info.parameters[std::size_t(channel.parameter)].categorical;
        if (!somewhere || text == "-") return textRight(text);
        if (linkRight((greatest ? "max " : "min ") + channel.name, text, "Click: the cross-hair and time go there"))
            context.goTo({.channel = channel.name, .greatest = greatest, .everyTime = true});
    };
    constexpr ImGuiTableFlags kFlags =
        ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_PadOuterX;
    if (!ImGui::BeginTable("parameters", 4, kFlags)) return;
    ImGui::TableSetupColumn("Parameter", 0, 1.6f);
    ImGui::TableSetupColumn("Minimum", 0, 1);
    ImGui::TableSetupColumn("Maximum", 0, 1);
    ImGui::TableSetupColumn("Stored as", 0, 1.1f);
    tableHeader({"Parameter", "Minimum", "Maximum", "Stored as"});
    for (const volume::Channel& channel : info.channels()) {
        const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(channel.parameter)];
        const Range range = info.channelRange(channel);
        const double digits = parameter.categorical ? 1 : (range.hi - range.lo) / 1000;
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::PushID(channel.name.c_str());
        bool over = false;
        if (parameter.categorical && !parameter.labels.empty()) {
            const std::string shown = fitText(channel.name, ImGui::GetContentRegionAvail().x);
            if (ImGui::Selectable(shown.empty() ? "##name" : shown.c_str())) ImGui::OpenPopup("labels");
            over = ImGui::IsItemHovered();
            editLabels(session, parameter);
        } else {
            fittedText(titleWithUnit(channel.name, channel.unit + (parameter.unitGuessed ? " (guessed)" : "")));
            if (parameter.unitGuessed && ImGui::IsItemHovered())
                tooltip("The file states no unit; this is the usual one for the name. Use --unit to state another.");
        }
        // A part of a glyph takes it (glyph_part_list.h).
        if (ImGui::BeginDragDropSource(ImGuiDragDropFlags_SourceAllowNullID)) {
            ImGui::SetDragDropPayload(kParameterPayload, channel.name.c_str(), channel.name.size() + 1);
            ImGui::TextUnformatted(channel.name.c_str());
            ImGui::EndDragDropSource();
        }
        ImGui::PopID();
        if (over) {
            std::string labels = channel.name + ": click to name its values";
            for (const volume::Label& label : parameter.labels)
                labels += "\n" + std::to_string(label.value) + "  " + label.name;
            tooltip(labels.c_str());
        }
        extreme(channel, false, parameter.ranges.empty() ? "-" : formatNumber(range.lo, digits));
        extreme(channel, true, parameter.ranges.empty() ? "-" : formatNumber(range.hi, digits));
        ImGui::TableNextColumn();
        textRight(channel.magnitude       ? "computed"
                  : parameter.categorical ? "label"
                                          : std::string(volume::name(parameter.type)),
                  true);
    }
    ImGui::EndTable();
}

void drawSelection(ViewContext& context, const StatisticsResult* result) {
    const volume::DatasetInfo& info = context.numbers->info();
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
    ImGui::PushTextWrapPos(0);
    if (result->brushed) {
        const FocusShare share = focusShare(*result, info, context.numbers->grid());
        drawSelectionName(context.session);
        const bool weighted = share.focus != std::round(share.focus);
        ImGui::Text("%s, %s%s",
                    (weighted ? formatNumber(share.focus, 0.1) + " weighted samples"
                              : formatCount(share.focus) + (share.focus == 1 ? " sample" : " samples"))
                        .c_str(),
                    shareText(share).c_str(), statistics.level > 0 ? " (first estimate)" : "");
        double volume = 0;
        for (const volume::ChannelStatistics& channel : statistics.channels)
            volume = std::max(volume, channel.inside.volume);
        const glm::dvec3 size = info.bounds.size();
        const double whole = size.x * size.y * size.z;
        ImGui::TextDisabled("%s%s", volumeText(info, volume).c_str(),
                            whole > 0 ? (", " + formatShare(volume / whole) + " of the whole box").c_str() : "");
    }
    ImGui::TextDisabled("%s", originText(context, result->query.channels).c_str());
    ImGui::PopTextWrapPos();
    constexpr ImGuiTableFlags kFlags =
        ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_PadOuterX;
    const bool brushed = result->brushed;
    if (!ImGui::BeginTable("selection", brushed ? 3 : 2, kFlags)) return;
    ImGui::TableSetupColumn("Parameter", 0, 1);
    ImGui::TableSetupColumn(brushed ? "Selected" : "Mean and range", 0, 1.2f);
    if (brushed) ImGui::TableSetupColumn("Rest", 0, 1.2f);
    const std::string name = selectionName(context.session);
    if (brushed)
        tableHeader({"Parameter", name, restName(name)});
    else
        tableHeader({"Parameter", "Mean and range now"});
    // Mean above, range below: side by side they do not fit a narrow pane.
    const auto cell = [](const SelectionCell& texts) {
        ImGui::TableNextColumn();
        textRight(texts[0]);
        textRight(texts[1], true);
    };
    for (const SelectionRow& row : selectionRows(info, *result)) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(row.what.c_str());
        if (row.region) ImGui::TextDisabled("share, samples");
        cell(brushed ? row.inside : row.all);
        if (brushed) cell(row.outside);
    }
    ImGui::EndTable();
    if (!context.runCommand) return;
    if (ImGui::SmallButton("Open the full table")) context.runCommand("New: Statistics");
    if (!brushed) return;
    ImGui::SameLine();
    if (ImGui::SmallButton("Save as CSV...")) context.runCommand("Save the selection as a table...");
}

} // namespace

void drawDataView(ViewContext& context, const std::string& pane, DataView&) {
    if (!context.source) {
        drawHint("No data", "Lists the contents of the data and of the selection.");
        return;
    }
    DataCache& cache = cacheOf<DataCache>(context, pane);
    const volume::DatasetInfo& info = context.numbers->info();
    const BrushedQuery query = selectionQuery(context.session, info);
    std::shared_ptr<const StatisticsResult> result;
    if (!query.channels.empty()) result = cache.answers.get(context, "summary " + pane, query);
    ImGui::BeginChild("data");
    if (ImGui::CollapsingHeader("Data set", ImGuiTreeNodeFlags_DefaultOpen)) {
        drawSummary(context);
        chooseLengthUnit(context.session, info);
    }
    if (ImGui::CollapsingHeader("Plane in space and time", context.session.data.timeAxis
                                                               ? ImGuiTreeNodeFlags_DefaultOpen
                                                               : ImGuiTreeNodeFlags_None))
        drawPlaneSetting(context);
    // Above the derived parameters, whose height changes while a formula is edited.
    if (ImGui::CollapsingHeader("Derived parameters", ImGuiTreeNodeFlags_DefaultOpen))
        drawDerivedList(context, cache.derived);
    if (ImGui::CollapsingHeader("Selection", ImGuiTreeNodeFlags_DefaultOpen)) drawSelection(context, result.get());
    if (ImGui::CollapsingHeader("Parameters over all times", ImGuiTreeNodeFlags_DefaultOpen))
        drawParameters(context, info);
    if (!cache.answers.failure().empty()) ImGui::TextWrapped("%s", cache.answers.failure().c_str());
    ImGui::EndChild();
}

} // namespace tessera::app
