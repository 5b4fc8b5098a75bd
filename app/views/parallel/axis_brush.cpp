#include "app/views/parallel/axis_brush.h"

#include "app/ui/keys.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr double kSameRise = 1.0 / 16; ///< of the height of the axes
constexpr int kCurveSteps = 32;        ///< of a side of a polygon that is curved in the values

float axisReach() {
    return std::max(4.0f, em() * 0.35f);
}

/// The interval of a brush on this parameter alone.
const vis::BrushInterval* onlyInterval(const vis::Brush& brush, const std::string& channel) {
    const auto* range = std::get_if<vis::RangeRegion>(&brush.region);
    if (!range || range->intervals.size() != 1) return nullptr;
    return intervalOf(*range, channel);
}

/// The brush under the mouse, with the edge that it grabs.
BrushHit hitAxisBrush(const vis::Selection& selection, const ParallelAxis& axis, float y) {
    for (int i = static_cast<int>(selection.brushes.size()) - 1; i >= 0; --i) {
        const auto* interval = onlyInterval(selection.brushes[static_cast<std::size_t>(i)], axis.channel.name);
        if (!interval) continue;
        const float lo = axis.pixel(interval->lo), hi = axis.pixel(interval->hi);
        const float top = std::min(lo, hi), bottom = std::max(lo, hi), reach = axisReach();
        if (y < top - reach || y > bottom + reach) continue;
        const float near = std::min(reach, std::max(1.5f, (bottom - top) / 4)); // small ones keep a middle part
        const int atTop = hi < lo ? kTopEdge : kBottomEdge, atBottom = hi < lo ? kBottomEdge : kTopEdge;
        return {i, y < top + near ? atTop : y > bottom - near ? atBottom : 0};
    }
    return {};
}

void dragAxisBrush(BrushDrag& drag, vis::Selection& selection, const ParallelAxis& axis, float softness) {
    auto* range = std::get_if<vis::RangeRegion>(&selection.brushes[static_cast<std::size_t>(drag.brush)].region);
    if (!range || range->intervals.size() != 1) return;
    vis::BrushInterval& own = range->intervals.front();
    const Range shown = axis.density.range;
    const float y = std::clamp(ImGui::GetIO().MousePos.y, axis.top, axis.bottom);
    const double now = axis.value(y), start = drag.start.y;
    if (drag.made) {
        own.lo = std::clamp(std::min(start, now), shown.lo, shown.hi);
        own.hi = std::clamp(std::max(start, now), shown.lo, shown.hi);
        own.soft = double(softness) * (own.hi - own.lo);
        return;
    }
    const auto& before = std::get<vis::RangeRegion>(drag.original.brushes[static_cast<std::size_t>(drag.brush)].region);
    const vis::BrushInterval& was = before.intervals.front();
    if (drag.edges == 0) { // both ends go as far along the axis as the mouse
        const float by = y - axis.pixel(start), lo = axis.pixel(was.lo) + by, hi = axis.pixel(was.hi) + by;
        if (std::min(lo, hi) < axis.top || std::max(lo, hi) > axis.bottom) return;
        own.lo = axis.value(lo);
        own.hi = axis.value(hi);
    } else {
        const double moved = std::clamp(now, shown.lo, shown.hi), kept = drag.edges == kTopEdge ? was.lo : was.hi;
        own.lo = std::min(moved, kept);
        own.hi = std::max(moved, kept);
    }
    if (was.hi > was.lo) own.soft = was.soft * (own.hi - own.lo) / (was.hi - was.lo);
}

/// Whether the drag goes on here in this frame; Esc takes back what it did.
bool dragGoesOn(BrushDrag& drag, vis::Selection& selection, const PlotChannels& plot) {
    if (drag.active && keyPressed(key::kEscape)) {
        selection = drag.original;
        drag = {};
    } else if (drag.active && !ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        drag = {};
    } else if (drag.active && drag.plot == plot && ImGui::IsItemActive()) {
        if (drag.brush < static_cast<int>(selection.brushes.size())) return true;
        drag = {}; // the brush was removed meanwhile, e.g. by undo
    }
    return false;
}

} // namespace

