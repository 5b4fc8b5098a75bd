#include "app/pane/plot.h"

#include "app/ui/ticks.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace tessera::app {

namespace {

float tickLength() {
    return em() * 0.3f;
}

ImU32 withAlpha(ImVec4 color, float alpha) {
    color.w = alpha;
    return ImGui::ColorConvertFloat4ToU32(color);
}

TickLabels labelsOf(Range range, int most, bool noted) {
    return noted ? tickLabels(range, most) : fullTickLabels(range, most);
}

/// As many ticks as fit without the labels touching. `noted`: numbers may be shortened, which the note says.
TickLabels ticksOn(AxisSide side, Range range, float length, bool noted, const AxisScale& scale,
                   const TickStyle& style = {}) {
    const bool bottom = side == AxisSide::Bottom;
    return scaledTicks(
        range, scale, double(length), double(em() * (bottom ? 0.9f : 0.1f)), noted,
        [&](const std::string& text) {
            const ImVec2 size = ImGui::CalcTextSize(text.c_str());
            return double(bottom ? size.x : size.y);
        },
        style);
}

} // namespace

ImVec2 PlotFrame::pixel(double px, double py) const {
    const double u = (px - x.lo) / (x.hi - x.lo), v = (py - y.lo) / (y.hi - y.lo);
    return {static_cast<float>(min.x + u * (max.x - min.x)), static_cast<float>(max.y - v * (max.y - min.y))};
}

glm::dvec2 PlotFrame::data(ImVec2 at) const {
    return {x.lo + (at.x - min.x) / std::max(1.0f, width()) * (x.hi - x.lo),
            y.lo + (max.y - at.y) / std::max(1.0f, height()) * (y.hi - y.lo)};
}

bool PlotFrame::contains(ImVec2 at) const {
    return at.x >= min.x && at.x < max.x && at.y >= min.y && at.y < max.y;
}

Range paddedRange(Range range, double share) {
    if (!std::isfinite(range.lo) || !std::isfinite(range.hi)) return {0, 1};
    if (range.hi < range.lo) std::swap(range.lo, range.hi);
    double span = range.hi - range.lo;
    const double magnitude = std::max(std::abs(range.lo), std::abs(range.hi));
    if (span <= magnitude * 1e-12) {
        const double half = magnitude > 0 ? magnitude * 0.05 : 0.5;
        return {range.lo - half, range.hi + half};
    }
    return {range.lo - span * share, range.hi + span * share};
}

std::array<ImU32, 2> sampleColors(bool dark) {
    return dark ? std::array{IM_COL32(128, 142, 160, 255), IM_COL32(255, 176, 64, 255)}
                : std::array{IM_COL32(134, 146, 162, 255), IM_COL32(214, 106, 0, 255)};
}

PlotColors plotColors() {
    const bool dark = darkTheme();
    const ImVec4 text = ImGui::GetStyleColorVec4(ImGuiCol_Text);
    PlotColors colors{};
    colors.text = withAlpha(text, 0.9f);
    colors.faint = withAlpha(text, 0.55f);
    colors.frame = withAlpha(text, 0.3f);
    colors.grid = withAlpha(text, 0.08f);
    const auto [bars, focus] = sampleColors(dark);
    colors.bars = bars;
    colors.focus = focus;
    colors.cursor = dark ? IM_COL32(94, 214, 255, 230) : IM_COL32(0, 112, 176, 230);
    colors.brush = dark ? IM_COL32(255, 196, 96, 255) : IM_COL32(176, 84, 0, 255);
    colors.brushFill = dark ? IM_COL32(255, 196, 96, 28) : IM_COL32(214, 106, 0, 26);
    colors.backdrop = dark ? IM_COL32(16, 18, 22, 190) : IM_COL32(255, 255, 255, 200);
    return colors;
}

