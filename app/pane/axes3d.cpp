#include "app/pane/axes3d.h"

#include "app/ui/ticks.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera::app {

namespace {

float length(ImVec2 v) {
    return std::hypot(v.x, v.y);
}

bool overlaps(const std::pair<ImVec2, ImVec2>& a, const std::pair<ImVec2, ImVec2>& b, float gap) {
    return a.first.x < b.second.x + gap && b.first.x < a.second.x + gap && a.first.y < b.second.y + gap &&
           b.first.y < a.second.y + gap;
}

/// Where a text of this size goes so that it just clears a point in a direction.
std::pair<ImVec2, ImVec2> besides(ImVec2 at, ImVec2 direction, ImVec2 size) {
    const ImVec2 center{at.x + direction.x * size.x / 2, at.y + direction.y * size.y / 2};
    const ImVec2 min{std::round(center.x - size.x / 2), std::round(center.y - size.y / 2)};
    return {min, {min.x + size.x, min.y + size.y}};
}

/// The part of an edge where the middle of a number beside it would be taken.
float takenBeside(const LabelledEdge& edge, const Rectangles& taken) {
    constexpr int kPlaces = 16;
    int count = 0;
    for (int i = 0; i < kPlaces; ++i) {
        const float along = (float(i) + 0.5f) / kPlaces, out = em() * 1.2f;
        const ImVec2 at{edge.a.x + (edge.b.x - edge.a.x) * along + edge.outward.x * out,
                        edge.a.y + (edge.b.y - edge.a.y) * along + edge.outward.y * out};
        count += std::ranges::any_of(taken, [&](const auto& each) { return overlaps({at, at}, each, 0); });
    }
    return float(count) / kPlaces;
}

/// The share of a rectangle for whose points `covered` is true, by a grid of them.
template <class Covered> double coveredShareOf(ImVec2 min, ImVec2 max, const Covered& covered) {
    constexpr int kParts = 16; // a side
    int count = 0;
    for (int y = 0; y <= kParts; ++y)
        for (int x = 0; x <= kParts; ++x)
            count +=
                covered({min.x + (max.x - min.x) * float(x) / kParts, min.y + (max.y - min.y) * float(y) / kParts});
    return count / double((kParts + 1) * (kParts + 1));
}

} // namespace

std::optional<ImVec2> SpaceFrame::pixel(glm::dvec3 physical) const {
    const glm::dvec4 clip = worldToClip * glm::dvec4(world.toWorld(physical), 1);
    if (!(clip.w > 1e-9)) return std::nullopt;
    const double x = clip.x / clip.w, y = clip.y / clip.w;
    return ImVec2{static_cast<float>(min.x + (x * 0.5 + 0.5) * (max.x - min.x)),
                  static_cast<float>(min.y + (0.5 - y * 0.5) * (max.y - min.y))};
}

SpaceFrame spaceFrame(ImVec2 min, ImVec2 max, const vis::Camera& camera, const volume::Box& bounds,
                      glm::dvec3 stretch) {
    const double aspect = std::max(1.0f, max.x - min.x) / std::max(1.0f, max.y - min.y);
    return {min, max, vis::projectionMatrix(camera, aspect) * vis::viewMatrix(camera), vis::worldFrame(bounds, stretch),
            bounds};
}

SpaceFrame spaceFrame(ImVec2 min, ImVec2 max, const vis::Camera& camera, const volume::DatasetInfo& info,
                      glm::dvec3 stretch) {
    SpaceFrame frame = spaceFrame(min, max, camera, info.bounds, stretch);
    frame.world.axes = info.lattice.axes;
    return frame;
}

