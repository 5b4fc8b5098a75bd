#include "app/pane/legend.h"

#include "app/ui/ticks.h"
#include "vis/transfer/region_guess.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera::app {

namespace {

constexpr int kStripParts = 64;

/// An arrow head in the end colour: the data extend beyond the bar.
void drawArrow(ImDrawList& draw, ImVec2 at, float size, float direction, ImU32 color) {
    draw.AddTriangleFilled({at.x, at.y}, {at.x, at.y + size}, {at.x + direction * size * 0.6f, at.y + size / 2}, color);
}

float drawSwatch(ImDrawList& draw, ImVec2 min, float width, const LegendEntry& entry) {
    const PlotColors colors = plotColors();
    const float size = legendStripHeight();
    draw.AddRectFilled({min.x, min.y + em() * 0.25f}, {min.x + size, min.y + em() * 0.25f + size},
                       toColor(entry.color));
    draw.AddRect({min.x, min.y + em() * 0.25f}, {min.x + size, min.y + em() * 0.25f + size}, colors.frame);
    const double resolution = (entry.data.hi - entry.data.lo) / 1000;
    const std::string value = " = " + formatQuantity(entry.value, entry.unit, resolution), text = entry.title + value;
    const ImVec2 at{min.x + size + em() * 0.5f, min.y};
    const float room = width - size - em() * 0.5f;
    const std::string cut = fitBefore(entry.title, value, room), shown = cut.empty() ? fitText(text, room) : cut;
    draw.AddText(at, colors.text, shown.c_str());
    tellWhole(at, {at.x + room, at.y + em()}, text, shown);
    return em() * 1.25f;
}

} // namespace

float legendStripHeight() {
    return std::round(em() * 0.65f);
}

void drawColorStrip(ImDrawList& draw, ImVec2 min, ImVec2 max, const vis::TransferFunction& function, bool withOpacity,
                    Range range) {
    const PlotColors colors = plotColors();
    if (withOpacity) {
        const float cell = std::max(3.0f, (max.y - min.y) / 3);
        for (float y = min.y; y < max.y; y += cell)
            for (float x = min.x; x < max.x; x += cell) {
                const bool odd = (static_cast<int>((x - min.x) / cell) + static_cast<int>((y - min.y) / cell)) & 1;
                draw.AddRectFilled({x, y}, {std::min(x + cell, max.x), std::min(y + cell, max.y)},
                                   odd ? IM_COL32(150, 150, 150, 255) : IM_COL32(200, 200, 200, 255));
            }
    }
    const auto color = [&](int i) {
        const double value = std::lerp(range.lo, range.hi, static_cast<double>(i) / kStripParts);
        const glm::dvec4 c = vis::evaluate(function, range, value);
        return toColor({c.r, c.g, c.b}, withOpacity ? c.a : 1);
    };
    for (int i = 0; i < kStripParts; ++i) {
        const auto x = [&](int k) { return min.x + (max.x - min.x) * static_cast<float>(k) / kStripParts; };
        draw.AddRectFilledMultiColor({x(i), min.y}, {x(i + 1), max.y}, color(i), color(i + 1), color(i + 1), color(i));
    }
    draw.AddRect(min, max, colors.frame);
}

void drawRegionStrip(ImDrawList& draw, ImVec2 min, ImVec2 max, const vis::TransferFunction& function) {
    for (int i = 0; i < kStripParts; ++i) {
        const auto x = [&](int k) { return min.x + (max.x - min.x) * static_cast<float>(k) / kStripParts; };
        const glm::dvec4 shown = vis::shownAs(function, {0, 1}, (i + 0.5) / kStripParts);
        if (shown.a > 0) draw.AddRectFilled({x(i), min.y}, {x(i + 1), max.y}, toColor({shown.r, shown.g, shown.b}));
    }
    draw.AddRect(min, max, plotColors().frame);
}

void drawOpacityStrip(ImDrawList& draw, ImVec2 min, ImVec2 max, const vis::TransferFunction& function) {
    const PlotColors colors = plotColors();
    std::array<double, kStripParts + 1> opacity{};
    for (int i = 0; i <= kStripParts; ++i)
        opacity[static_cast<std::size_t>(i)] = vis::shownAs(function, {0, 1}, static_cast<double>(i) / kStripParts).a;
    const double most = *std::max_element(opacity.begin(), opacity.end());
    const ImVec4 ink = ImGui::ColorConvertU32ToFloat4(colors.text);
    const auto color = [&](int i) {
        const double share = most > 0 ? opacity[static_cast<std::size_t>(i)] / most : 0;
        return toColor({ink.x, ink.y, ink.z}, share);
    };
    for (int i = 0; i < kStripParts; ++i) {
        const auto x = [&](int k) { return min.x + (max.x - min.x) * static_cast<float>(k) / kStripParts; };
        draw.AddRectFilledMultiColor({x(i), min.y}, {x(i + 1), max.y}, color(i), color(i + 1), color(i + 1), color(i));
    }
    draw.AddRect(min, max, colors.frame);
}

