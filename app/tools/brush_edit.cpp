#include "app/tools/brush_edit.h"

#include "app/pane/view_context.h"
#include "app/tools/brush_shape.h"
#include "app/ui/keys.h"
#include "app/values/plot.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tessera::app {

namespace {

/// Told apart with each of the three colour blindnesses too, on dark ground and as drawn on light ground: at least 13
/// hundredths of OKLab between any two, where about 2 are just noticed (searched for; views_brush_test.cpp measures
/// it). The first is the colour of a lone brush, each further one is far from those before.
constexpr glm::vec3 kBrushColors[] = {{1.0f, 0.69f, 0.25f}, {0.7f, 0.05f, 1.0f},  {0.65f, 0.95f, 1.0f},
                                      {0.2f, 0.55f, 0.5f},  {0.25f, 0.8f, 0.75f}, {0.95f, 0.25f, 0.0f},
                                      {0.95f, 1.0f, 0.1f},  {0.65f, 0.55f, 0.95f}};

float reach() {
    return std::max(4.0f, em() * 0.35f);
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

vis::Region newRegion(const PlotChannels& plot, const BrushPen& pen) {
    const bool two = !plot.y.empty() && plot.y != plot.x;
    if (two && pen.tool == BrushTool::Ellipse) return vis::EllipseRegion{.x = plot.x, .y = plot.y};
    if (two && pen.tool == BrushTool::Lasso)
        return vis::LassoRegion{.x = plot.x, .y = plot.y, .points = {}, .soft = 2.0 * double(pen.softness)};
    vis::RangeRegion range;
    range.intervals.push_back({.channel = plot.x});
    if (two) range.intervals.push_back({.channel = plot.y});
    return range;
}

/// One more corner of a lasso, where the mouse has moved far enough from the last one.
void extendLasso(vis::LassoRegion& lasso, const PlotFrame& frame, glm::dvec2 start, ImVec2 mouse) {
    if (lasso.points.empty()) lasso.points.push_back(start);
    const ImVec2 last = frame.pixel(lasso.points.back().x, lasso.points.back().y);
    if (std::hypot(mouse.x - last.x, mouse.y - last.y) < 3) return;
    const glm::dvec2 at = frame.data(mouse);
    lasso.points.emplace_back(std::clamp(at.x, frame.x.lo, frame.x.hi), std::clamp(at.y, frame.y.lo, frame.y.hi));
}

void dragBrush(BrushDrag& drag, vis::Selection& selection, const PlotFrame& frame, const BrushPen& pen) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    vis::Region& region = selection.brushes[static_cast<std::size_t>(drag.brush)].region;
    const glm::dvec2 now = frame.data(mouse);
    if (!drag.made)
        dragRegion(region, drag.original.brushes[static_cast<std::size_t>(drag.brush)].region, drag.edges,
                   now - drag.start, frame, drag.plot);
    else if (auto* lasso = std::get_if<vis::LassoRegion>(&region))
        extendLasso(*lasso, frame, drag.start, mouse);
    else
        spanRegion(region, drag.start, now, frame, drag.plot, static_cast<double>(pen.softness));
}

/// The edges of its box that a point of an ellipse grabs; none well inside.
int ellipseEdges(const BrushRect& rect, ImVec2 at) {
    const float u = (at.x - rect.min.x) / std::max(1.0f, rect.max.x - rect.min.x) * 2 - 1;
    const float v = 1 - (at.y - rect.min.y) / std::max(1.0f, rect.max.y - rect.min.y) * 2;
    if (std::hypot(u, v) < 0.75f) return 0;
    return (u < -0.45f  ? kLeftEdge
            : u > 0.45f ? kRightEdge
                        : 0) |
           (v < -0.45f  ? kBottomEdge
            : v > 0.45f ? kTopEdge
                        : 0);
}

int rangeEdges(const BrushRect& rect, ImVec2 at, float near) {
    int edges = 0;
    // Of two close edges the nearer one; small brushes keep a middle part for moving them.
    const float nearX = std::min(near, std::max(1.5f, (rect.max.x - rect.min.x) / 4));
    const float nearY = std::min(near, std::max(1.5f, (rect.max.y - rect.min.y) / 4));
    if (!rect.bandX) edges |= at.x < rect.min.x + nearX ? kLeftEdge : at.x > rect.max.x - nearX ? kRightEdge : 0;
    if (!rect.bandY) edges |= at.y > rect.max.y - nearY ? kBottomEdge : at.y < rect.min.y + nearY ? kTopEdge : 0;
    return edges;
}

} // namespace