double coveredByBox(const SpaceFrame& frame, ImVec2 min, ImVec2 max) {
    std::array<ImVec2, 8> corners;
    for (int i = 0; i < 8; ++i) {
        const volume::Box& box = frame.bounds;
        const auto at =
            frame.pixel({i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z});
        if (!at) return 1;
        corners[std::size_t(i)] = *at;
    }
    // A pixel is covered where it lies in one of the faces, whose corners follow each other around it.
    static constexpr std::array<std::array<std::size_t, 4>, 6> kFaces{
        {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
    return coveredShareOf(min, max, [&](ImVec2 at) {
        return std::ranges::any_of(kFaces, [&](const auto& face) {
            int left = 0, right = 0;
            for (std::size_t i = 0; i < 4; ++i) {
                const ImVec2 a = corners[face[i]], b = corners[face[(i + 1) % 4]];
                const float side = (b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x);
                left += side >= 0;
                right += side <= 0;
            }
            return (left == 4) != (right == 4); // both: on the line of a face that is seen edge on
        });
    });
}

glm::dvec3 eyeOf(const vis::Camera& camera) {
    if (camera.projection == vis::Projection::Perspective) return vis::cameraRay(camera, 1, {0, 0}).origin;
    glm::dvec3 eye = -1e6 * vis::cameraRay(camera, 1, {0, 0}).direction;
    // Directions along a face must count as "not seen" in spite of rounding.
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(eye[axis]) < 1) eye[axis] = 0;
    return eye;
}

std::vector<LabelledEdge> labelledEdges(const SpaceFrame& frame, glm::dvec3 eye, const Rectangles& taken) {
    // A face is visible if the eye is beyond it; `eye` is a world position, or a direction in parallel projection.
    const auto seen = [&](int axis, bool high) {
        const double half = frame.world.halfSize[axis];
        return high ? eye[axis] > half + 1e-6 : eye[axis] < -half - 1e-6;
    };
    std::vector<LabelledEdge> edges;
    const std::optional<ImVec2> middle =
        frame.pixel(frame.world.axes.isEven() ? frame.bounds.center() : frame.world.toPhysical(glm::dvec3(0)));
    if (!middle) return edges;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::optional<LabelledEdge> best;
        double bestScore = -1e30;
        for (int corner = 0; corner < 4; ++corner) {
            const bool highU = corner & 1, highV = corner & 2;
            if (seen(u, highU) == seen(v, highV)) continue; // not on the outline
            LabelledEdge edge;
            edge.axis = axis;
            edge.from = frame.bounds.lo;
            edge.from[u] = highU ? frame.bounds.hi[u] : frame.bounds.lo[u];
            edge.from[v] = highV ? frame.bounds.hi[v] : frame.bounds.lo[v];
            edge.to = edge.from;
            edge.to[axis] = frame.bounds.hi[axis];
            const auto a = frame.pixel(edge.from), b = frame.pixel(edge.to);
            if (!a || !b) continue;
            edge.a = *a;
            edge.b = *b;
            const ImVec2 along{b->x - a->x, b->y - a->y};
            const float size = length(along);
            if (size < em() * 2.5f) continue;
            const ImVec2 center{(a->x + b->x) / 2, (a->y + b->y) / 2};
            ImVec2 normal{-along.y / size, along.x / size};
            if (normal.x * (center.x - middle->x) + normal.y * (center.y - middle->y) < 0)
                normal = {-normal.x, -normal.y};
            edge.outward = normal;
            // Texts belong below the box, or left of it for edges that stand upright.
            double score = normal.y + (std::abs(along.y) > std::abs(along.x) ? -0.5 * normal.x : 0.0);
            const bool inside =
                center.x > frame.min.x && center.x < frame.max.x && center.y > frame.min.y && center.y < frame.max.y;
            if (!inside) score -= 4;
            score -= 5 * takenBeside(edge, taken);
            if (score > bestScore) {
                bestScore = score;
                best = edge;
            }
        }
        if (best) edges.push_back(*best);
    }
    return edges;
}

double coveredByEdges(const std::vector<LabelledEdge>& edges, ImVec2 min, ImVec2 max) {
    return coveredShareOf(min, max, [&](ImVec2 at) {
        return std::ranges::any_of(edges, [&](const LabelledEdge& edge) {
            const ImVec2 along{edge.b.x - edge.a.x, edge.b.y - edge.a.y}, away{at.x - edge.a.x, at.y - edge.a.y};
            const float out = away.x * edge.outward.x + away.y * edge.outward.y;
            const float size = length(along), on = (away.x * along.x + away.y * along.y) / size;
            // Numbers are wider than high, and their middles reach to the ends; beyond them the title has the middle.
            const bool titled = std::abs(on / size - 0.5f) < 0.3f;
            const float reach = em() * ((titled ? 3.0f : 1.6f) + 1.6f * std::abs(edge.outward.x));
            return on >= -em() && on <= size + em() && out >= 0 && out <= reach;
        });
    });
}

