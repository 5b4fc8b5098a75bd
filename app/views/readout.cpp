#include "app/views/readout.h"

#include "app/views/axis_label.h"
#include "app/views/figure.h"
#include "app/views/pending_wish.h"
#include "app/views/ticks.h"
#include "app/views/time_text.h"
#include "app/views/view_parts.h"
#include "volume/background.h"
#include "volume/error.h"
#include "volume/quantities.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>

namespace tessera::app {

namespace {

constexpr std::size_t kCacheBytes = std::size_t(64) << 20;

std::string labelName(const volume::Parameter& parameter, double value) {
    for (const volume::Label& label : parameter.labels)
        if (label.value == static_cast<int>(std::lround(value))) return label.name;
    return formatNumber(value);
}

std::string valueText(const volume::DatasetInfo& info, const volume::Channel& channel,
                      const std::optional<double>& value) {
    if (!value) return "absent";
    const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(channel.parameter)];
    if (parameter.categorical) return labelName(parameter, *value);
    const Range range = info.channelRange(channel);
    return formatNumber(*value, (range.hi - range.lo) / 1000);
}

} // namespace

std::optional<double> Readout::value(const std::string& channel) const {
    for (std::size_t i = 0; i < channels.size() && i < state->values.size(); ++i)
        if (channels[i].name == channel) return state->values[i].interpolated;
    return std::nullopt;
}

void updateReadout(ViewContext& context, Readout& readout) {
    Readout::State& state = *readout.state;
    if (state.source != context.numbers) {
        readout.state = std::make_shared<Readout::State>();
        readout.state->source = context.numbers;
        readout.state->cache = std::make_shared<volume::BrickCache>(context.numbers, kCacheBytes);
        readout.channels = context.numbers->info().channels();
        updateReadout(context, readout);
        return;
    }
    const glm::dvec3 position = context.session.cursor;
    const volume::TimePair time = volume::timesAround(context.numbers->info().times, context.session.time);
    if (state.time == time && state.position == position) return;
    if (context.headless) {
        state.values = volume::probe(*state.cache, position, time);
        state.position = position;
        state.time = time;
        return;
    }
    context.busy = true;
    if (state.running) return;
    state.running = true;
    context.jobs.start(
        "", "Values at the cursor",
        [weak = std::weak_ptr(readout.state), cache = state.cache, position, time](const Progress&) -> Jobs::Finish {
            workInBackground();
            std::string failure;
            auto values = attempt(failure, [&] { return volume::probe(*cache, position, time); });
            return [weak, values = std::move(values), failure, position, time] {
                const auto owner = weak.lock();
                if (!owner) return;
                owner->running = false;
                owner->values = values;
                owner->position = position;
                owner->time = time;
                if (!failure.empty()) throw Error(failure);
            };
        },
        true);
}

namespace {

/// Texts one after the other; lines break between them, never within a number.
void drawFlowing(const std::vector<std::string>& texts) {
    float room = 0;
    for (const std::string& text : texts) {
        const float width = ImGui::CalcTextSize(text.c_str()).x + em() * 0.8f;
        if (room > width)
            ImGui::SameLine(0, em() * 0.8f);
        else
            room = ImGui::GetContentRegionAvail().x + em() * 0.8f;
        room -= width;
        ImGui::TextUnformatted(text.c_str());
    }
}

} // namespace

float readoutHeight(const Readout& readout) {
    const float row = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
    return 2 * ImGui::GetTextLineHeightWithSpacing() + row * static_cast<float>(readout.channels.size() + 1) +
           ImGui::GetFrameHeight();
}