void drawLegendStrip(ImDrawList& draw, ImVec2 lo, ImVec2 hi, const LegendEntry& entry) {
    if (entry.opacity)
        drawOpacityStrip(draw, lo, hi, entry.function);
    else if (entry.regions)
        drawRegionStrip(draw, lo, hi, entry.function);
    else
        drawColorStrip(draw, lo, hi, entry.function, false, entry.names.empty() ? Range{0, 1} : entry.range);
}

float legendArrow() {
    return legendStripHeight() * 0.6f + 1;
}

bool beyondLegend(const LegendEntry& entry, bool high) {
    const double slack = (entry.range.hi - entry.range.lo) * 1e-6;
    return high ? entry.data.hi > entry.range.hi + slack : entry.data.lo < entry.range.lo - slack;
}

void drawLegendArrows(ImDrawList& draw, ImVec2 lo, ImVec2 hi, const LegendEntry& entry) {
    const auto end = [&](double x) {
        const glm::dvec4 c = vis::evaluate(entry.function, {0, 1}, x);
        return entry.opacity || entry.regions ? plotColors().frame : toColor({c.r, c.g, c.b});
    };
    const float height = hi.y - lo.y;
    if (beyondLegend(entry, false)) drawArrow(draw, {lo.x - 1, lo.y}, height, -1, end(0));
    if (beyondLegend(entry, true)) drawArrow(draw, {hi.x + 1, lo.y}, height, 1, end(1));
}

void drawLegendMarker(ImDrawList& draw, const PlotFrame& frame, const LegendEntry& entry) {
    if (!entry.marker || *entry.marker < frame.x.lo || *entry.marker > frame.x.hi) return;
    const float x = std::round(frame.pixel(*entry.marker, 0).x) + 0.5f, over = em() * 0.15f;
    draw.AddLine({x, frame.min.y - over}, {x, frame.max.y + over}, plotColors().backdrop, 3);
    draw.AddLine({x, frame.min.y - over}, {x, frame.max.y + over}, plotColors().cursor);
}

float legendBarHeight() {
    return legendStripHeight() + em() * 2.75f;
}

float drawLegendBar(ImDrawList& draw, ImVec2 min, float width, const LegendEntry& entry) {
    const float arrow = legendArrow();
    const ImVec2 lo{min.x + arrow, min.y + em() * 0.2f}, hi{min.x + width - arrow, lo.y + legendStripHeight()};
    drawLegendStrip(draw, lo, hi, entry);
    drawLegendArrows(draw, lo, hi, entry);
    const PlotFrame frame{lo, hi, paddedRange(entry.range), {0, 1}};
    drawAxis(draw, frame, AxisSide::Bottom, entry.title, entry.unit, min.x, min.x + width);
    drawLegendMarker(draw, frame, entry);
    return legendBarHeight();
}

void legendBarItem(const LegendEntry& entry, bool shown) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = std::min(ImGui::GetContentRegionAvail().x, em() * 20);
    const float height = shown ? drawLegendBar(*ImGui::GetWindowDrawList(), at, width, entry) : legendBarHeight();
    ImGui::Dummy({width, height + em() * 0.3f});
}

namespace {

/// The value of an end of an upright bar.
std::string columnEnd(const LegendEntry& entry, bool high) {
    const Range range = paddedRange(entry.range);
    return formatNumber(high ? range.hi : range.lo, (range.hi - range.lo) / 100);
}

constexpr float kColumn = 0.6f, kColumnGap = 0.3f; // em: the strip, and what parts it from its numbers

} // namespace

float legendColumnWidth(const LegendEntry& entry) {
    const auto width = [&](bool high) { return ImGui::CalcTextSize(columnEnd(entry, high).c_str()).x; };
    return em() * (kColumn + kColumnGap) + std::max(width(false), width(true));
}