ImU32 toColor(std::array<double, 3> srgb, double alpha) {
    const auto byte = [](double v) { return static_cast<int>(std::lround(std::clamp(v, 0.0, 1.0) * 255)); };
    return IM_COL32(byte(srgb[0]), byte(srgb[1]), byte(srgb[2]), byte(alpha));
}

float axisRoom(AxisSide side, Range range, TitlePlace title, const AxisScale& scale) {
    float room = tickLength() + em() * 0.2f;
    if (side == AxisSide::Bottom)
        room += em();
    else {
        float widest = 0;
        if (!scale.isEven())
            for (const float length : {50.0f, 25.0f, 12.0f})
                for (const std::string& text : ticksOn(side, range, em() * length, true, scale).texts)
                    widest = std::max(widest, ImGui::CalcTextSize(text.c_str()).x);
        else
            for (int most : {10, 5, 3})
                for (const std::string& text : labelsOf(range, most, title != TitlePlace::Nowhere).texts)
                    widest = std::max(widest, ImGui::CalcTextSize(text.c_str()).x);
        room += widest;
    }
    return std::ceil(room + (title == TitlePlace::Beside ? em() * 1.3f : 0.0f));
}

std::string axisNote(AxisSide side, Range range, float length, const AxisScale& scale) {
    return ticksOn(side, range, length, true, scale).note;
}

ColumnHeights columnHeights(float room, std::size_t plots) {
    const float count = std::max(1.0f, static_cast<float>(plots)), gap = em() * 0.4f;
    ColumnHeights out{};
    out.bottom = axisRoom(AxisSide::Bottom, {0, 1}, TitlePlace::Beside);
    out.titled = room >= out.bottom + gap + em() * 2.6f * count;
    if (!out.titled) out.bottom = axisRoom(AxisSide::Bottom, {0, 1}, TitlePlace::Elsewhere);
    out.all = std::max(room, out.bottom + gap + em() * 2.4f * count);
    out.each = (out.all - out.bottom - gap) / count;
    return out;
}

