#include "app/views/tesseract/tesseract_wire.h"

#include "app/pane/axes3d.h"
#include "app/ui/ticks.h"

#include <algorithm>
#include <cmath>
#include <utility>
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

vis::PointN between(const vis::PointN& from, const vis::PointN& to, double share) {
    vis::PointN out{};
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = from[i] + (to[i] - from[i]) * share;
    return out;
}

void addLine(std::vector<Piece>& pieces, const TesseractFrame& frame, const vis::PointN& from, const vis::PointN& to,
             int count, double strength, float width) {
    vis::Projected4 before = frame.project(from);
    for (int i = 1; i <= count; ++i) {
        const vis::Projected4 here = frame.project(between(from, to, double(i) / count));
        const double fourth = between(from, to, (i - 0.5) / count)[3];
        const double near = 0.5 * (nearness(before) + nearness(here));
        const double share = frame.half[3] > 0 ? 0.5 + 0.5 * fourth / frame.half[3] : 0.5;
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
    // Cubes of more dimensions have many edges, whose pieces may be longer; and fainter, as more lie over one another.
    const int count = std::max(2, kPieces >> (frame.count - 4));
    const double strength = std::pow(0.7, frame.count - 4);
    for (const vis::EdgeN& edge : vis::edgesOf(frame.count))
        addLine(pieces, frame, vis::cornerOf(edge.from, frame.half, frame.count),
                vis::cornerOf(edge.to, frame.half, frame.count), count, strength, em() * 0.13f);
    drawPieces(draw, pieces);
    for (int i = 0; i < 1 << frame.count; ++i) {
        const vis::PointN corner = vis::cornerOf(i, frame.half, frame.count);
        const vis::Projected4 at = frame.project(corner);
        draw.AddCircleFilled(frame.pixel(at.at), em() * float((0.1 + 0.14 * nearness(at)) * strength),
                             fourthColor(frame, corner[3] > 0 ? 1 : 0, (0.35 + 0.65 * nearness(at)) * strength), 12);
    }
}

void drawLattice4(ImDrawList& draw, const TesseractFrame& frame, int cells) {
    if (cells < 1) return;
    std::vector<Piece> pieces;
    const int nodes = cells + 1;
    const auto place = [&](int node, std::size_t axis) { return frame.half[axis] * (2.0 * node / cells - 1); };
    for (std::size_t axis = 0; axis < 4; ++axis)
        for (int line = 0; line < nodes * nodes * nodes; ++line) {
            vis::PointN from{};
            int rest = line;
            for (std::size_t other = 0; other < 4; ++other) {
                if (other == axis) continue;
                from[other] = place(rest % nodes, other);
                rest /= nodes;
            }
            vis::PointN to = from;
            from[axis] = -frame.half[axis];
            to[axis] = frame.half[axis];
            addLine(pieces, frame, from, to, axis == 3 ? 4 : 1, 0.35, em() * 0.06f);
        }
    drawPieces(draw, pieces);
}

std::pair<ImVec2, ImVec2> drawNowCell(ImDrawList& draw, const TesseractFrame& frame, double share,
                                      const std::string& text, const std::vector<std::pair<ImVec2, ImVec2>>& taken) {
    vis::PointN middle = frame.half;
    std::fill(middle.begin() + 4, middle.end(), 0);
    const double w = frame.half[3] * (2 * share - 1);
    const PlotColors colors = plotColors();
    ImVec2 top{0, 0};
    bool first = true;
    for (const vis::EdgeN& edge : vis::edgesOf(3)) {
        vis::PointN from = vis::cornerOf(edge.from, middle, 3), to = vis::cornerOf(edge.to, middle, 3);
        from[3] = to[3] = w;
        const ImVec2 a = frame.pixel(frame.project(from).at), b = frame.pixel(frame.project(to).at);
        draw.AddLine(a, b, colors.backdrop, em() * 0.3f);
        draw.AddLine(a, b, colors.cursor, em() * 0.12f);
        for (const ImVec2 end : {a, b})
            if (first || end.y < top.y) {
                top = end;
                first = false;
            }
    }
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    ImVec2 at{top.x, std::max(top.y - em() * 0.3f, frame.min.y + size.y)};
    for (const auto& [lo, hi] : taken) // from the top: below those that it would lie over
        if (at.x - size.x / 2 < hi.x && at.x + size.x / 2 > lo.x && at.y - size.y < hi.y && at.y > lo.y)
            at.y = hi.y + size.y + em() * 0.3f;
    addTextWithBackdrop(draw, at, {0.5f, 1}, colors.cursor, text.c_str());
    return {{at.x - size.x / 2, at.y - size.y}, {at.x + size.x / 2, at.y}};
}

namespace {

/// Texts of axes, which leave out what would lie over another one.
class AxisTexts {
public:
    AxisTexts(ImDrawList& draw, const TesseractFrame& frame, std::vector<std::pair<ImVec2, ImVec2>> taken)
        : draw_(draw), frame_(frame), taken_(std::move(taken)) {}

    bool write(ImVec2 on, ImU32 color, const std::string& text) {
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        if (size.x > frame_.max.x - frame_.min.x || size.y > frame_.max.y - frame_.min.y) return false;
        const ImVec2 at{std::clamp(on.x, frame_.min.x + size.x / 2, frame_.max.x - size.x / 2),
                        std::clamp(on.y, frame_.min.y + size.y / 2, frame_.max.y - size.y / 2)};
        const ImVec2 lo{at.x - size.x / 2, at.y - size.y / 2}, hi{at.x + size.x / 2, at.y + size.y / 2};
        for (const auto& [min, max] : taken_)
            if (lo.x < max.x && min.x < hi.x && lo.y < max.y && min.y < hi.y) return false;
        taken_.emplace_back(lo, hi);
        addTextWithBackdrop(draw_, at, {0.5f, 0.5f}, color, text.c_str());
        return true;
    }

    /// Ticks between the ends of an edge that leads from `from` to `to`, and numbers at those that have room.
    void ticks(const vis::PointN& from, const vis::PointN& to, std::size_t axis, ImU32 color) {
        const TesseractAxis& own = frame_.axes[axis];
        const Range shown{own.range.lo * own.perUnit, own.range.hi * own.perUnit};
        if (!own.even || shown.hi <= shown.lo) return;
        const ImVec2 a = frame_.pixel(frame_.project(from).at), b = frame_.pixel(frame_.project(to).at);
        const float length = std::hypot(b.x - a.x, b.y - a.y);
        if (length < em() * 4) return;
        const ImVec2 across{(a.y - b.y) / length, (b.x - a.x) / length};
        for (const double value : niceTicks(shown, std::max(2, int(length / (em() * 5))))) {
            double share = (value - shown.lo) / (shown.hi - shown.lo);
            if (share < 0.02 || share > 0.98) continue; // numbers stand at the ends
            if (to[axis] < from[axis]) share = 1 - share;
            const ImVec2 at = frame_.pixel(frame_.project(between(from, to, share)).at);
            const float reach = em() * 0.3f;
            draw_.AddLine({at.x - across.x * reach, at.y - across.y * reach},
                          {at.x + across.x * reach, at.y + across.y * reach}, color, em() * 0.1f);
            // Below the edge, which lies furthest down.
            const float side = across.y > 0 ? 1.0f : -1.0f;
            write({at.x + across.x * side * em() * 1.1f, at.y + across.y * side * em() * 1.1f}, color,
                  formatNumber(value, (shown.hi - shown.lo) / 100));
        }
    }

private:
    ImDrawList& draw_;
    const TesseractFrame& frame_;
    std::vector<std::pair<ImVec2, ImVec2>> taken_;
};

std::string endText(const TesseractAxis& axis, bool high) {
    const double digits = (axis.range.hi - axis.range.lo) * axis.perUnit / 100;
    return formatQuantity((high ? axis.range.hi : axis.range.lo) * axis.perUnit, axis.unit, digits);
}

/// The corner that lies furthest down: its edges have their names where they cross nothing else.
int lowestCorner(const TesseractFrame& frame) {
    int corner = 0;
    double lowest = 0;
    for (int i = 0; i < 1 << frame.count; ++i) {
        const double y = frame.project(vis::cornerOf(i, frame.half, frame.count)).at.y;
        if (i == 0 || y < lowest) lowest = y, corner = i;
    }
    return corner;
}

} // namespace

void drawAxisNames4(ImDrawList& draw, const TesseractFrame& frame, std::vector<std::pair<ImVec2, ImVec2>> taken) {
    const int corner = lowestCorner(frame);
    const vis::PointN from = vis::cornerOf(corner, frame.half, frame.count);
    const auto pixel = [&](const vis::PointN& at) { return frame.pixel(frame.project(at).at); };
    const auto colorOf = [&](std::size_t axis) {
        return axis < 3 ? axisColor(int(axis)) : axis == 3 ? fourthColor(frame, 0.75, 1) : plotColors().text;
    };
    AxisTexts texts(draw, frame, std::move(taken));
    const std::size_t count = std::min(std::size_t(frame.count), frame.axes.size());
    std::string here;
    for (std::size_t axis = 0; axis < count; ++axis) {
        const vis::PointN to = vis::cornerOf(corner ^ 1 << axis, frame.half, frame.count);
        const bool high = to[axis] > 0;
        const ImVec2 a = pixel(from), b = pixel(to);
        if (std::hypot(b.x - a.x, b.y - a.y) < em()) continue; // seen along it: both ends are there
        here += (here.empty() ? "" : axis < 3 ? ", " : "; ") + endText(frame.axes[axis], !high);
        texts.write(pixel(between(from, to, 0.6)), colorOf(axis), frame.axes[axis].name);
        texts.write(b, colorOf(axis), endText(frame.axes[axis], high));
    }
    texts.write(pixel(from), plotColors().faint, here);
    for (std::size_t axis = 0; axis < count; ++axis)
        texts.ticks(from, vis::cornerOf(corner ^ 1 << axis, frame.half, frame.count), axis, colorOf(axis));
}

std::string nearText(const TesseractFrame& frame) {
    if (frame.projection.parallel) return "parallel projection: nothing is larger for being near";
    // Row w of the rotation: how much each axis points towards the eye.
    struct Part {
        std::size_t axis;
        double share;
    };
    std::vector<Part> parts;
    for (std::size_t axis = 0; axis < frame.axes.size(); ++axis)
        parts.push_back({axis, frame.rotation.at(3, int(axis))});
    std::sort(parts.begin(), parts.end(), [](Part a, Part b) { return std::abs(a.share) > std::abs(b.share); });
    std::string text = "large = near in 4D: ";
    for (std::size_t i = 0; i < parts.size() && (i == 0 || std::abs(parts[i].share) > 0.3); ++i) {
        text += i > 0 ? ", " : "";
        text += parts[i].share > 0 ? "high " : "low ";
        text += frame.axes[parts[i].axis].name;
    }
    return text;
}

} // namespace tessera::app
