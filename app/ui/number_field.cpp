#include "app/ui/number_field.h"

#include "app/ui/ticks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <imgui.h>

namespace tessera::app {

namespace {

constexpr double kFiner = 0.1;
constexpr double kDragged = 0.004; ///< share of the span that a pixel moves a number without a range

/// The field that was clicked last: the first click of a double click moves a slider, which the second takes back.
struct ClickedField {
    ImGuiID id = 0;
    double before = 0;
};

/// The field under the hand.
struct HeldField {
    ImGuiID id = 0;
    double raw = 0;        ///< where the hand is; the number may be snapped
    bool relative = false; ///< moves by the way of the mouse instead of to its place
    bool typed = false;
    bool snapped = false; ///< what was shown last
};

/// One field; there is one mouse.
struct NumberUnderMouse {
    ClickedField clicked;
    HeldField held;
};
NumberUnderMouse& numberUnderMouse() {
    static NumberUnderMouse one;
    return one;
}

double within(double value, const NumberStyle& style) {
    return style.range ? std::clamp(value, style.range->lo, style.range->hi) : value;
}

double stepOf(double value, const NumberStyle& style) {
    if (style.logScale && value != 0) return std::pow(10, std::floor(std::log10(std::abs(value)) + 1e-9));
    const double step = niceStep(style.span, 50);
    return style.integer ? std::max(step, 1.0) : step;
}

/// A text over the field, in place of one of ImGui's.
void drawText(const std::string& format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format.c_str(), value);
    const ImVec2 lo = ImGui::GetItemRectMin(), hi = ImGui::GetItemRectMax(), size = ImGui::CalcTextSize(text);
    ImGui::GetWindowDrawList()->AddText(
        {std::round((lo.x + hi.x - size.x) / 2), std::round((lo.y + hi.y - size.y) / 2)},
        ImGui::GetColorU32(ImGuiCol_Text), text);
}

bool numberField(const char* id, double& value, const NumberStyle& style) {
    ImGuiIO& io = ImGui::GetIO();
    auto& [clicked, held] = numberUnderMouse();
    const ImGuiID self = ImGui::GetID(id);
    const double before = value;
    const float width = ImGui::CalcItemWidth();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const bool under = ImGui::IsMouseHoveringRect(corner, {corner.x + width, corner.y + ImGui::GetFrameHeight()});
    const bool types = under && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
    if (types && clicked.id == self) value = clicked.before;
    const bool dragged = held.id == self && !held.typed;
    const bool slides = style.range && !(dragged ? held.relative || io.KeyShift : under && io.KeyShift);
    const bool ctrl = io.KeyCtrl, snaps = dragged && ctrl;
    double raw = dragged ? held.raw : value;
    const char* const format = snaps ? "" : style.format.c_str(); // its text would be that of the hand's place
    ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp;
    if (style.logScale) flags |= ImGuiSliderFlags_Logarithmic;
    io.KeyCtrl = ctrl || types; // a slider takes the keyboard only by Ctrl+click
    ImGui::SetNextItemWidth(width);
    if (slides) {
        ImGui::SliderScalar(id, ImGuiDataType_Double, &raw, &style.range->lo, &style.range->hi, format, flags);
    } else {
        double speed = style.span * (style.range ? 1 / std::max(double(width), 1.0) : kDragged);
        if (io.KeyShift) speed *= kFiner / 10; // ImGui's own Shift is ten times coarser
        ImGui::DragScalar(id, ImGuiDataType_Double, &raw, static_cast<float>(speed),
                          style.range ? &style.range->lo : nullptr, style.range ? &style.range->hi : nullptr, format,
                          (style.range ? flags : ImGuiSliderFlags_None) | ImGuiSliderFlags_NoRoundToFormat);
    }
    io.KeyCtrl = ctrl;
    const bool active = ImGui::IsItemActive();
    if (ImGui::IsItemActivated()) {
        held = {self, raw, !slides && style.range, types || ctrl, false};
        if (!types) clicked = {self, before};
    }
    value = raw;
    if (dragged && active) {
        held.raw = raw;
        held.snapped = snaps;
        held.relative = held.relative || (style.range && !slides);
        if (snaps) {
            value = snappedNumber(raw, style);
            drawText(style.format, value);
        }
    } else if (!active && held.id == self) {
        if (dragged && held.snapped) value = before; // Ctrl may go up in the same frame
        held = {};
    }
    if (!active && ctrl && io.MouseWheel != 0 && ImGui::IsItemHovered()) {
        const double step = stepOf(value, style) * (io.KeyShift && !style.integer ? kFiner : 1);
        value = within(value + static_cast<double>(io.MouseWheel) * step, style);
    }
    // 1e999 is read as infinity; a drag makes NaN of that, which passes all limits.
    if (!std::isfinite(value)) value = before;
    if (style.integer && value != before) value = std::round(std::clamp(value, -2147483647.0, 2147483647.0));
    return value != before;
}

} // namespace

double snappedNumber(double value, const NumberStyle& style) {
    const double step = stepOf(value, style);
    if (!(step > 0) || !std::isfinite(value)) return value;
    // Dividing by a whole number keeps 0.3 at 0.3 instead of 0.30000000000000004.
    const double inverse = step < 1 ? std::round(1 / step) : 0;
    return within(inverse > 0 ? std::round(value * inverse) / inverse : std::round(value / step) * step, style);
}

bool numberFields(const char* id, double* values, int count, const NumberStyle& style) {
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x, whole = ImGui::CalcItemWidth();
    const float each =
        std::max(1.0f, std::floor((whole - gap * static_cast<float>(count - 1)) / static_cast<float>(count)));
    bool changed = false;
    ImGui::BeginGroup();
    ImGui::PushID(id);
    for (int i = 0; i < count; ++i) {
        if (i > 0) ImGui::SameLine(0, gap);
        ImGui::PushID(i);
        ImGui::SetNextItemWidth(i + 1 < count ? each : std::max(1.0f, whole - (each + gap) * static_cast<float>(i)));
        changed |= numberField("", values[i], style);
        ImGui::PopID();
    }
    ImGui::PopID();
    ImGui::EndGroup();
    return changed;
}

bool slider(const char* id, float& value, float lo, float hi, const char* format, ImGuiSliderFlags flags) {
    return ImGui::SliderFloat(id, &value, lo, hi, format, flags | ImGuiSliderFlags_AlwaysClamp);
}

bool slider(const char* id, int& value, int lo, int hi, const char* format) {
    return ImGui::SliderInt(id, &value, lo, hi, format, ImGuiSliderFlags_AlwaysClamp);
}

} // namespace tessera::app