void drawAxis(ImDrawList& draw, const PlotFrame& frame, AxisSide side, std::string_view title, std::string_view unit,
              float lo, float hi, const AxisOptions& options) {
    const bool bottom = side == AxisSide::Bottom;
    const Range range = bottom ? frame.x : frame.y;
    const bool titled = !title.empty() || !unit.empty();
    const TickLabels ticks = ticksOn(side, range, bottom ? frame.width() : frame.height(),
                                     titled || options.noteElsewhere, options.scale, options.ticks);
    PlotColors colors = plotColors();
    if (options.ink != 0) colors.text = colors.faint = options.ink;
    // If not all fits: the note comes first, since the numbers are wrong without it; then the unit and what it leaves
    // of the title, if that is more than a few letters; then the title alone.
    const std::string note = ticks.note.empty() ? "" : "  " + ticks.note;
    const float length = bottom || !options.inlineTitle ? hi - lo : 1e6f;
    std::string label;
    const std::string whole = titleWithUnit(title, unit) + note;
    constexpr std::size_t kFewLetters = 6; // three of them dots
    const std::string end = whole.substr(title.size()), cut = fitBefore(title, end, length);
    for (const std::string& text :
         {whole, cut.size() > end.size() + kFewLetters ? cut : std::string(title) + note, std::string(title) + note,
          cut, ticks.note.empty() ? fitText(title, length) : ticks.note}) {
        label = text;
        if (!label.empty() && ImGui::CalcTextSize(label.c_str()).x <= length) break;
    }
    const float taken = options.inlineTitle && bottom ? ImGui::CalcTextSize(label.c_str()).x + em() * 0.5f : 0;
    float previousEnd = -1e9f, above = 1e9f, widest = 0; // of the last number below, and beside
    for (std::size_t i = 0; i < ticks.values.size(); ++i) {
        const ImVec2 size = ImGui::CalcTextSize(ticks.texts[i].c_str());
        widest = std::max(widest, size.x);
        if (bottom) {
            const float at = std::round(frame.pixel(ticks.values[i], frame.y.lo).x) + 0.5f;
            if (options.grid) draw.AddLine({at, frame.min.y}, {at, frame.max.y}, colors.grid);
            draw.AddLine({at, frame.max.y}, {at, frame.max.y + tickLength()}, colors.frame);
            const float left = std::max(lo, std::min(at - size.x / 2, hi - size.x));
            if (left < previousEnd || left + size.x > hi - taken + 0.5f) continue;
            draw.AddText({std::round(left), frame.max.y + tickLength() + em() * 0.1f}, colors.text,
                         ticks.texts[i].c_str());
            previousEnd = left + size.x + em() * 0.4f;
        } else {
            const float at = std::round(frame.pixel(frame.x.lo, ticks.values[i]).y) + 0.5f;
            if (options.grid) draw.AddLine({frame.min.x, at}, {frame.max.x, at}, colors.grid);
            draw.AddLine({frame.min.x - tickLength(), at}, {frame.min.x, at}, colors.frame);
            const float top = std::max(lo, std::min(at - size.y / 2, hi - size.y));
            if (top + size.y > above + 0.5f) continue;
            above = top;
            draw.AddText({std::round(frame.min.x - tickLength() - em() * 0.15f - size.x), std::round(top)}, colors.text,
                         ticks.texts[i].c_str());
        }
    }
    if (!titled) return;
    const ImVec2 size = ImGui::CalcTextSize(label.c_str());
    if (options.inlineTitle) {
        const ImVec2 at =
            bottom ? ImVec2{hi - size.x, frame.max.y + tickLength() + em() * 0.1f}
                   : ImVec2{frame.min.x - (options.room > 0 ? options.room : size.x), frame.min.y - em() * kTitleAbove};
        draw.AddText({std::round(at.x), std::round(at.y)}, colors.faint, label.c_str());
        tellWhole(at, {at.x + size.x, at.y + size.y}, whole, label);
        return;
    }
    const auto centred = [&](float middle) { return std::max(lo + size.x / 2, std::min(middle, hi - size.x / 2)); };
    if (bottom) {
        const float x = centred((frame.min.x + frame.max.x) / 2) - size.x / 2;
        const float y = frame.max.y + tickLength() + em() * 1.15f;
        draw.AddText({std::round(x), y}, colors.faint, label.c_str());
        tellWhole({x, y}, {x + size.x, y + size.y}, whole, label);
    } else {
        const float x = options.room > 0 ? frame.min.x - options.room + em() * 0.6f
                                         : frame.min.x - tickLength() - em() * 0.9f - widest;
        addTextUpwards(draw, {x, centred((frame.min.y + frame.max.y) / 2)}, colors.faint, label.c_str());
    }
}

void drawRightAxis(ImDrawList& draw, const PlotFrame& frame, std::string_view title, std::string_view unit, float room,
                   ImU32 ink) {
    const TickLabels ticks = ticksOn(AxisSide::Left, frame.y, frame.height(), true, {});
    const ImU32 color = ink != 0 ? ink : plotColors().text;
    for (std::size_t i = 0; i < ticks.values.size(); ++i) {
        const float at = std::round(frame.pixel(frame.x.hi, ticks.values[i]).y) + 0.5f, half = em() / 2;
        draw.AddLine({frame.max.x, at}, {frame.max.x + tickLength(), at}, plotColors().frame);
        const float top = std::max(frame.min.y - em() * 0.3f, std::min(at - half, frame.max.y - em() * 0.7f));
        draw.AddText({std::round(frame.max.x + tickLength() + em() * 0.15f), std::round(top)}, color,
                     ticks.texts[i].c_str());
    }
    const std::string whole = titleWithUnit(title, unit) + (ticks.note.empty() ? "" : "  " + ticks.note);
    const std::string label = fitText(whole, frame.height());
    addTextUpwards(draw, {frame.max.x + room - em() * 0.6f, (frame.min.y + frame.max.y) / 2}, color, label.c_str());
}