bool editAxisBrush(BrushDrag& drag, vis::Selection& selection, const ParallelAxis& axis, float softness) {
    const vis::Selection before = selection;
    const PlotChannels plot{axis.channel.name, {}};
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    drag.asksToClear = false;
    if (ImGui::IsItemHovered() && !drag.active) {
        const BrushHit hit = hitAxisBrush(selection, axis, mouse.y);
        if (hit.brush >= 0)
            ImGui::SetMouseCursor(hit.edges != 0 ? ImGuiMouseCursor_ResizeNS : ImGuiMouseCursor_ResizeAll);
        pressBrush(drag, selection, plot, hit, {double(mouse.x), axis.value(mouse.y)});
    }
    if (dragGoesOn(drag, selection, plot)) {
        if (drag.brush < 0 && ImGui::IsMouseDragging(ImGuiMouseButton_Left, axisReach()))
            addDragged(drag, selection, vis::RangeRegion{{{.channel = axis.channel.name}}});
        if (drag.brush >= 0) dragAxisBrush(drag, selection, axis, softness);
    }
    return !(selection == before);
}

void drawAxisBrushes(ImDrawList& draw, const vis::Selection& selection, const ParallelAxis& axis, float half) {
    const float thick = std::max(1.0f, em() * 0.1f);
    draw.PushClipRect({axis.x - half * 4, axis.top}, {axis.x + half * 4, axis.bottom}, true);
    for (std::size_t i = 0; i < selection.brushes.size(); ++i) {
        const vis::Brush& brush = selection.brushes[i];
        const auto* range = std::get_if<vis::RangeRegion>(&brush.region);
        const vis::BrushInterval* own = range ? intervalOf(*range, axis.channel.name) : nullptr;
        if (!own) continue;
        const bool alone = range->intervals.size() == 1;
        const bool taken = brush.inverted != (brush.combine == vis::BrushCombine::Minus);
        const ImU32 line = brush.enabled ? brushColor(brush) : plotColors().frame;
        const ImU32 faint = (line & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 90);
        const auto box = [&](double lo, double hi, ImU32 color, float width) {
            const float a = axis.pixel(lo), b = axis.pixel(hi);
            draw.AddRect({axis.x - half, std::min(a, b)}, {axis.x + half, std::max(a, b)}, color, 0, 0, width);
        };
        const float a = axis.pixel(own->lo), b = axis.pixel(own->hi), top = std::min(a, b), bottom = std::max(a, b);
        if (alone && brush.enabled && !taken)
            draw.AddRectFilled({axis.x - half, top}, {axis.x + half, bottom}, brushColor(brush, 0.3f));
        if (own->soft > 0) box(own->lo - own->soft, own->hi + own->soft, faint, 1);
        box(own->lo, own->hi, alone ? line : faint, alone ? thick : 1);
        if (taken) draw.AddLine({axis.x - half, bottom}, {axis.x + half, top}, line); // colour alone may not be seen
        const std::string number = std::to_string(i + 1);
        addTextWithBackdrop(draw, {axis.x + half + em() * 0.25f, std::clamp(top, axis.top, axis.bottom - em())}, {0, 0},
                            line, number.c_str());
    }
    draw.PopClipRect();
}

namespace {

/// Share of the height from below, whichever way the axis runs.
double heightOnAxis(const ParallelAxis& axis, float y) {
    return double((axis.bottom - y) / std::max(1e-6f, axis.bottom - axis.top));
}

double valueAtHeight(const ParallelAxis& axis, double height) {
    return volume::axisValue(axis.density, axis.flipped ? 1 - height : height);
}

/// The part of a polygon where a*x + b*y + c >= 0.
std::vector<glm::dvec2> cutBy(const std::vector<glm::dvec2>& polygon, double a, double b, double c) {
    std::vector<glm::dvec2> out;
    const auto side = [&](glm::dvec2 p) { return a * p.x + b * p.y + c; };
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 from = polygon[i], to = polygon[(i + 1) % polygon.size()];
        const double s = side(from), t = side(to);
        if (s >= 0) out.push_back(from);
        if ((s >= 0) != (t >= 0)) out.push_back(from + (to - from) * (s / (s - t)));
    }
    return out;
}

/// How the heights on both axes add up to what a stroke bounds.
glm::dvec2 strokeWeights(const GapStroke& stroke) {
    return stroke.angle ? glm::dvec2(-1, 1) : glm::dvec2(1 - stroke.at, stroke.at);
}

} // namespace