void drawLegendColumn(ImDrawList& draw, ImVec2 min, float height, const LegendEntry& entry) {
    const float width = em() * kColumn, line = ImGui::GetFontSize();
    const int steps = std::max(1, static_cast<int>(height));
    for (int i = 0; i < steps; ++i) {
        const Range range = paddedRange(entry.range);
        const glm::dvec4 c = vis::evaluate(entry.function, range, std::lerp(range.hi, range.lo, (i + 0.5) / steps));
        const float y = min.y + height * static_cast<float>(i) / static_cast<float>(steps);
        draw.AddRectFilled({min.x, y}, {min.x + width, y + height / static_cast<float>(steps)},
                           toColor({c.r, c.g, c.b}));
    }
    if (height < 2 * line) return; // no room for both values
    const PlotColors colors = plotColors();
    const float x = min.x + width + em() * kColumnGap;
    draw.AddText({x, min.y}, colors.text, columnEnd(entry, true).c_str());
    draw.AddText({x, min.y + height - line}, colors.text, columnEnd(entry, false).c_str());
}

namespace {

constexpr std::size_t kMostNames = 12;

/// The title of a label, and under it its values with their colours.
float drawNames(ImDrawList& draw, ImVec2 min, float width, const LegendEntry& entry) {
    const PlotColors colors = plotColors();
    const float line = em() * 1.2f;
    addFittedText(draw, min, colors.text, entry.title, width);
    float y = min.y + line;
    for (std::size_t i = 0; i < entry.names.size() && i < kMostNames; ++i, y += line) {
        const glm::vec3 color = entry.names[i].color;
        draw.AddRectFilled({min.x, y + em() * 0.15f}, {min.x + em() * 0.8f, y + em() * 0.9f},
                           toColor({color.r, color.g, color.b}));
        const bool more = i + 1 == kMostNames && entry.names.size() > kMostNames;
        addFittedText(draw, {min.x + em() * 1.1f, y}, colors.text, more ? "..." : entry.names[i].name,
                      width - em() * 1.1f);
    }
    return y - min.y;
}

} // namespace

float legendHeight(const LegendEntry& entry) {
    if (entry.glyph) return glyphLegendHeight(*entry.glyph);
    if (!entry.names.empty()) return em() * 1.2f * static_cast<float>(1 + std::min(entry.names.size(), kMostNames));
    return entry.swatch ? em() * 1.25f : legendBarHeight();
}

float drawLegend(ImDrawList& draw, ImVec2 min, float width, const LegendEntry& entry) {
    if (entry.glyph) return drawGlyphLegend(draw, min, width, entry.title, *entry.glyph);
    if (!entry.names.empty()) return drawNames(draw, min, width, entry);
    return entry.swatch ? drawSwatch(draw, min, width, entry) : drawLegendBar(draw, min, width, entry);
}

namespace {

/// Visits the legends of drawLegendRows that fit, with their places; returns the height of their rows.
template <class Visit>
float layRows(const std::vector<LegendEntry>& entries, float width, float most, const Visit& visit) {
    const float gap = em();
    const auto fit =
        std::clamp<std::size_t>(static_cast<std::size_t>(std::max(0.0f, (width + gap) / (em() * 10 + gap))), 1,
                                std::max<std::size_t>(entries.size(), 1));
    const float own = std::min(em() * 15, (width - gap * static_cast<float>(fit - 1)) / static_cast<float>(fit));
    float y = 0;
    for (std::size_t first = 0; first < entries.size(); first += fit) {
        const std::size_t end = std::min(first + fit, entries.size());
        float height = 0;
        for (std::size_t i = first; i < end; ++i) height = std::max(height, legendHeight(entries[i]));
        if (y + height > most) break;
        for (std::size_t i = first; i < end; ++i)
            visit(entries[i], ImVec2{(own + gap) * static_cast<float>(i - first), y}, own);
        y += height;
    }
    return y;
}

} // namespace

float legendRowsHeight(const std::vector<LegendEntry>& entries, float width, float most) {
    return layRows(entries, width, most, [](const LegendEntry&, ImVec2, float) {});
}

void drawLegendRows(ImDrawList& draw, const std::vector<LegendEntry>& entries, ImVec2 min, float width, float most) {
    layRows(entries, width, most, [&](const LegendEntry& entry, ImVec2 at, float own) {
        drawLegend(draw, {min.x + at.x, min.y + at.y}, own, entry);
    });
}

PlotColorKey colorKey(const vis::TransferFunction& function, Range range) {
    constexpr int kSteps = 256;
    const double digits = (range.hi - range.lo) / 100;
    PlotColorKey key{.rgba = {}, .highest = formatNumber(range.hi, digits), .lowest = formatNumber(range.lo, digits)};
    for (int i = 0; i < kSteps; ++i) {
        const glm::dvec4 color = vis::evaluate(function, range, std::lerp(range.hi, range.lo, (i + 0.5) / kSteps));
        for (int k = 0; k < 3; ++k)
            key.rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * std::clamp(color[k], 0.0, 1.0))));
        key.rgba.push_back(255);
    }
    return key;
}

} // namespace tessera::app
