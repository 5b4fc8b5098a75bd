#include "app/views/brush_edit.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tessera::app {

namespace {

const vis::BrushInterval* intervalOf(const vis::Brush& brush, const std::string& channel) {
    for (const vis::BrushInterval& interval : brush.intervals)
        if (interval.channel == channel) return &interval;
    return nullptr;
}

struct Rect {
    ImVec2 min, max;
    bool bandX = false, bandY = false; ///< no interval on that axis: the brush runs through the whole plot
};

/// Pixels of a brush, grown by its soft edge times `soft`.
Rect rectOf(const vis::Brush& brush, const PlotFrame& frame, const PlotChannels& plot, double soft) {
    const vis::BrushInterval* x = intervalOf(brush, plot.x);
    const vis::BrushInterval* y = plot.y.empty() ? nullptr : intervalOf(brush, plot.y);
    const ImVec2 low = frame.pixel(x ? x->lo - soft * x->soft : frame.x.lo, y ? y->lo - soft * y->soft : frame.y.lo);
    const ImVec2 high = frame.pixel(x ? x->hi + soft * x->soft : frame.x.hi, y ? y->hi + soft * y->soft : frame.y.hi);
    return {{low.x, high.y}, {high.x, low.y}, x == nullptr, y == nullptr};
}

float reach() {
    return std::max(4.0f, em() * 0.35f);
}

/// One side of a new or changed interval: ordered, within the plot, soft in proportion to its width.
void setInterval(vis::BrushInterval& interval, double a, double b, Range within, double softness) {
    interval.lo = std::clamp(std::min(a, b), within.lo, within.hi);
    interval.hi = std::clamp(std::max(a, b), within.lo, within.hi);
    interval.soft = softness * (interval.hi - interval.lo);
}

void resizeInterval(vis::BrushInterval& now, const vis::BrushInterval& before, double delta, bool lower, bool upper,
                    Range within) {
    const double width = before.hi - before.lo;
    if (!lower && !upper) {
        // Moving keeps the width, so stop at the edge of the plot as a whole.
        const double room = std::max(0.0, (within.hi - within.lo) - width);
        const double lo = std::clamp(before.lo + delta, within.lo, within.lo + room);
        now.lo = before.lo < within.lo || before.hi > within.hi ? before.lo + delta : lo;
        now.hi = now.lo + width;
        return;
    }
    double lo = before.lo, hi = before.hi;
    if (lower) lo = std::clamp(lo + delta, within.lo, within.hi);
    if (upper) hi = std::clamp(hi + delta, within.lo, within.hi);
    now.lo = std::min(lo, hi);
    now.hi = std::max(lo, hi);
    now.soft = width > 0 ? before.soft * (now.hi - now.lo) / width : before.soft;
}

void showCursor(int edges) {
    const bool left = edges & kLeftEdge, right = edges & kRightEdge, bottom = edges & kBottomEdge,
               top = edges & kTopEdge;
    if ((left && top) || (right && bottom))
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeNWSE);
    else if ((left && bottom) || (right && top))
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeNESW);
    else if (left || right)
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    else if (top || bottom)
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeNS);
    else
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeAll);
}

/// Adds the brush of a drag that has gone far enough; brushes of the same plot make room unless a modifier keeps them.
void beginBrush(BrushDrag& drag, vis::Selection& selection, bool add, bool subtract) {
    const auto samePlot = [&](const vis::Brush& brush) {
        const std::size_t wanted = drag.plot.y.empty() ? 1 : 2;
        return brush.intervals.size() == wanted && brushFits(brush, drag.plot);
    };
    if (!add && !subtract)
        std::erase_if(selection.brushes, samePlot);
    else if (add && !selection.brushes.empty() &&
             std::all_of(selection.brushes.begin(), selection.brushes.end(), samePlot))
        // Two separate ranges of the same quantities can never hold both: adding means either.
        selection.combine = vis::Combine::Any;
    vis::Brush brush;
    brush.name = newBrushName(selection, drag.plot);
    brush.inverted = subtract;
    brush.intervals.push_back({.channel = drag.plot.x});
    if (!drag.plot.y.empty() && drag.plot.y != drag.plot.x) brush.intervals.push_back({.channel = drag.plot.y});
    selection.brushes.push_back(brush);
    drag.brush = static_cast<int>(selection.brushes.size()) - 1;
}