namespace {

/// Text centred at a point. `turn` maps each offset from the centre, which is on whole pixels.
template <class Turn> void addMoved(ImDrawList& draw, ImVec2 center, ImU32 color, const char* text, const Turn& turn) {
    const ImVec2 size = ImGui::CalcTextSize(text);
    const ImVec2 origin{std::round(center.x - size.x / 2), std::round(center.y - size.y / 2)};
    const ImVec2 middle{origin.x + std::floor(size.x / 2), origin.y + std::floor(size.y / 2)};
    const int first = draw.VtxBuffer.Size;
    // Not AddText: it drops glyphs outside of the clip rectangle before they are rotated.
    ImGui::GetFont()->RenderText(&draw, ImGui::GetFontSize(), origin, color, ImVec4(-1e6f, -1e6f, 1e6f, 1e6f), text,
                                 text + std::strlen(text));
    for (int i = first; i < draw.VtxBuffer.Size; ++i) {
        ImVec2& p = draw.VtxBuffer[i].pos;
        p = turn(middle, ImVec2{p.x - middle.x, p.y - middle.y});
    }
}

} // namespace

void addTextTurned(ImDrawList& draw, ImVec2 center, float angle, ImU32 color, const char* text) {
    const float c = std::cos(angle), s = std::sin(angle);
    addMoved(draw, center, color, text, [&](ImVec2, ImVec2 d) {
        return ImVec2{center.x + c * d.x - s * d.y, center.y + s * d.x + c * d.y};
    });
}

void addTextUpwards(ImDrawList& draw, ImVec2 center, ImU32 color, const char* text) {
    addMoved(draw, center, color, text, [](ImVec2 middle, ImVec2 d) { return ImVec2{middle.x + d.y, middle.y - d.x}; });
}

void addTextWithBackdrop(ImDrawList& draw, ImVec2 at, ImVec2 pivot, ImU32 color, const char* text) {
    const ImVec2 size = ImGui::CalcTextSize(text);
    const ImVec2 from{std::round(at.x - size.x * pivot.x), std::round(at.y - size.y * pivot.y)};
    const float pad = em() * 0.2f;
    draw.AddRectFilled({from.x - pad, from.y - pad * 0.4f}, {from.x + size.x + pad, from.y + size.y + pad * 0.4f},
                       plotColors().backdrop, em() * 0.2f);
    draw.AddText(from, color, text);
}

void addFittedWithBackdrop(ImDrawList& draw, ImVec2 at, ImVec2 pivot, ImU32 color, const std::string& text,
                           float width) {
    const std::string shown = fitText(text, width);
    addTextWithBackdrop(draw, at, pivot, color, shown.c_str());
    const ImVec2 size = ImGui::CalcTextSize(shown.c_str());
    const ImVec2 from{at.x - size.x * pivot.x, at.y - size.y * pivot.y};
    tellWhole(from, {from.x + size.x, from.y + size.y}, text, shown);
}

void drawBars(ImDrawList& draw, const PlotFrame& frame, std::span<const float> heights, ImU32 color) {
    const float step = frame.width() / static_cast<float>(std::max<std::size_t>(1, heights.size()));
    for (std::size_t i = 0; i < heights.size(); ++i) {
        if (heights[i] <= 0) continue;
        const float left = std::round(frame.min.x + step * static_cast<float>(i));
        const float right = std::round(frame.min.x + step * static_cast<float>(i + 1));
        // Bars above 0 are at least visible.
        const float top = std::min(frame.max.y - 1, frame.max.y - std::min(1.0f, heights[i]) * frame.height());
        draw.AddRectFilled({left, top}, {std::max(right, left + 1), frame.max.y}, color);
    }
}

