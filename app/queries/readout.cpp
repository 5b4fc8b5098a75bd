#include "app/queries/readout.h"

#include "app/data/number_origin.h"
#include "app/pane/axis_label.h"
#include "app/pane/view_parts.h"
#include "app/ui/fitted_text.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "volume/field/quantities.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <imgui.h>
#include <numeric>

namespace tessera::app {

namespace {

constexpr std::size_t kCacheBytes = std::size_t(64) << 20;

/// The region of the point by the label of a parameter's parts, else by the first label; "" if there is none.
std::string regionRow(const volume::DatasetInfo& info, const Readout& readout, int parameter) {
    const volume::Parameter& own = info.parameters[static_cast<std::size_t>(parameter)];
    if (own.categorical) return {};
    std::optional<int> label;
    if (own.parts.count() > 1) label = volume::labelChannel(info, own.parts.label);
    if (!label) label = volume::labelChannel(info);
    if (!label || static_cast<std::size_t>(*label) >= readout.values.size()) return {};
    const auto& value = readout.values[static_cast<std::size_t>(*label)].nearest;
    return value ? volume::labelName(volume::parameterOf(info, *label), static_cast<int>(std::lround(*value))) : "";
}

/// Values of a column of the table, by channel: interpolated or nearest.
TableColumn valuesColumn(TableColumn column, const volume::DatasetInfo& info, const Readout& readout,
                         std::optional<double> volume::ProbeValue::*of) {
    for (std::size_t i = 0; i < readout.channels.size() && i < readout.values.size(); ++i) {
        const volume::Channel& channel = readout.channels[i];
        const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(channel.parameter)];
        const std::optional<double> value = readout.values[i].*of;
        const Range range = info.channelRange(channel);
        column.numbers.push_back(value.value_or(std::nan("")));
        column.resolutions.push_back(parameter.categorical ? 0 : (range.hi - range.lo) / 1000);
        if (!value) column.words[i] = "absent";
        if (!value || !parameter.categorical) continue;
        for (const volume::Label& label : parameter.labels)
            if (label.value == static_cast<int>(std::lround(*value))) column.words.try_emplace(i, label.name);
    }
    return column;
}

TableColumn valuesColumn(const volume::DatasetInfo& info, const Readout& readout) {
    return valuesColumn({.name = "interpolated", .head = "Value"}, info, readout, &volume::ProbeValue::interpolated);
}

} // namespace

std::optional<double> Readout::value(const std::string& channel) const {
    for (std::size_t i = 0; i < channels.size() && i < values.size(); ++i)
        if (channels[i].name == channel) return values[i].interpolated;
    return std::nullopt;
}

void updateReadout(ViewContext& context, Readout& readout) {
    if (readout.source != context.numbers) {
        readout.source = context.numbers;
        readout.cache = std::make_shared<volume::BrickCache>(context.numbers, kCacheBytes);
        readout.channels = context.numbers->info().channels();
        readout.bounds.clear();
        readout.boundKind.clear();
        for (const volume::Channel& channel : readout.channels) {
            const auto bound = packingBound(context.origin, context.numbers->info(), channel);
            readout.bounds.push_back(bound ? bound->most : 0);
            if (bound && bound->most > 0) readout.boundKind = boundKind(*bound);
        }
    }
    const auto values = readout.answers.get(
        context, context.numbers,
        {.key = "cross-hair", .title = "Values at the cross-hair", .quiet = true, .duringEdits = true},
        {context.session.cursor, volume::timesAround(context.numbers->info().times, context.session.time)},
        [cache = readout.cache](const auto&, const Readout::Query& query, int, const Progress&) {
            return volume::probe(*cache, query.position, query.time);
        },
        [](const Readout::Query&, const Readout::Query&) { return true; });
    const std::string failure = readout.answers.failure();
    if (context.headless && !failure.empty()) throw Error(failure);
    if (values && failure.empty())
        readout.values = *values;
    else
        readout.values.clear();
}

namespace {

struct ReadoutCache : ViewCache {
    Readout readout;
    bool shared() const override { return true; }
};

} // namespace

const Readout& sharedReadout(ViewContext& context) {
    Readout& readout = cacheOf<ReadoutCache>(context, "values at the cross-hair").readout;
    updateReadout(context, readout);
    return readout;
}