double coveredByAxes(const SpaceFrame& frame, const vis::Camera& camera, ImVec2 min, ImVec2 max) {
    return coveredByEdges(labelledEdges(frame, eyeOf(camera)), min, max);
}

TickLabels ticksAlong(const LabelledEdge& edge, const AxisLabel& label) {
    const float pixels = length({edge.b.x - edge.a.x, edge.b.y - edge.a.y});
    const double perUnit = label.unit.perUnit;
    const Range range{edge.from[edge.axis] * perUnit, edge.to[edge.axis] * perUnit};
    // As many as fit along this edge on screen without overlap: texts clear each other where they do so across or
    // upwards.
    const float dx = std::abs(edge.b.x - edge.a.x) / pixels, dy = std::abs(edge.b.y - edge.a.y) / pixels;
    const auto extent = [&](const std::string& text) {
        const double across = (double(ImGui::CalcTextSize(text.c_str()).x) + double(em())) / std::max(1e-6f, dx);
        return std::min(across, double(em()) * 1.4 / std::max(1e-6f, dy));
    };
    constexpr int kMostSteps = 8;
    TickStyle style = label.ticks;
    if (style.most == 0) style.most = kMostSteps;
    const AxisScale scale = label.scale();
    return scaledTicks({scale.place(range.lo), scale.place(range.hi)}, scale, double(pixels), 0, true, extent, style);
}

void drawAxes3d(ImDrawList& draw, const SpaceFrame& frame, const vis::Camera& camera, const AxisLabels& labels,
                Rectangles avoid) {
    drawLabelledEdges(draw, frame, labelledEdges(frame, eyeOf(camera), avoid), labels, avoid);
}

void drawLabelledEdges(ImDrawList& draw, const SpaceFrame& frame, const std::vector<LabelledEdge>& edges,
                       const AxisLabels& labels, Rectangles& avoid) {
    const PlotColors colors = plotColors();
    const auto place = [&](std::pair<ImVec2, ImVec2> box, ImU32 color, const std::string& text) {
        const float margin = em() * 0.4f;
        if (box.first.x < frame.min.x + margin || box.second.x > frame.max.x - margin ||
            box.first.y < frame.min.y + margin || box.second.y > frame.max.y - margin)
            return false;
        for (const auto& taken : avoid)
            if (overlaps(box, taken, em() * 0.25f)) return false;
        draw.AddText(box.first, color, text.c_str());
        avoid.push_back(box);
        return true;
    };
    for (const LabelledEdge& edge : edges) {
        const float pixels = length({edge.b.x - edge.a.x, edge.b.y - edge.a.y});
        const AxisLabel& label = labels[static_cast<std::size_t>(edge.axis)];
        const TickLabels ticks = ticksAlong(edge, label);
        const ImU32 color = axisColor(edge.axis);
        draw.AddLine(edge.a, edge.b, color, std::max(1.0f, em() * 0.09f));
        float furthest = 0;
        const float tick = em() * 0.35f;
        for (std::size_t i = 0; i < ticks.values.size(); ++i) {
            glm::dvec3 at = edge.from;
            at[edge.axis] = label.scale().number(ticks.values[i]) / label.unit.perUnit;
            const auto pixel = frame.pixel(at);
            if (!pixel) continue;
            const ImVec2 end{pixel->x + edge.outward.x * tick, pixel->y + edge.outward.y * tick};
            draw.AddLine(*pixel, end, color);
            const ImVec2 size = ImGui::CalcTextSize(ticks.texts[i].c_str());
            const ImVec2 start{end.x + edge.outward.x * em() * 0.25f, end.y + edge.outward.y * em() * 0.25f};
            if (place(besides(start, edge.outward, size), colors.text, ticks.texts[i]))
                furthest = std::max(furthest, std::abs(edge.outward.x) * size.x + std::abs(edge.outward.y) * size.y);
        }
        std::string title = titleWithUnit(label.title(), label.unit.name);
        if (!ticks.note.empty()) title += "  " + ticks.note;
        const ImVec2 size = ImGui::CalcTextSize(title.c_str());
        bool placed = false;
        for (float along : {0.5f, 0.35f, 0.65f, 0.2f, 0.8f, 0.05f, 0.95f}) {
            const float out = tick + em() * 0.6f + furthest;
            const ImVec2 at{edge.a.x + (edge.b.x - edge.a.x) * along + edge.outward.x * out,
                            edge.a.y + (edge.b.y - edge.a.y) * along + edge.outward.y * out};
            placed = place(besides(at, edge.outward, size), color, title);
            if (placed) break;
        }
        // No room beside the edge: beyond one of its ends, or farther where a number stands there; at last moved into
        // the picture, where it may lie over the box.
        for (const bool moved : {false, true})
            for (const float away : {0.6f, 2.2f})
                for (const float sign : {1.0f, -1.0f}) {
                    if (placed) break;
                    const ImVec2 end = sign > 0 ? edge.b : edge.a;
                    const ImVec2 on{sign * (edge.b.x - edge.a.x) / pixels, sign * (edge.b.y - edge.a.y) / pixels};
                    auto box = besides({end.x + on.x * em() * away, end.y + on.y * em() * away}, on, size);
                    const float shift = std::max(0.0f, frame.min.x + em() * 0.5f - box.first.x) +
                                        std::min(0.0f, frame.max.x - em() * 0.5f - box.second.x);
                    if (shift != 0 && !moved) continue;
                    box.first.x += shift;
                    box.second.x += shift;
                    placed = place(box, color, title);
                }
    }
}