std::optional<GapStroke> gapStroke(const ParallelAxis& left, const ParallelAxis& right, ImVec2 from, ImVec2 to,
                                   float least) {
    const float dx = to.x - from.x, dy = to.y - from.y, gap = std::max(1.0f, right.x - left.x);
    if (std::hypot(dx, dy) < least) return {};
    if (std::abs(dy) >= std::abs(dx)) {
        const double at = std::clamp(double((from.x - left.x) / gap), 0.0, 1.0);
        const double a = heightOnAxis(left, from.y), b = heightOnAxis(left, to.y);
        return GapStroke{false, at, {std::min(a, b), std::max(a, b)}};
    }
    const double rise = double(-dy / dx) * double(gap) / double(std::max(1.0f, left.bottom - left.top));
    return GapStroke{true, 0, {rise - kSameRise, rise + kSameRise}};
}

vis::LassoRegion strokeRegion(const ParallelAxis& left, const ParallelAxis& right, const GapStroke& stroke,
                              float softness) {
    vis::LassoRegion out{.x = left.channel.name, .y = right.channel.name, .points = {}, .soft = 2.0 * double(softness)};
    std::vector<glm::dvec2> polygon{{0, 0}, {1, 0}, {1, 1}, {0, 1}}; // heights on the left and on the right
    const glm::dvec2 weights = strokeWeights(stroke);
    polygon = cutBy(polygon, weights.x, weights.y, -stroke.rows.lo);
    polygon = cutBy(polygon, -weights.x, -weights.y, stroke.rows.hi);
    const int steps = left.density.logarithmic || right.density.logarithmic ? kCurveSteps : 1;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        for (int k = 0; k < steps; ++k) {
            const glm::dvec2 from = polygon[i], to = polygon[(i + 1) % polygon.size()];
            const glm::dvec2 at = from + (to - from) * (double(k) / steps);
            out.points.emplace_back(valueAtHeight(left, at.x), valueAtHeight(right, at.y));
        }
    return out;
}

bool editGapBrush(BrushDrag& drag, vis::Selection& selection, const ParallelAxis& left, const ParallelAxis& right,
                  float softness) {
    const vis::Selection before = selection;
    const PlotChannels plot{left.channel.name, right.channel.name};
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    drag.asksToClear = false;
    if (ImGui::IsItemHovered() && !drag.active)
        pressBrush(drag, selection, plot, {}, {double(mouse.x), double(mouse.y)});
    if (dragGoesOn(drag, selection, plot)) {
        const ImVec2 start{static_cast<float>(drag.start.x), static_cast<float>(drag.start.y)};
        if (const auto stroke = gapStroke(left, right, start, mouse, axisReach())) {
            vis::LassoRegion region = strokeRegion(left, right, *stroke, softness);
            const bool holds = region.points.size() > 2; // no line rises further than over the whole height
            if (drag.brush < 0 && holds)
                addDragged(drag, selection, region);
            else if (drag.brush >= 0 && holds)
                selection.brushes[static_cast<std::size_t>(drag.brush)].region = region;
        }
    }
    return !(selection == before);
}

void drawGapDrag(ImDrawList& draw, const BrushDrag& drag, const ParallelAxis& left, const ParallelAxis& right) {
    if (!drag.active || !(drag.plot == PlotChannels{left.channel.name, right.channel.name})) return;
    const ImVec2 start{static_cast<float>(drag.start.x), static_cast<float>(drag.start.y)};
    const auto stroke = gapStroke(left, right, start, ImGui::GetIO().MousePos, axisReach());
    if (!stroke) return;
    const ImU32 color = plotColors().brush;
    const float thick = std::max(2.0f, em() * 0.15f), height = left.bottom - left.top;
    if (!stroke->angle) {
        const float x = left.x + static_cast<float>(stroke->at) * (right.x - left.x);
        draw.AddLine({x, left.bottom - static_cast<float>(stroke->rows.lo) * height},
                     {x, left.bottom - static_cast<float>(stroke->rows.hi) * height}, color, thick);
        return;
    }
    for (const double rise : {stroke->rows.lo, stroke->rows.hi}) {
        const float up = static_cast<float>(rise) * height, share = (start.x - left.x) / (right.x - left.x);
        draw.AddLine({left.x, start.y + up * share}, {right.x, start.y - up * (1 - share)}, color, thick);
    }
}

} // namespace tessera::app