void dragBrush(BrushDrag& drag, vis::Selection& selection, const PlotFrame& frame, glm::dvec2 now, float softness) {
    vis::Brush& brush = selection.brushes[static_cast<std::size_t>(drag.brush)];
    for (vis::BrushInterval& interval : brush.intervals) {
        const bool isX = interval.channel == drag.plot.x;
        const Range within = isX ? frame.x : frame.y;
        const double from = isX ? drag.start.x : drag.start.y, to = isX ? now.x : now.y;
        if (drag.made) {
            setInterval(interval, from, to, within, softness);
            continue;
        }
        const vis::Brush& before = drag.original.brushes[static_cast<std::size_t>(drag.brush)];
        const vis::BrushInterval* own = intervalOf(before, interval.channel);
        const bool lower = drag.edges & (isX ? kLeftEdge : kBottomEdge);
        const bool upper = drag.edges & (isX ? kRightEdge : kTopEdge);
        if (drag.edges == 0 || lower || upper) resizeInterval(interval, *own, to - from, lower, upper, within);
    }
}

} // namespace

bool brushFits(const vis::Brush& brush, const PlotChannels& plot) {
    return !brush.intervals.empty() && std::all_of(brush.intervals.begin(), brush.intervals.end(), [&](const auto& i) {
        return i.channel == plot.x || (!plot.y.empty() && i.channel == plot.y);
    });
}

BrushHit hitBrush(const vis::Selection& selection, const PlotFrame& frame, const PlotChannels& plot, ImVec2 at) {
    const float near = reach();
    for (int i = static_cast<int>(selection.brushes.size()) - 1; i >= 0; --i) {
        const vis::Brush& brush = selection.brushes[static_cast<std::size_t>(i)];
        if (!brushFits(brush, plot)) continue;
        const Rect rect = rectOf(brush, frame, plot, 0);
        if (at.x < rect.min.x - near || at.x > rect.max.x + near || at.y < rect.min.y - near ||
            at.y > rect.max.y + near)
            continue;
        int edges = 0;
        // Of two edges close together the nearer one is meant; small brushes keep a middle to move them by.
        const float nearX = std::min(near, std::max(1.5f, (rect.max.x - rect.min.x) / 4));
        const float nearY = std::min(near, std::max(1.5f, (rect.max.y - rect.min.y) / 4));
        if (!rect.bandX) {
            if (at.x < rect.min.x + nearX)
                edges |= kLeftEdge;
            else if (at.x > rect.max.x - nearX)
                edges |= kRightEdge;
        }
        if (!rect.bandY) {
            if (at.y > rect.max.y - nearY)
                edges |= kBottomEdge;
            else if (at.y < rect.min.y + nearY)
                edges |= kTopEdge;
        }
        return {i, edges};
    }
    return {};
}