std::vector<LegendEntry> withValuesAtCursor(ViewContext& context, std::vector<LegendEntry> legends) {
    if (!context.takesInput() || !context.decoration.cursor) return legends;
    for (LegendEntry& entry : legends) {
        if (!entry.glyph) continue;
        const Readout& readout = sharedReadout(context);
        entry.glyph->atCursor = !readout.values.empty();
        for (GlyphLegend::Part& part : entry.glyph->parts) part.value = readout.value(part.channel);
    }
    return legends;
}

namespace {

/// What follows from the place of the cross-hair in a plane of space and time: "t 3.20 s", "z 1.30 mm".
std::string solvedText(const Session& session, const volume::DatasetInfo& info) {
    const volume::SpaceTimePlane& plane = *info.plane;
    const glm::dvec4 point = plane.pointAt(session.cursor);
    const double extent = plane.hi[plane.solved] - plane.lo[plane.solved];
    if (!plane.hasTimeAxis())
        return timeWord(info) + " " + formatNumber(point.w, extent / 200) +
               (info.timeUnit.empty() ? "" : " " + prettyUnit(info.timeUnit));
    const LengthUnit unit = suitableLength(info.lengthUnit, extent);
    return std::string(1, "xyz"[plane.solved]) + " " +
           formatNumber(point[plane.solved] * unit.perUnit, extent / 200 * unit.perUnit) +
           (unit.name.empty() ? "" : " " + prettyUnit(unit.name));
}

/// Where the cross-hair is: "x 1.10", "y 0.900", "z 20.0 mm"; the unit once, where all three axes have the same. In a
/// plane of space and time all of x, y, z and t.
std::vector<std::string> placeTexts(const ViewContext& context) {
    const volume::DatasetInfo& info = context.numbers->info();
    const AxisLabels labels = axisLabels(context.session, info);
    std::vector<std::string> at;
    std::string unitNow;
    for (int axis = 2; axis >= 0; --axis) {
        const LengthUnit& unit = labels[static_cast<std::size_t>(axis)].unit;
        const glm::dvec3 cursor = context.session.cursor;
        std::string text =
            labels[static_cast<std::size_t>(axis)].name + " " +
            formatNumber(cursor[axis] * unit.perUnit, tellingLength(info, axis, cursor, 1.0 / 200) * unit.perUnit);
        if (unit.name != unitNow) text += " " + prettyUnit(unit.name);
        unitNow = unit.name;
        at.insert(at.begin(), text);
    }
    if (info.plane) at.push_back(solvedText(context.session, info));
    return at;
}

/// "O2 3.854 mol/m3" of every parameter that is there; names are cut off so that no text is wider than `room`.
std::vector<std::string> valueTexts(const volume::DatasetInfo& info, const Readout& readout, bool units,
                                    float room = 1e6f) {
    std::vector<std::string> values;
    const TableColumn column = valuesColumn(info, readout);
    for (std::size_t i = 0; i < column.numbers.size(); ++i) {
        const volume::Channel& channel = readout.channels[i];
        const std::optional<double>& value = readout.values[i].interpolated;
        const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(channel.parameter)];
        // Components say little beside the magnitude.
        if (!value || channel.name.find('.') != std::string::npos) continue;
        const std::string text = cellOf(column, i);
        const std::string unit = units && !channel.unit.empty() ? " " + prettyUnit(channel.unit) : std::string();
        // Labels without a name of their own are called "region 1".
        if (text.starts_with(channel.name + " ")) {
            values.push_back(text);
            continue;
        }
        const std::string bound = parameter.categorical ? "" : boundText(readout, i, false);
        const std::string number = " " + text + (bound.empty() ? "" : " " + bound) + unit,
                          cut = fitBefore(channel.name, number, room);
        values.push_back(cut.empty() ? channel.name + number : cut);
    }
    return values;
}

/// Texts in sequence; lines break between them, never within a number. `visit(text, begins)`: whether it begins a line.
void flow(const std::vector<std::string>& texts, const std::function<void(const std::string&, bool)>& visit) {
    const float gap = em() * 0.8f;
    float room = 0;
    for (const std::string& text : texts) {
        const float width = ImGui::CalcTextSize(text.c_str()).x + gap;
        const bool begins = room <= width;
        if (begins) room = ImGui::GetContentRegionAvail().x + gap;
        room -= width;
        visit(text, begins);
    }
}