bool brushFits(const vis::Brush& brush, const PlotChannels& plot) {
    const std::vector<std::string> channels = vis::regionChannels(brush.region);
    return !channels.empty() && std::all_of(channels.begin(), channels.end(), [&](const std::string& channel) {
        return channel == plot.x || (!plot.y.empty() && channel == plot.y);
    });
}

BrushHit hitBrush(const vis::Selection& selection, const PlotFrame& frame, const PlotChannels& plot, ImVec2 at) {
    const float near = reach();
    for (int i = static_cast<int>(selection.brushes.size()) - 1; i >= 0; --i) {
        const vis::Brush& brush = selection.brushes[static_cast<std::size_t>(i)];
        if (!brushFits(brush, plot)) continue;
        const BrushRect rect = brushRect(brush.region, frame, plot, 0);
        if (at.x < rect.min.x - near || at.x > rect.max.x + near || at.y < rect.min.y - near ||
            at.y > rect.max.y + near)
            continue;
        if (std::holds_alternative<vis::RangeRegion>(brush.region)) return {i, rangeEdges(rect, at, near)};
        if (!insideOutline(brushOutline(brush.region, frame, plot, 0), at)) continue;
        return {i, std::holds_alternative<vis::EllipseRegion>(brush.region) ? ellipseEdges(rect, at) : 0};
    }
    return {};
}

void pressBrush(BrushDrag& drag, vis::Selection& selection, const PlotChannels& plot, BrushHit hit, glm::dvec2 start) {
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        // Modifiers always start a new brush, also on top of another.
        const bool fresh = hit.brush < 0 || io.KeyShift || io.KeyCtrl;
        drag = {.active = true,
                .made = fresh,
                .plot = plot,
                .brush = fresh ? -1 : hit.brush,
                .edges = fresh ? 0 : hit.edges,
                .start = start,
                .original = selection,
                .asksToClear = false};
    } else if (ImGui::IsMouseReleased(ImGuiMouseButton_Right) &&
               ImGui::GetMouseDragDelta(ImGuiMouseButton_Right).x == 0) {
        if (hit.brush >= 0)
            selection.brushes.erase(selection.brushes.begin() + hit.brush);
        else if (selection.brushes.size() == 1)
            selection.brushes.clear();
        else
            drag.asksToClear = !selection.brushes.empty();
    }
}

void addDragged(BrushDrag& drag, vis::Selection& selection, vis::Region region) {
    const ImGuiIO& io = ImGui::GetIO();
    const std::vector<std::string> channels = vis::regionChannels(region);
    if (!io.KeyShift && !io.KeyCtrl)
        std::erase_if(selection.brushes, [&](const vis::Brush& brush) {
            return vis::regionChannels(brush.region).size() == channels.size() && brushFits(brush, drag.plot);
        });
    vis::Brush brush;
    const PlotChannels& plot = drag.plot;
    brush.name = newBrushName(selection, channels.size() < 2 ? plot.x : plot.x + " \u00d7 " + plot.y);
    brush.color = newBrushColor(selection);
    brush.combine = io.KeyCtrl    ? vis::BrushCombine::Minus
                    : io.KeyShift ? vis::BrushCombine::Or
                                  : vis::BrushCombine::And;
    brush.region = std::move(region);
    selection.brushes.push_back(brush);
    drag.brush = static_cast<int>(selection.brushes.size()) - 1;
}

bool editBrushes(BrushDrag& drag, vis::Selection& selection, const PlotFrame& frame, const PlotChannels& plot,
                 const BrushPen& pen) {
    const ImGuiIO& io = ImGui::GetIO();
    const vis::Selection before = selection;
    const bool hovered = ImGui::IsItemHovered();
    drag.asksToClear = false;
    if (hovered && !drag.active) {
        const BrushHit hit = hitBrush(selection, frame, plot, io.MousePos);
        if (hit.brush >= 0) showCursor(hit.edges);
        pressBrush(drag, selection, plot, hit, frame.data(io.MousePos));
    }
    // Esc first: with keyboard navigation ImGui deactivates the item before it can be seen below.
    if (drag.active && keyPressed(key::kEscape)) {
        selection = drag.original;
        drag = {};
    } else if (drag.active && !ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        drag = {};
    } else if (drag.active && drag.plot == plot && ImGui::IsItemActive()) {
        // The same channels may be plotted twice; the drag belongs to the plot it began in.
        if (drag.brush >= static_cast<int>(selection.brushes.size()) && !drag.made) {
            drag = {}; // the brush was removed meanwhile, e.g. by undo
        } else {
            if (drag.brush < 0 && ImGui::IsMouseDragging(ImGuiMouseButton_Left, reach()))
                addDragged(drag, selection, newRegion(plot, pen));
            if (drag.brush >= 0 && drag.brush < static_cast<int>(selection.brushes.size())) {
                if (!drag.made) showCursor(drag.edges);
                dragBrush(drag, selection, frame, pen);
            }
        }
    }
    return !(selection == before);
}

