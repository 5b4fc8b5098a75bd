#include "app/drawing/free_place.h"

#include "app/drawing/line_pieces.h"

#include <algorithm>
#include <vector>

namespace tessera::app {

using namespace shapes;

namespace {

constexpr double kInset = 4, kClear = 2; ///< points: from the edge of the plot, and from what is drawn

bool overlap(const PageBox& a, const PageBox& b) {
    return a.lo.x < b.hi.x && b.lo.x < a.hi.x && a.lo.y < b.hi.y && b.lo.y < a.hi.y;
}

/// Whether a place lies within points, by the number of edges to the right of it.
bool holds(const std::vector<glm::dvec2>& points, glm::dvec2 place) {
    bool inside = false;
    for (std::size_t i = 0, j = points.size() - 1; i < points.size(); j = i++) {
        const glm::dvec2 a = points[i], b = points[j];
        if ((a.y > place.y) != (b.y > place.y) && place.x < a.x + (b.x - a.x) * (place.y - a.y) / (b.y - a.y))
            inside = !inside;
    }
    return inside;
}

bool covers(const PageBox& box, const Mark& mark) {
    const std::vector<glm::dvec2> corners{box.lo, {box.hi.x, box.lo.y}, box.hi, {box.lo.x, box.hi.y}};
    if (const auto* stroke = std::get_if<Stroke>(&mark.shape)) return !piecesWithin(stroke->points, corners).empty();
    if (const auto* polygon = std::get_if<Polygon>(&mark.shape); polygon && !polygon->points.empty()) {
        std::vector<glm::dvec2> edge = polygon->points;
        edge.push_back(edge.front());
        return holds(polygon->points, box.lo) || !piecesWithin(edge, corners).empty();
    }
    if (const auto* rect = std::get_if<Rect>(&mark.shape)) return overlap(box, rect->box);
    if (const auto* circle = std::get_if<Circle>(&mark.shape))
        return overlap(box, {circle->center - circle->radius, circle->center + circle->radius});
    return false;
}

} // namespace

std::optional<PageBox> freePlace(glm::dvec2 size, const PageBox& plot, std::span<const Mark> marks) {
    const glm::dvec2 lo = plot.lo + kInset, room = plot.hi - kInset - size - lo;
    if (room.x < 0 || room.y < 0) return std::nullopt;
    for (const glm::dvec2 share : {glm::dvec2{1, 0}, {0, 0}, {1, 1}, {0, 1}, {1, 0.5}, {0, 0.5}, {0.5, 0}, {0.5, 1}}) {
        const PageBox box{lo + share * room, lo + share * room + size}, clear{box.lo - kClear, box.hi + kClear};
        if (std::ranges::none_of(marks, [&](const Mark& mark) { return covers(clear, mark); })) return box;
    }
    return std::nullopt;
}

} // namespace tessera::app