bool editBrushes(BrushDrag& drag, vis::Selection& selection, const PlotFrame& frame, const PlotChannels& plot,
                 float softness) {
    const ImGuiIO& io = ImGui::GetIO();
    const vis::Selection before = selection;
    const bool hovered = ImGui::IsItemHovered();
    if (hovered && !drag.active) {
        const BrushHit hit = hitBrush(selection, frame, plot, io.MousePos);
        if (hit.brush >= 0) showCursor(hit.edges);
        if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
            // Modifiers always start a new brush, also on top of another.
            const bool fresh = hit.brush < 0 || io.KeyShift || io.KeyCtrl;
            drag = {.active = true,
                    .made = fresh,
                    .plot = plot,
                    .brush = fresh ? -1 : hit.brush,
                    .edges = fresh ? 0 : hit.edges,
                    .start = frame.data(io.MousePos),
                    .original = selection};
        } else if (ImGui::IsMouseReleased(ImGuiMouseButton_Right) &&
                   ImGui::GetMouseDragDelta(ImGuiMouseButton_Right).x == 0) {
            if (hit.brush >= 0)
                selection.brushes.erase(selection.brushes.begin() + hit.brush);
            else
                selection.brushes.clear();
        }
    }
    if (drag.active && !ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        drag = {};
    } else if (drag.active && drag.plot == plot && ImGui::IsItemActive()) {
        // The same channels may be plotted twice; the drag belongs to the plot it began in.
        if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
            selection = drag.original;
            drag = {};
        } else if (drag.brush >= static_cast<int>(selection.brushes.size()) && !drag.made) {
            drag = {}; // somebody else (undo) took the brush away
        } else {
            if (drag.brush < 0 && ImGui::IsMouseDragging(ImGuiMouseButton_Left, reach()))
                beginBrush(drag, selection, io.KeyShift, io.KeyCtrl);
            if (drag.brush >= 0 && drag.brush < static_cast<int>(selection.brushes.size())) {
                if (!drag.made) showCursor(drag.edges);
                dragBrush(drag, selection, frame, frame.data(io.MousePos), softness);
            }
        }
    }
    return !(selection == before);
}

void drawBrushes(ImDrawList& draw, const vis::Selection& selection, const PlotFrame& frame, const PlotChannels& plot) {
    const PlotColors colors = plotColors();
    draw.PushClipRect(frame.min, frame.max, true);
    for (std::size_t i = 0; i < selection.brushes.size(); ++i) {
        const vis::Brush& brush = selection.brushes[i];
        if (!brushFits(brush, plot)) continue;
        const ImU32 line = brush.enabled ? colors.brush : colors.frame;
        Rect rect = rectOf(brush, frame, plot, 0);
        const auto widen = [&](Rect& r) {
            // A band has no ends: its lines along the plot's border would look like a range.
            if (r.bandX) r.min.x -= 4, r.max.x += 4;
            if (r.bandY) r.min.y -= 4, r.max.y += 4;
        };
        widen(rect);
        if (brush.enabled && !brush.inverted) draw.AddRectFilled(rect.min, rect.max, colors.brushFill);
        const Rect inner = rect;
        Rect outer = rectOf(brush, frame, plot, 1);
        widen(outer);
        draw.AddRect(outer.min, outer.max, (line & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 90));
        draw.AddRect(inner.min, inner.max, line, 0, 0, std::max(1.0f, em() * 0.1f));
        if (brush.inverted) {
            // Struck through: what is inside is taken away. Not colour alone.
            draw.AddLine(inner.min, inner.max, line);
            draw.AddLine({inner.min.x, inner.max.y}, {inner.max.x, inner.min.y}, line);
        }
        const std::string number = std::to_string(i + 1);
        const ImVec2 size = ImGui::CalcTextSize(number.c_str());
        const ImVec2 at{std::clamp(inner.min.x + 3, frame.min.x + 1, frame.max.x - size.x - 1),
                        std::clamp(inner.min.y + 1, frame.min.y + 1, frame.max.y - size.y - 1)};
        addTextWithBackdrop(draw, at, {0, 0}, line, number.c_str());
    }
    draw.PopClipRect();
}

std::string newBrushName(const vis::Selection& selection, const PlotChannels& plot) {
    const std::string base = plot.y.empty() || plot.y == plot.x ? plot.x : plot.x + " \u00d7 " + plot.y;
    const auto taken = [&](const std::string& name) {
        return std::any_of(selection.brushes.begin(), selection.brushes.end(),
                           [&](const vis::Brush& brush) { return brush.name == name; });
    };
    std::string name = base;
    for (int i = 2; taken(name); ++i) name = base + " " + std::to_string(i);
    return name;
}

} // namespace tessera::app