int linesOf(const std::vector<std::string>& texts) {
    int lines = 0;
    flow(texts, [&](const std::string&, bool begins) { lines += begins; });
    return lines;
}

void drawFlowing(const std::vector<std::string>& texts) {
    flow(texts, [](const std::string& text, bool begins) {
        if (!begins) ImGui::SameLine(0, em() * 0.8f);
        ImGui::TextUnformatted(text.c_str());
    });
}

constexpr float kColumnWeights[] = {1.4f, 1, 1, 1};

/// How many columns of the table have room for whole names and numbers: all, those without the region, or none. What
/// labels say may be cut off.
std::size_t columnsThatFit(const volume::DatasetInfo& info, const Readout& readout,
                           const std::vector<std::vector<std::string>>& rows, std::size_t columns) {
    const float padding = 2 * ImGui::GetStyle().CellPadding.x, room = ImGui::GetContentRegionAvail().x - padding;
    for (std::size_t count = columns; count >= 3; --count) {
        const float all = std::accumulate(kColumnWeights, kColumnWeights + count, 0.0f);
        bool fits = true;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const auto parameter = static_cast<std::size_t>(readout.channels[i].parameter);
            if (info.parameters[parameter].categorical) continue;
            for (std::size_t c = 0; c < count; ++c)
                fits = fits && ImGui::CalcTextSize(rows[i][c].c_str()).x + padding <= room * kColumnWeights[c] / all;
        }
        if (fits) return count;
    }
    return 0;
}

} // namespace

std::string boundText(const Readout& readout, std::size_t channel, bool unit) {
    if (channel >= readout.bounds.size() || !(readout.bounds[channel] > 0)) return {};
    return "\u00b1 " + boundWithUnit(readout.bounds[channel], unit ? readout.channels[channel].unit : "");
}

float readoutHeight(const Readout& readout) {
    const float row = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
    return 2 * ImGui::GetTextLineHeightWithSpacing() + row * static_cast<float>(readout.channels.size() + 1);
}

std::string readoutText(const ViewContext& context, const Readout& readout) {
    std::string all;
    for (const std::string& text : placeTexts(context)) all += (all.empty() ? "" : "   ") + text;
    for (const std::string& text : valueTexts(context.numbers->info(), readout, true)) all += "\n" + text;
    if (!readout.boundKind.empty()) all += "\n\u00b1: " + readout.boundKind;
    return all;
}

void drawRunningReadout(const ViewContext& context, const Readout& readout, float height) {
    const volume::DatasetInfo& info = context.numbers->info();
    const float width = ImGui::GetContentRegionAvail().x;
    const std::vector<std::string> place = placeTexts(context), whole = valueTexts(info, readout, true, width);
    const float line = ImGui::GetTextLineHeightWithSpacing(), gap = ImGui::GetStyle().ItemSpacing.y;
    const int most = std::max(1, static_cast<int>((height + gap) / line + 0.01f));
    const bool placed = linesOf(place) + linesOf(whole) <= most;
    if (placed) drawFlowing(place);
    // What gives way: the place, the units, then values.
    std::vector<std::string> values = whole, shown = whole;
    if (!placed && linesOf(shown) > most) shown = values = valueTexts(info, readout, false, width);
    while (linesOf(shown) > most && !values.empty()) {
        values.pop_back();
        shown = values;
        shown.emplace_back("...");
    }
    const ImVec2 min = ImGui::GetCursorScreenPos();
    drawFlowing(shown);
    if (!placed || shown != valueTexts(info, readout, true))
        tellWhole(min, {min.x + width, min.y + static_cast<float>(most) * line}, readoutText(context, readout), "");
}

