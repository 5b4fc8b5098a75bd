#include "app/views/shadow_cube/cube_axes.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr ImU32 kTickAlpha = 90;                ///< of lines on faces, of 255
constexpr float kBesideEm = 2, kBelowEm = 1.4f; ///< room that numbers and titles take, beside what the fit leaves
constexpr double kLeastShare = 0.85;

/// The edge along the data alone; nothing where that is too short on screen for numbers.
std::optional<LabelledEdge> alongData(const CubeFrame& frame, LabelledEdge edge) {
    edge.from[edge.axis] = frame.info.bounds.lo[edge.axis];
    edge.to[edge.axis] = frame.info.bounds.hi[edge.axis];
    const auto a = frame.space.pixel(edge.from), b = frame.space.pixel(edge.to);
    if (!a || !b || std::hypot(b->x - a->x, b->y - a->y) < em() * 2.5f) return std::nullopt;
    edge.a = *a;
    edge.b = *b;
    return edge;
}

/// Of the edges along an axis at which two visible faces meet, the lowest in the picture, rather the left one.
std::optional<LabelledEdge> innerEdge(const CubeFrame& frame, int axis) {
    std::optional<LabelledEdge> best;
    float bestScore = 0;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const bool highU : {false, true})
        for (const bool highV : {false, true}) {
            if (!facesViewer({u, highU}, frame.half, frame.camera) ||
                !facesViewer({v, highV}, frame.half, frame.camera))
                continue;
            glm::dvec3 place(0);
            place[u] = (highU ? 1 : -1) * frame.half[u];
            place[v] = (highV ? 1 : -1) * frame.half[v];
            const glm::dvec3 physical = frame.world.toPhysical(place);
            auto edge = alongData(frame, {axis, physical, physical, {}, {}, {}});
            if (!edge) continue;
            const ImVec2 along{edge->b.x - edge->a.x, edge->b.y - edge->a.y};
            const float size = std::hypot(along.x, along.y), side = along.x > 0 ? 1.0f : -1.0f;
            edge->outward = {-side * along.y / size, side * along.x / size}; // downwards
            const float score = (edge->a.y + edge->b.y) - 0.5f * (edge->a.x + edge->b.x);
            if (best && score <= bestScore) continue;
            best = edge;
            bestScore = score;
        }
    return best;
}

/// Rectangles along edges, which titles keep clear of.
void addEdges(const std::vector<LabelledEdge>& edges, Rectangles& taken) {
    constexpr int kPieces = 16;
    for (const LabelledEdge& edge : edges)
        for (int i = 0; i < kPieces; ++i) {
            const auto at = [&](int k) {
                const float along = float(k) / kPieces;
                return ImVec2{edge.a.x + (edge.b.x - edge.a.x) * along, edge.a.y + (edge.b.y - edge.a.y) * along};
            };
            const ImVec2 a = at(i), b = at(i + 1);
            taken.push_back(
                {{std::min(a.x, b.x) - 1, std::min(a.y, b.y) - 1}, {std::max(a.x, b.x) + 1, std::max(a.y, b.y) + 1}});
        }
}

/// Rectangles over what the data cover on a face of a box with these half edges.
void addPieces(const CubeFrame& frame, const CubeFace& face, glm::dvec3 half, Rectangles& taken) {
    constexpr int kPieces = 8; // a side
    const double right = frame.world.halfSize[face.right()], up = frame.world.halfSize[face.up()];
    for (int j = 0; j < kPieces; ++j)
        for (int i = 0; i < kPieces; ++i) {
            std::optional<std::pair<ImVec2, ImVec2>> piece;
            for (const auto& [x, y] : {std::pair(i, j), {i + 1, j}, {i, j + 1}, {i + 1, j + 1}}) {
                const auto at =
                    frame.pixel(face.at((2.0 * x / kPieces - 1) * right, (2.0 * y / kPieces - 1) * up, half));
                if (!at) continue;
                if (!piece) piece = {*at, *at};
                piece->first = {std::min(piece->first.x, at->x), std::min(piece->first.y, at->y)};
                piece->second = {std::max(piece->second.x, at->x), std::max(piece->second.y, at->y)};
            }
            if (piece) taken.push_back(*piece);
        }
}

} // namespace

glm::dvec2 cubeShare(const ShadowCubeView& view, ImVec2 size) {
    if (!view.showAxes) return glm::dvec2(1);
    const auto left = [](float whole, float room) { return std::max(kLeastShare, 1 - 2 * double(room / whole)); };
    return {left(size.x, em() * kBesideEm), left(size.y, em() * kBelowEm)};
}

std::vector<LabelledEdge> cubeEdges(const CubeFrame& frame, const Rectangles& taken) {
    SpaceFrame cube = frame.space;
    cube.bounds = {frame.world.toPhysical(-frame.half), frame.world.toPhysical(frame.half)};
    cube.world.halfSize = frame.half;
    std::vector<LabelledEdge> edges;
    for (const LabelledEdge& edge : labelledEdges(cube, eyeOf(frame.camera), taken))
        if (const auto shorter = alongData(frame, edge)) edges.push_back(*shorter);
    for (int axis = 0; axis < 3; ++axis)
        if (std::ranges::find(edges, axis, &LabelledEdge::axis) == edges.end())
            if (const auto inner = innerEdge(frame, axis)) edges.push_back(*inner);
    return edges;
}

void drawCubeAxes(ImDrawList& draw, const CubeFrame& frame, const std::vector<LabelledEdge>& edges,
                  const AxisLabels& labels, Rectangles& taken) {
    Rectangles avoid = taken;
    for (const CubeFace& face : kCubeFaces) {
        // The data themselves, and their projection.
        addPieces(frame, face, frame.world.halfSize, avoid);
        if (facesViewer(face, frame.half, frame.camera)) addPieces(frame, face, frame.half, avoid);
    }
    const auto before = static_cast<std::ptrdiff_t>(avoid.size());
    drawLabelledEdges(draw, frame.space, edges, labels, avoid);
    taken.insert(taken.end(), avoid.begin() + before, avoid.end());
    addEdges(edges, taken);
}

void drawFaceTicks(ImDrawList& draw, const CubeFrame& frame, const std::vector<LabelledEdge>& edges,
                   const AxisLabels& labels, const CubeFace& face) {
    for (const LabelledEdge& edge : edges) {
        if (edge.axis == face.axis) continue;
        const bool runsRight = edge.axis == face.right();
        const int across = runsRight ? face.up() : face.right();
        const AxisLabel& label = labels[static_cast<std::size_t>(edge.axis)];
        const ImU32 color = (axisColor(edge.axis) & ~IM_COL32_A_MASK) | (kTickAlpha << IM_COL32_A_SHIFT);
        for (const double value : ticksAlong(edge, label).values) {
            glm::dvec3 physical = edge.from;
            physical[edge.axis] = value / label.unit.perUnit;
            const double place = frame.world.toWorld(physical)[edge.axis];
            const auto at = [&](double other) {
                return frame.pixel(runsRight ? face.at(place, other, frame.half) : face.at(other, place, frame.half));
            };
            for (const double end : {-1.0, 1.0}) {
                const auto a = at(end * frame.world.halfSize[across]), b = at(end * frame.half[across]);
                if (a && b) draw.AddLine(*a, *b, color);
            }
        }
    }
}

} // namespace tessera::app