void drawReadout(ViewContext& context, const Readout& readout, bool compact) {
    const volume::DatasetInfo& info = context.numbers->info();
    const glm::dvec3 cursor = context.session.cursor, size = info.bounds.size();
    const AxisLabels labels = axisLabels(context.session, info);
    const glm::ivec3 index = info.lattice.nearest(cursor);
    // The unit once, where all three axes have the same.
    std::vector<std::string> at;
    std::string unitNow;
    for (int axis = 2; axis >= 0; --axis) {
        const auto& [name, unit] = labels[static_cast<std::size_t>(axis)];
        std::string text =
            std::string(name) + " " + formatNumber(cursor[axis] * unit.perUnit, size[axis] * unit.perUnit / 200);
        if (unit.name != unitNow) text += " " + prettyUnit(unit.name);
        unitNow = unit.name;
        at.insert(at.begin(), text);
    }
    drawFlowing(at);
    const auto copy = [&] { return originLine(context.origin, info) + readoutCsv(context.session, info, readout); };
    if (compact) {
        std::vector<std::string> values;
        for (std::size_t i = 0; i < readout.channels.size() && i < readout.state->values.size(); ++i) {
            const volume::Channel& channel = readout.channels[i];
            const std::optional<double>& value = readout.state->values[i].interpolated;
            // Components say little beside the magnitude.
            const bool component = channel.name.find('.') != std::string::npos;
            if (value && !component)
                values.push_back(channel.name + " " + valueText(info, channel, value) + " " + prettyUnit(channel.unit));
        }
        drawFlowing(values);
        if (ImGui::SmallButton("Copy as CSV")) ImGui::SetClipboardText(copy().c_str());
        return;
    }
    ImGui::PushTextWrapPos(0);
    const double time = std::clamp(context.session.time, info.times.front(), info.times.back());
    const std::string origin = originText(context);
    std::string sample =
        "sample (" + std::to_string(index.x) + ", " + std::to_string(index.y) + ", " + std::to_string(index.z) + ")";
    if (info.times.size() > 1) sample += "   " + stateText(info, time, context.session.data.axis);
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::TextUnformatted((sample + "   " + origin).c_str());
    ImGui::PopStyleColor();
    ImGui::PopTextWrapPos();

    if (!ImGui::BeginTable("values", 3,
                           ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg | ImGuiTableFlags_PadOuterX))
        return;
    ImGui::TableSetupColumn("Parameter", ImGuiTableColumnFlags_WidthStretch, 1.4f);
    ImGui::TableSetupColumn("Value", ImGuiTableColumnFlags_WidthStretch, 1);
    ImGui::TableSetupColumn("Nearest", ImGuiTableColumnFlags_WidthStretch, 1);
    tableHeader({"Parameter", "Value", "Nearest"});
    const auto cell = [&](const volume::Channel& channel, const std::optional<double>& value) {
        ImGui::TableNextColumn();
        textRight(valueText(info, channel, value), !value);
    };
    for (std::size_t i = 0; i < readout.channels.size() && i < readout.state->values.size(); ++i) {
        const volume::Channel& channel = readout.channels[i];
        const volume::ProbeValue& value = readout.state->values[i];
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(titleWithUnit(channel.name, channel.unit).c_str());
        cell(channel, value.interpolated);
        cell(channel, value.nearest);
    }
    ImGui::EndTable();
    if (ImGui::SmallButton("Copy as CSV")) ImGui::SetClipboardText(copy().c_str());
}

std::string readoutCsv(const Session& session, const volume::DatasetInfo& info, const Readout& readout) {
    const auto number = [](const std::optional<double>& value) {
        char text[32] = "";
        if (value) std::snprintf(text, sizeof text, "%.9g", *value);
        return std::string(text);
    };
    std::string csv = "parameter,unit,interpolated,nearest\n";
    const AxisLabels labels = axisLabels(session, info);
    for (int axis = 0; axis < 3; ++axis) {
        const bool time = session.data.timeAxis && static_cast<int>(session.data.timeAxis->axis) == axis;
        const auto& [name, unit] = labels[static_cast<std::size_t>(axis)];
        csv += std::string(name) + "," + (time ? unit.name : info.lengthUnit) + "," +
               number(session.cursor[axis] * (time ? unit.perUnit : 1)) + ",\n";
    }
    csv += csvField(info.timeName) + "," + csvField(info.timeUnit) + "," + number(session.time) + ",\n";
    for (const volume::Quantity& quantity : info.quantities)
        csv += csvField(quantity.name) + "," + csvField(quantity.unit) + "," +
               number(volume::valueAt(info.times, quantity.values, session.time)) + ",\n";
    for (std::size_t i = 0; i < readout.channels.size() && i < readout.state->values.size(); ++i) {
        const volume::ProbeValue& value = readout.state->values[i];
        csv += readout.channels[i].name + "," + readout.channels[i].unit + "," + number(value.interpolated) + "," +
               number(value.nearest) + "\n";
    }
    return csv;
}

} // namespace tessera::app