void drawReadout(ViewContext& context, const Readout& readout) {
    const volume::DatasetInfo& info = context.numbers->info();
    const glm::ivec3 index = info.lattice.nearest(context.session.cursor);
    const Table table = readoutTable(info, readout);
    std::vector<std::string> heads = headsOf(table);
    const std::vector<std::vector<std::string>> rows = cellsOf(table);
    const std::size_t columns = columnsThatFit(info, readout, rows, heads.size());
    if (columns == 0) return drawRunningReadout(context, readout, ImGui::GetContentRegionAvail().y);
    drawFlowing(placeTexts(context));
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

    // ImGui keeps the widths of a table: one for each number of columns.
    const std::string id = "values " + std::to_string(columns);
    if (!ImGui::BeginTable(id.c_str(), static_cast<int>(columns),
                           ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg | ImGuiTableFlags_PadOuterX))
        return;
    for (std::size_t c = 0; c < columns; ++c)
        ImGui::TableSetupColumn(heads[c].c_str(), ImGuiTableColumnFlags_WidthStretch, kColumnWeights[c]);
    heads.resize(columns);
    tableHeader(heads);
    const auto cell = [](const std::string& text, bool faint) {
        const std::string shown = fitText(text, ImGui::GetContentRegionAvail().x);
        textRight(shown, faint);
        tellWhole(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), text, shown);
    };
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const volume::ProbeValue& value = readout.values[i];
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        fittedText(rows[i][0]);
        ImGui::TableNextColumn();
        const std::string bound = value.interpolated ? boundText(readout, i, false) : "";
        const std::string both = bound.empty() ? rows[i][1] : rows[i][1] + " " + bound;
        const bool fits = ImGui::CalcTextSize(both.c_str()).x <= ImGui::GetContentRegionAvail().x;
        cell(fits ? both : rows[i][1], !value.interpolated);
        if (!bound.empty() && ImGui::IsItemHovered())
            tooltip((rows[i][1] + " " + boundText(readout, i, true) + " (" + readout.boundKind + ")").c_str());
        ImGui::TableNextColumn();
        cell(rows[i][2], !value.nearest);
        if (columns < 4) continue;
        ImGui::TableNextColumn();
        cell(rows[i][3], true);
    }
    ImGui::EndTable();
}

Table readoutTable(const volume::DatasetInfo& info, const Readout& readout) {
    Table table;
    TableColumn parameter{.name = "parameter", .head = "Parameter"}, unit{.name = "unit", .shown = false},
        region{.name = "region", .head = "Region"};
    for (std::size_t i = 0; i < readout.channels.size() && i < readout.values.size(); ++i) {
        const volume::Channel& channel = readout.channels[i];
        parameter.texts.push_back(channel.name);
        parameter.words[i] = titleWithUnit(channel.name, channel.unit);
        unit.texts.push_back(channel.unit);
        region.texts.push_back(regionRow(info, readout, channel.parameter));
    }
    table.columns = {parameter, unit, valuesColumn(info, readout),
                     valuesColumn({.name = "nearest", .head = "Nearest"}, info, readout, &volume::ProbeValue::nearest)};
    if (volume::labelChannel(info)) table.columns.push_back(region);
    return table;
}

std::string readoutCsv(const Session& session, const volume::DatasetInfo& info, const Readout& readout) {
    Table table = readoutTable(info, readout);
    std::ptrdiff_t at = 0;
    const auto put = [&](const std::string& name, const std::string& unit, double value) {
        std::vector<TableColumn>& columns = table.columns;
        columns[0].texts.insert(columns[0].texts.begin() + at, name);
        columns[1].texts.insert(columns[1].texts.begin() + at, unit);
        columns[2].numbers.insert(columns[2].numbers.begin() + at, value);
        columns[3].numbers.insert(columns[3].numbers.begin() + at, std::nan(""));
        if (columns.size() > 4) columns[4].texts.insert(columns[4].texts.begin() + at, "");
        ++at;
    };
    const glm::dvec4 point = info.pointAt(session.cursor, session.time);
    for (int axis = 0; axis < 3; ++axis) put(std::string(1, "xyz"[axis]), info.lengthUnit, point[axis]);
    put(info.timeName, info.timeUnit, point.w);
    for (const volume::Quantity& quantity : info.quantities)
        put(quantity.name, quantity.unit, volume::valueAt(info.times, quantity.values, session.time));
    if (readout.boundKind.empty()) return csvOf(table);
    TableColumn bound{.name = "error at most (" + readout.boundKind + ")", .numbers = readout.bounds};
    for (double& each : bound.numbers)
        if (!(each > 0)) each = std::nan("");
    bound.numbers.resize(readout.values.size(), std::nan(""));
    bound.numbers.insert(bound.numbers.begin(), static_cast<std::size_t>(at), std::nan(""));
    table.columns.push_back(std::move(bound));
    return csvOf(table);
}

} // namespace tessera::app
