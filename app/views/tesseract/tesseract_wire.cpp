#include "app/views/tesseract/tesseract_wire.h"

#include "app/pane/axes3d.h"
#include "app/ui/ticks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

namespace tessera::app {

namespace {

constexpr int kPieces = 12; ///< of an edge: colour and width change along it

struct Piece {
    ImVec2 a, b;
    ImU32 color;
    float width;
    double depth;
};

ImU32 fourthColor(const TesseractFrame& frame, double share, double alpha) {
    const glm::dvec4 color = vis::evaluate(frame.fourth, {0, 1}, std::clamp(share, 0.0, 1.0));
    return toColor({color.r, color.g, color.b}, alpha);
}

/// How near a place is, 0..1, along both directions of view.
double nearness(const vis::Projected4& at) {
    return std::clamp(1 - 0.5 * (at.depth + at.depthW), 0.0, 1.0);
}

void addLine(std::vector<Piece>& pieces, const TesseractFrame& frame, glm::dvec4 from, glm::dvec4 to, int count,
             double strength, float width) {
    vis::Projected4 before = frame.project(from);
    for (int i = 1; i <= count; ++i) {
        const glm::dvec4 at = from + (to - from) * (double(i) / count);
        const vis::Projected4 here = frame.project(at);
        const glm::dvec4 middle = from + (to - from) * ((i - 0.5) / count);
        const double near = 0.5 * (nearness(before) + nearness(here));
        const double share = frame.half.w > 0 ? 0.5 + 0.5 * middle.w / frame.half.w : 0.5;
        pieces.push_back({frame.pixel(before.at), frame.pixel(here.at),
                          fourthColor(frame, share, strength * (0.3 + 0.7 * near)), width * float(0.6 + 0.8 * near),
                          -near});
        before = here;
    }
}

void drawPieces(ImDrawList& draw, std::vector<Piece>& pieces) {
    std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.depth > b.depth; });
    for (const Piece& piece : pieces) draw.AddLine(piece.a, piece.b, piece.color, piece.width);
}

} // namespace

vis::TransferFunction fourthColors() {
    vis::TransferFunction function;
    function.colors = {{0.0f, {0.30f, 0.55f, 0.98f}},
                       {0.35f, {0.58f, 0.50f, 0.93f}},
                       {0.65f, {0.88f, 0.45f, 0.62f}},
                       {1.0f, {0.98f, 0.55f, 0.16f}}};
    return function;
}

ImVec2 TesseractFrame::pixel(glm::dvec2 at) const {
    const float unit = 0.5f * std::min(max.x - min.x, max.y - min.y);
    return {0.5f * (min.x + max.x) + float(at.x) * unit, 0.5f * (min.y + max.y) - float(at.y) * unit};
}

void drawWire(ImDrawList& draw, const TesseractFrame& frame) {
    std::vector<Piece> pieces;
    for (const vis::Edge4& edge : vis::edges4())
        addLine(pieces, frame, vis::corner4(edge.from, frame.half), vis::corner4(edge.to, frame.half), kPieces, 1,
                em() * 0.13f);
    drawPieces(draw, pieces);
    for (int i = 0; i < vis::kCorners4; ++i) {
        const glm::dvec4 corner = vis::corner4(i, frame.half);
        const vis::Projected4 at = frame.project(corner);
        draw.AddCircleFilled(frame.pixel(at.at), em() * float(0.1 + 0.14 * nearness(at)),
                             fourthColor(frame, corner.w > 0 ? 1 : 0, 0.35 + 0.65 * nearness(at)), 12);
    }
}

void drawLattice4(ImDrawList& draw, const TesseractFrame& frame, int cells) {
    if (cells < 1) return;
    std::vector<Piece> pieces;
    const int nodes = cells + 1;
    const auto place = [&](int node, int axis) { return frame.half[axis] * (2.0 * node / cells - 1); };
    for (int axis = 0; axis < 4; ++axis)
        for (int line = 0; line < nodes * nodes * nodes; ++line) {
            glm::dvec4 from(0);
            for (int other = 0, rest = line; other < 4; ++other) {
                if (other == axis) continue;
                from[other] = place(rest % nodes, other);
                rest /= nodes;
            }
            glm::dvec4 to = from;
            from[axis] = -frame.half[axis];
            to[axis] = frame.half[axis];
            addLine(pieces, frame, from, to, axis == 3 ? 4 : 1, 0.35, em() * 0.06f);
        }
    drawPieces(draw, pieces);
}