vis::StandardView viewAgainst(int axis, bool positive) {
    vis::StandardView best = vis::StandardView::Front;
    double bestDot = -2;
    for (int i = 0; i < 6; ++i) {
        const auto view = static_cast<vis::StandardView>(i);
        const glm::vec3 toViewer = glm::inverse(vis::standardOrientation(view)) * glm::vec3(0, 0, 1);
        const double dot = (positive ? 1 : -1) * static_cast<double>(toViewer[axis]);
        if (dot > bestDot) {
            bestDot = dot;
            best = view;
        }
    }
    return best;
}

float triadRadius(ImVec2 picture) {
    return std::round(std::clamp(std::min(picture.x, picture.y) * 0.12f, em() * 2, em() * 2.6f));
}

ImVec2 triadMiddle(ImVec2 min, ImVec2 max, TriadCorner corner, float radius) {
    const float away = radius + em() * (radius < em() * 2.2f ? 0.5f : 1.0f);
    const bool left = corner == TriadCorner::BottomLeft || corner == TriadCorner::TopLeft;
    const bool top = corner == TriadCorner::TopLeft || corner == TriadCorner::TopRight;
    return {left ? min.x + away : max.x - away, top ? min.y + em() * 1.8f + away : max.y - away};
}

TriadCorner freeTriadCorner(const SpaceFrame& frame, float radius, const std::pair<ImVec2, ImVec2>& taken) {
    for (const TriadCorner corner :
         {TriadCorner::BottomLeft, TriadCorner::TopLeft, TriadCorner::BottomRight, TriadCorner::TopRight}) {
        const ImVec2 at = triadMiddle(frame.min, frame.max, corner, radius);
        const float reach = radius + em() * 0.3f;
        const std::pair<ImVec2, ImVec2> own{{at.x - reach, at.y - reach}, {at.x + reach, at.y + reach}};
        if (!overlaps(own, taken, 0) && coveredByBox(frame, own.first, own.second) <= 0) return corner;
    }
    return TriadCorner::BottomLeft;
}