void clearAfterQuestion(const BrushDrag& drag, const ViewContext& context) {
    if (drag.asksToClear && context.runCommand) context.runCommand("Clear brushes");
}

void drawBrushes(ImDrawList& draw, const vis::Selection& selection, const PlotFrame& frame, const PlotChannels& plot) {
    draw.PushClipRect(frame.min, frame.max, true);
    const float thick = std::max(1.0f, em() * 0.1f);
    for (std::size_t i = 0; i < selection.brushes.size(); ++i) {
        const vis::Brush& brush = selection.brushes[i];
        if (!brushFits(brush, plot)) continue;
        const bool taken = brush.inverted != (brush.combine == vis::BrushCombine::Minus);
        const ImU32 line = brush.enabled ? brushColor(brush) : plotColors().frame;
        const ImU32 faint = (line & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 90);
        const bool fill = brush.enabled && !taken;
        BrushRect inner = brushRect(brush.region, frame, plot, 0);
        if (std::holds_alternative<vis::RangeRegion>(brush.region)) {
            BrushRect outer = brushRect(brush.region, frame, plot, 1);
            for (BrushRect* rect : {&inner, &outer}) {
                // An unbounded axis has no edges: lines along the plot's border would look like a range.
                if (rect->bandX) rect->min.x -= 4, rect->max.x += 4;
                if (rect->bandY) rect->min.y -= 4, rect->max.y += 4;
            }
            if (fill) draw.AddRectFilled(inner.min, inner.max, brushColor(brush, 0.11f));
            draw.AddRect(outer.min, outer.max, faint);
            draw.AddRect(inner.min, inner.max, line, 0, 0, thick);
        } else {
            const std::vector<ImVec2> outline = brushOutline(brush.region, frame, plot, 0);
            const std::vector<ImVec2> outer = brushOutline(brush.region, frame, plot, 1);
            if (fill && std::holds_alternative<vis::EllipseRegion>(brush.region))
                draw.AddConvexPolyFilled(outline.data(), static_cast<int>(outline.size()), brushColor(brush, 0.11f));
            draw.AddPolyline(outer.data(), static_cast<int>(outer.size()), faint, ImDrawFlags_Closed, 1);
            draw.AddPolyline(outline.data(), static_cast<int>(outline.size()), line, ImDrawFlags_Closed, thick);
        }
        if (taken) {
            // A subtracting brush is struck through, since colour alone may not be seen.
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

std::string newBrushName(const vis::Selection& selection, const std::string& base) {
    const auto taken = [&](const std::string& name) {
        return std::any_of(selection.brushes.begin(), selection.brushes.end(),
                           [&](const vis::Brush& brush) { return brush.name == name; });
    };
    std::string name = base;
    for (int i = 2; taken(name); ++i) name = base + " " + std::to_string(i);
    return name;
}

glm::vec3 newBrushColor(const vis::Selection& selection) {
    for (const glm::vec3& color : kBrushColors)
        if (std::none_of(selection.brushes.begin(), selection.brushes.end(),
                         [&](const vis::Brush& brush) { return brush.color == color; }))
            return color;
    return kBrushColors[selection.brushes.size() % std::size(kBrushColors)];
}

ImU32 brushColor(glm::vec3 color, float alpha) {
    color *= darkTheme() ? 1.0f : kBrightOnWhite;
    return ImGui::ColorConvertFloat4ToU32({color.r, color.g, color.b, alpha});
}
ImU32 brushColor(const vis::Brush& brush, float alpha) {
    return brushColor(brush.color, alpha);
}

ImU32 focusColor(const Session& session) {
    std::vector<glm::vec3> colors;
    for (const vis::Brush& brush : session.selection.brushes)
        if (brush.enabled && !brush.inverted && brush.combine != vis::BrushCombine::Minus)
            colors.push_back(brush.color);
    if (!session.selection.active())
        for (const vis::Lens& lens : session.lenses)
            if (vis::marksAt(lens, session.time)) colors.push_back(lens.color);
    return colors.size() == 1 ? brushColor(colors.front()) : plotColors().focus;
}

} // namespace tessera::app