std::pair<ImVec2, ImVec2> drawNowCell(ImDrawList& draw, const TesseractFrame& frame, double share,
                                      const std::string& text) {
    const double w = frame.half.w * (2 * share - 1);
    const PlotColors colors = plotColors();
    ImVec2 top{0, 0};
    bool first = true;
    for (const vis::Edge4& edge : vis::edges4()) {
        if (edge.axis == 3 || edge.from & 8) continue;
        glm::dvec4 from = vis::corner4(edge.from, frame.half), to = vis::corner4(edge.to, frame.half);
        from.w = to.w = w;
        const ImVec2 a = frame.pixel(frame.project(from).at), b = frame.pixel(frame.project(to).at);
        draw.AddLine(a, b, colors.backdrop, em() * 0.3f);
        draw.AddLine(a, b, colors.cursor, em() * 0.12f);
        for (const ImVec2 end : {a, b})
            if (first || end.y < top.y) {
                top = end;
                first = false;
            }
    }
    const float below = frame.min.y + em() * 3; // of the title of the picture
    const ImVec2 at{top.x, std::max(top.y - em() * 0.3f, below)}, size = ImGui::CalcTextSize(text.c_str());
    addTextWithBackdrop(draw, at, {0.5f, 1}, colors.cursor, text.c_str());
    return {{at.x - size.x / 2, at.y - size.y}, {at.x + size.x / 2, at.y}};
}

void numberEnds(TesseractFrame& frame, const volume::DatasetInfo& info, std::optional<int> fourth) {
    const LengthUnit unit = suitableLength(info.lengthUnit, glm::length(info.bounds.size()));
    const auto put = [&](std::size_t axis, Range range, const std::string& of) {
        const double digits = (range.hi - range.lo) / 100;
        frame.low[axis] = formatQuantity(range.lo, of, digits);
        frame.high[axis] = formatQuantity(range.hi, of, digits);
    };
    for (int axis = 0; axis < 3; ++axis)
        put(std::size_t(axis), {info.bounds.lo[axis] * unit.perUnit, info.bounds.hi[axis] * unit.perUnit}, unit.name);
    if (fourth)
        put(3, info.channelRange(info.channel(*fourth)), info.channel(*fourth).unit);
    else
        put(3, {info.times.front(), info.times.back()}, info.timeUnit);
}

void drawAxisNames4(ImDrawList& draw, const TesseractFrame& frame, std::vector<std::pair<ImVec2, ImVec2>> taken) {
    // The four edges of the corner that lies furthest down have their names where they cross nothing else.
    int corner = 0;
    double lowest = 0;
    for (int i = 0; i < vis::kCorners4; ++i) {
        const double y = frame.project(vis::corner4(i, frame.half)).at.y;
        if (i == 0 || y < lowest) {
            lowest = y;
            corner = i;
        }
    }
    const glm::dvec4 from = vis::corner4(corner, frame.half);
    const auto write = [&](glm::dvec4 place, ImU32 color, const std::string& text) {
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        if (size.x > frame.max.x - frame.min.x || size.y > frame.max.y - frame.min.y) return;
        const ImVec2 on = frame.pixel(frame.project(place).at);
        const ImVec2 at{std::clamp(on.x, frame.min.x + size.x / 2, frame.max.x - size.x / 2),
                        std::clamp(on.y, frame.min.y + size.y / 2, frame.max.y - size.y / 2)};
        const ImVec2 lo{at.x - size.x / 2, at.y - size.y / 2}, hi{at.x + size.x / 2, at.y + size.y / 2};
        for (const auto& [min, max] : taken)
            if (lo.x < max.x && min.x < hi.x && lo.y < max.y && min.y < hi.y) return;
        taken.emplace_back(lo, hi);
        addTextWithBackdrop(draw, at, {0.5f, 0.5f}, color, text.c_str());
    };
    std::string here;
    for (int axis = 0; axis < 4; ++axis) {
        const glm::dvec4 to = vis::corner4(corner ^ 1 << axis, frame.half);
        const ImU32 color = axis < 3 ? axisColor(axis) : fourthColor(frame, 0.75, 1);
        write(from + (to - from) * 0.6, color, frame.axes[std::size_t(axis)]);
        const bool high = to[axis] > 0;
        write(to, color, (high ? frame.high : frame.low)[std::size_t(axis)]);
        here += (axis == 0 ? "" : axis < 3 ? ", " : "; ") + (high ? frame.low : frame.high)[std::size_t(axis)];
    }
    write(from, plotColors().faint, here);
}

std::string nearText(const TesseractFrame& frame) {
    // Row w of the rotation: how much each axis points towards the eye.
    struct Part {
        int axis;
        double share;
    };
    std::vector<Part> parts;
    for (int axis = 0; axis < 4; ++axis) parts.push_back({axis, frame.rotation[axis][3]});
    std::sort(parts.begin(), parts.end(), [](Part a, Part b) { return std::abs(a.share) > std::abs(b.share); });
    std::string text = "large = near in 4D: ";
    for (std::size_t i = 0; i < parts.size() && (i == 0 || std::abs(parts[i].share) > 0.3); ++i) {
        text += i > 0 ? ", " : "";
        text += parts[i].share > 0 ? "high " : "low ";
        text += frame.axes[std::size_t(parts[i].axis)];
    }
    return text;
}

} // namespace tessera::app
