#include "app/drawing/line_pieces.h"

#include <optional>
#include <utility>

namespace tessera::app {

namespace {

double turned(glm::dvec2 a, glm::dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

/// Which part of a stretch lies in the polygon, as shares of its length: what each edge leaves of it (M. Cyrus,
/// J. Beck: Generalized two- and three-dimensional clipping, 1978).
std::optional<std::pair<double, double>> shareWithin(glm::dvec2 from, glm::dvec2 to,
                                                     const std::vector<glm::dvec2>& polygon, double side) {
    double first = 0, last = 1;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 corner = polygon[i], edge = polygon[(i + 1) % polygon.size()] - corner;
        const double a = side * turned(edge, from - corner), b = side * turned(edge, to - corner);
        if (a < 0 && b < 0) return std::nullopt;
        if (a < 0) first = std::max(first, a / (a - b));
        if (b < 0) last = std::min(last, a / (a - b));
    }
    return first < last ? std::optional(std::pair(first, last)) : std::nullopt;
}

} // namespace

std::vector<std::vector<glm::dvec2>> piecesWithin(const std::vector<glm::dvec2>& line,
                                                  const std::vector<glm::dvec2>& polygon) {
    std::vector<std::vector<glm::dvec2>> pieces;
    if (polygon.size() < 3) return pieces;
    double area = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) area += turned(polygon[i], polygon[(i + 1) % polygon.size()]);
    bool joined = false; // the last piece ends where the next stretch begins
    for (std::size_t i = 1; i < line.size(); ++i) {
        const auto share = shareWithin(line[i - 1], line[i], polygon, area < 0 ? -1 : 1);
        if (!share) {
            joined = false;
            continue;
        }
        const auto at = [&](double s) { return s == 1 ? line[i] : line[i - 1] + (line[i] - line[i - 1]) * s; };
        if (!joined || share->first > 0) pieces.push_back({at(share->first)});
        pieces.back().push_back(at(share->second));
        joined = share->second == 1;
    }
    return pieces;
}

} // namespace tessera::app