std::optional<vis::StandardView> drawTriad(ImDrawList& draw, ImVec2 center, float radius, const vis::Camera& camera,
                                           const AxisLabels& labels, const ImVec2* mouse, bool clicked) {
    struct End {
        int axis;
        bool positive;
        glm::vec3 eye;
    };
    std::vector<End> ends;
    for (int axis = 0; axis < 3; ++axis)
        for (bool positive : {true, false}) {
            glm::vec3 direction(0);
            direction[axis] = positive ? 1.0f : -1.0f;
            ends.push_back({axis, positive, camera.orientation * direction});
        }
    // Far ends first, so that near ones cover them.
    std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) { return a.eye.z < b.eye.z; });
    const float dot = em() * 0.52f;
    const auto at = [&](const End& end) {
        const float reach = radius - dot;
        return ImVec2{center.x + end.eye.x * reach, center.y - end.eye.y * reach};
    };
    const End* under = nullptr;
    if (mouse)
        for (const End& end : ends) {
            const ImVec2 p = at(end);
            if (length({mouse->x - p.x, mouse->y - p.y}) <= dot * 1.2f) under = &end;
        }
    if (mouse && length({mouse->x - center.x, mouse->y - center.y}) <= radius + dot)
        draw.AddCircleFilled(center, radius + dot * 0.4f, IM_COL32(128, 128, 128, 40), 32);
    for (const End& end : ends) {
        const ImVec2 p = at(end);
        const ImU32 color = axisColor(end.axis);
        const bool lit = under == &end;
        if (end.positive) {
            draw.AddLine(center, p, color, std::max(1.5f, em() * 0.13f));
            draw.AddCircleFilled(p, dot, lit ? plotColors().text : color, 20);
            const ImVec2 size = ImGui::CalcTextSize(labels[static_cast<std::size_t>(end.axis)].name.c_str());
            draw.AddText({std::round(p.x - size.x / 2), std::round(p.y - size.y / 2)},
                         darkTheme() ? IM_COL32(12, 14, 18, 255) : IM_COL32(255, 255, 255, 255),
                         labels[static_cast<std::size_t>(end.axis)].name.c_str());
        } else {
            draw.AddCircleFilled(p, dot * 0.62f,
                                 lit ? plotColors().text : ((color & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 120)), 16);
        }
    }
    if (under && clicked) return viewAgainst(under->axis, under->positive);
    return std::nullopt;
}

void drawCursor3d(ImDrawList& draw, const SpaceFrame& frame, glm::dvec3 cursor) {
    const PlotColors colors = plotColors();
    const auto middle = frame.pixel(cursor);
    if (!middle) return;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 a = cursor, b = cursor;
        a[axis] = frame.bounds.lo[axis];
        b[axis] = frame.bounds.hi[axis];
        const auto from = frame.pixel(a), to = frame.pixel(b);
        if (from && to) draw.AddLine(*from, *to, (colors.cursor & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 90));
    }
    draw.AddCircle(*middle, em() * 0.35f, colors.backdrop, 20, 3);
    draw.AddCircle(*middle, em() * 0.35f, colors.cursor, 20, 1.5f);
}

std::string stretchText(glm::dvec3 stretch, const volume::AxisMaps& axes) {
    const auto digits = [](double v) { return formatNumber(v, v >= 10 ? 1 : 0); };
    std::string text;
    if (stretch != glm::dvec3(1))
        text = "stretch " + digits(stretch.x) + " : " + digits(stretch.y) + " : " + digits(stretch.z);
    std::string uneven;
    for (int axis = 0; axis < 3; ++axis)
        if (axes[axis]) uneven += (uneven.empty() ? "" : ", ") + std::string(1, "xyz"[axis]);
    if (!uneven.empty()) text += (text.empty() ? "" : ", ") + uneven + " by cells";
    return text;
}

ImU32 axisColor(int axis) {
    static constexpr ImU32 kDark[] = {IM_COL32(240, 120, 110, 255), IM_COL32(128, 206, 110, 255),
                                      IM_COL32(120, 170, 255, 255)};
    static constexpr ImU32 kLight[] = {IM_COL32(190, 50, 40, 255), IM_COL32(40, 130, 40, 255),
                                       IM_COL32(30, 90, 200, 255)};
    return darkTheme() ? kDark[axis] : kLight[axis];
}

} // namespace tessera::app