void drawCrosshair(ImDrawList& draw, const PlotFrame& frame, double x, double y, bool onPicture) {
    const ImU32 color = plotColors().cursor, rim = (plotColors().backdrop & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 80);
    const bool hasX = x >= frame.x.lo && x <= frame.x.hi, hasY = y >= frame.y.lo && y <= frame.y.hi;
    const ImVec2 at = frame.pixel(hasX ? x : frame.x.lo, hasY ? y : frame.y.lo);
    const float px = std::round(at.x) + 0.5f, py = std::round(at.y) + 0.5f;
    if (hasX && onPicture) draw.AddLine({px, frame.min.y}, {px, frame.max.y}, rim, 3);
    if (hasY && onPicture) draw.AddLine({frame.min.x, py}, {frame.max.x, py}, rim, 3);
    if (hasX) draw.AddLine({px, frame.min.y}, {px, frame.max.y}, color);
    if (hasY) draw.AddLine({frame.min.x, py}, {frame.max.x, py}, color);
    if (hasX && hasY) draw.AddCircleFilled({px, py}, em() * 0.2f, color);
}

int densityImage(std::span<const std::uint64_t> counts, std::span<const double> focus, int size, int merge,
                 bool logDensity, bool dark, ImU32 focusColor, std::vector<std::uint8_t>& rgba) {
    const auto bins = static_cast<std::size_t>(size), step = static_cast<std::size_t>(std::max(1, merge));
    const std::size_t n = (bins + step - 1) / step;
    std::vector<double> sums(n * n), focused(focus.empty() ? 0 : n * n);
    for (std::size_t row = 0; row < bins; ++row)
        for (std::size_t column = 0; column < bins; ++column) {
            const std::size_t to = row / step * n + column / step;
            sums[to] += static_cast<double>(counts[row * bins + column]);
            if (!focus.empty()) focused[to] += focus[row * bins + column];
        }
    rgba.assign(n * n * 4, 0);
    const double most = *std::max_element(sums.begin(), sums.end());
    if (most <= 0) return static_cast<int>(n);
    // Context is grey-blue and focus a strong colour, so that they differ in lightness as well as hue.
    const std::array<double, 3> context = dark ? std::array{138.0, 156.0, 180.0} : std::array{92.0, 106.0, 128.0};
    const std::array<double, 3> hot{double(focusColor >> IM_COL32_R_SHIFT & 255),
                                    double(focusColor >> IM_COL32_G_SHIFT & 255),
                                    double(focusColor >> IM_COL32_B_SHIFT & 255)};
    const std::array<double, 3> plain = dark ? std::array{150.0, 196.0, 236.0} : std::array{28.0, 92.0, 158.0};
    for (std::size_t row = 0; row < n; ++row)
        for (std::size_t column = 0; column < n; ++column) {
            const double count = sums[row * n + column];
            if (count <= 0) continue;
            const double share = logDensity ? std::log1p(count) / std::log1p(most) : count / most;
            double alpha = 0.35 + 0.65 * share;
            std::array<double, 3> color = plain;
            if (!focus.empty()) {
                const double doi = std::clamp(focused[row * n + column] / count, 0.0, 1.0);
                // A few focus samples among many must still show: the square root lifts small shares.
                const double mix = std::sqrt(doi);
                for (std::size_t k = 0; k < 3; ++k) color[k] = context[k] + (hot[k] - context[k]) * mix;
                alpha = doi > 0 ? std::max(alpha, 0.35 + 0.65 * mix * share) : alpha * 0.6;
            }
            std::uint8_t* pixel = &rgba[((n - 1 - row) * n + column) * 4];
            for (std::size_t k = 0; k < 3; ++k) pixel[k] = static_cast<std::uint8_t>(color[k]);
            pixel[3] = static_cast<std::uint8_t>(std::lround(255 * alpha));
        }
    return static_cast<int>(n);
}

} // namespace tessera::app
