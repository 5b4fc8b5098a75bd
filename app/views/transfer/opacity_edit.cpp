#include "app/views/transfer/opacity_edit.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

ImVec2 pixelOf(glm::vec2 point, const PlotFrame& frame, Range range) {
    return frame.pixel(range.lo + static_cast<double>(point.x) * (range.hi - range.lo), static_cast<double>(point.y));
}

glm::vec2 pointAt(ImVec2 at, const PlotFrame& frame, Range range) {
    const glm::dvec2 value = frame.data(at);
    const double span = range.hi - range.lo;
    return {span > 0 ? std::clamp((value.x - range.lo) / span, 0.0, 1.0) : 0.0, std::clamp(value.y, 0.0, 1.0)};
}

/// Where point `index` goes when the mouse is at a pixel: within what `drag` allows, and snapped.
Snap snappedAt(const OpacityDrag& drag, const std::vector<glm::vec2>& curve, std::size_t index, ImVec2 mouse,
               const PlotFrame& frame, Range range, std::span<const double> peaks) {
    glm::dvec2 at(pointAt(mouse, frame, range));
    at.x = std::clamp(at.x, drag.left, drag.right);
    const ImGuiIO& io = ImGui::GetIO();
    if (io.KeyCtrl || io.KeyAlt) return {at, {}, {}};
    const double pixels = std::max(4.0, double(em()) * 0.4), span = std::max(range.hi - range.lo, 1e-300);
    SnapLines lines = snapLines(curve, index, peaks);
    std::erase_if(lines.positions, [&](double line) { return line < drag.left || line > drag.right; });
    // The axis catches all that is too thin to be meant, however tall the plot is.
    const double least = std::max(pixels * frame.perPixelY(), at.y < 0.01 ? 0.01 : 0.0);
    return snapped(at, lines, {pixels * frame.perPixelX() / span, least});
}

} // namespace

std::vector<glm::vec2> opacityPreset(OpacityPreset preset) {
    switch (preset) {
    case OpacityPreset::Ramp:
        break;
    case OpacityPreset::Tent:
        return {{0, 0}, {0.35f, 0}, {0.5f, 0.8f}, {0.65f, 0}, {1, 0}};
    case OpacityPreset::Step:
        return {{0, 0}, {0.5f, 0}, {0.5f, 0.8f}, {1, 0.8f}};
    case OpacityPreset::Constant:
        return {{0, 0.3f}, {1, 0.3f}};
    }
    return {{0, 0}, {1, 0.8f}};
}

int hitPoint(const std::vector<glm::vec2>& curve, const PlotFrame& frame, Range range, ImVec2 at) {
    int best = -1;
    float nearest = std::max(6.0f, em() * 0.6f);
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const ImVec2 p = pixelOf(curve[i], frame, range);
        const float distance = std::hypot(p.x - at.x, p.y - at.y);
        if (distance < nearest) {
            nearest = distance;
            best = static_cast<int>(i);
        }
    }
    return best;
}

bool editOpacity(OpacityDrag& drag, std::vector<glm::vec2>& curve, const PlotFrame& frame, Range range,
                 std::span<const double> peaks) {
    const std::vector<glm::vec2> before = curve;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const bool hovered = ImGui::IsItemHovered();
    const int under = hovered ? hitPoint(curve, frame, range, mouse) : -1;
    if (under >= 0) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    const bool remove =
        hovered && under >= 0 &&
        (ImGui::IsMouseClicked(ImGuiMouseButton_Right) || ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left));
    if (remove) {
        if (curve.size() > 2) curve.erase(curve.begin() + under);
        drag = {};
    } else if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        int held = under;
        if (held < 0) {
            const glm::vec2 point = pointAt(mouse, frame, range);
            const auto place =
                std::upper_bound(curve.begin(), curve.end(), point, [](glm::vec2 a, glm::vec2 b) { return a.x < b.x; });
            held = static_cast<int>(place - curve.begin());
            curve.insert(place, point);
        }
        const auto index = static_cast<std::size_t>(held);
        drag = {held,
                index > 0 ? double(curve[index - 1].x) : 0.0,
                index + 1 < curve.size() ? double(curve[index + 1].x) : 1.0,
                {glm::dvec2(curve[index]), {}, {}}};
        if (under < 0) {
            drag.snap = snappedAt(drag, curve, index, mouse, frame, range, peaks);
            curve[index] = glm::vec2(drag.snap.at);
        }
    }
    if (drag.point >= static_cast<int>(curve.size()) || !ImGui::IsMouseDown(ImGuiMouseButton_Left)) drag.point = -1;
    if (drag.point >= 0 && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 2)) {
        const auto index = static_cast<std::size_t>(drag.point);
        drag.snap = snappedAt(drag, curve, index, mouse, frame, range, peaks);
        curve[index] = glm::vec2(drag.snap.at);
    }
    return curve != before;
}

void drawSnapLines(ImDrawList& draw, const OpacityDrag& drag, const PlotFrame& frame, Range range) {
    if (drag.point < 0) return;
    const ImU32 color = plotColors().focus;
    const ImVec2 at = pixelOf(glm::vec2(drag.snap.at), frame, range);
    if (drag.snap.height) draw.AddLine({frame.min.x, at.y}, {frame.max.x, at.y}, color);
    if (drag.snap.position) draw.AddLine({at.x, frame.min.y}, {at.x, frame.max.y}, color);
}

void drawOpacity(ImDrawList& draw, const std::vector<glm::vec2>& curve, const PlotFrame& frame, Range range, int lit) {
    if (curve.empty()) return;
    const PlotColors colors = plotColors();
    std::vector<ImVec2> line;
    for (glm::vec2 point : curve) line.push_back(pixelOf(point, frame, range));
    // Beyond its ends the curve goes on level, as far as the plot shows.
    line.insert(line.begin(), {std::min(frame.min.x, line.front().x), line.front().y});
    line.push_back({std::max(frame.max.x, line.back().x), line.back().y});
    draw.AddPolyline(line.data(), static_cast<int>(line.size()), colors.backdrop, 0, em() * 0.35f);
    draw.AddPolyline(line.data(), static_cast<int>(line.size()), colors.text, 0, std::max(1.5f, em() * 0.13f));
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const ImVec2 at = pixelOf(curve[i], frame, range);
        const float radius = em() * (static_cast<int>(i) == lit ? 0.4f : 0.3f);
        draw.AddCircleFilled(at, radius, static_cast<int>(i) == lit ? colors.focus : colors.text, 16);
        draw.AddCircle(at, radius, colors.backdrop, 16, 1.5f);
    }
}

} // namespace tessera::app
