#include "volume/analysis/contours.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <optional>

namespace tessera::volume {

namespace {

/// Edges between nodes are numbered: two for each node, to its right and upwards.
class LevelLines {
public:
    LevelLines(const PlaneValues& plane, double level)
        : plane_(plane), level_(level), next_(plane.values.size() * 2, {-1, -1}) {}

    std::vector<ContourLine> trace() {
        for (int j = 0; j + 1 < plane_.size.y; ++j)
            for (int i = 0; i + 1 < plane_.size.x; ++i) cross(i, j);
        std::vector<ContourLine> out;
        // Open lines first: the remaining ones are closed.
        for (const bool ring : {false, true})
            for (std::size_t edge = 0; edge < next_.size(); ++edge)
                if (next_[edge][0] >= 0 && (ring || next_[edge][1] < 0)) out.push_back(follow(int(edge)));
        std::erase_if(out, [](const ContourLine& line) { return line.points.size() < 2; });
        return out;
    }

private:
    std::size_t node(int i, int j) const { return std::size_t(j) * std::size_t(plane_.size.x) + std::size_t(i); }
    double value(int i, int j) const { return plane_.values[node(i, j)]; }
    bool above(int i, int j) const { return value(i, j) >= level_; }
    bool whole(int i, int j) const {
        const std::array<std::size_t, 4> corners{node(i, j), node(i + 1, j), node(i, j + 1), node(i + 1, j + 1)};
        return std::ranges::all_of(corners, [&](std::size_t corner) {
            return std::isfinite(plane_.values[corner]) &&
                   (plane_.parts.empty() || plane_.parts[corner] == plane_.parts[corners[0]]);
        });
    }

    void link(int a, int b) {
        for (const auto& [from, to] : {std::array{a, b}, std::array{b, a}}) {
            auto& ends = next_[std::size_t(from)];
            assert(ends[1] < 0); // an edge is between two cells, each with one line across it
            ends[ends[0] < 0 ? 0 : 1] = to;
        }
    }

    /// The lines through one cell.
    void cross(int i, int j) {
        if (!whole(i, j)) return;
        const bool corner[] = {above(i, j), above(i + 1, j), above(i + 1, j + 1),
                               above(i, j + 1)}; // in order around the cell
        const int edge[] = {int(node(i, j)) * 2, int(node(i + 1, j)) * 2 + 1, int(node(i, j + 1)) * 2,
                            int(node(i, j)) * 2 + 1}; // between a corner and the next
        std::array<int, 4> met{};
        int count = 0;
        for (int k = 0; k < 4; ++k)
            if (corner[k] != corner[(k + 1) % 4]) met[std::size_t(count++)] = k;
        if (count == 2) link(edge[met[0]], edge[met[1]]);
        if (count < 4) return;
        const double mean = (value(i, j) + value(i + 1, j) + value(i, j + 1) + value(i + 1, j + 1)) / 4;
        // Each line cuts off one corner that is on the other side of the level than the centre.
        const int first = (mean >= level_) == corner[0] ? 1 : 0;
        for (const int cut : {first, first + 2}) link(edge[(cut + 3) % 4], edge[cut % 4]);
    }

    glm::dvec2 point(int edge) const {
        const int n = edge / 2, i = n % plane_.size.x, j = n / plane_.size.x;
        const bool up = edge % 2 != 0;
        const double a = value(i, j), b = up ? value(i, j + 1) : value(i + 1, j), share = (level_ - a) / (b - a);
        return {i + (up ? 0 : share), j + (up ? share : 0)};
    }

    /// Follows a line from an edge to its other end, or around a ring, and marks the edges passed.
    ContourLine follow(int from) {
        ContourLine line{level_, {}};
        std::optional<int> edge = from;
        while (edge) {
            const glm::dvec2 at = point(*edge);
            if (line.points.empty() || line.points.back() != at) line.points.push_back(at);
            auto& ends = next_[std::size_t(*edge)];
            const int to = ends[0];
            if (to < 0) break;
            ends = {ends[1], -1};
            auto& back = next_[std::size_t(to)];
            back = back[0] == *edge ? std::array{back[1], -1} : std::array{back[0], -1};
            edge = to;
        }
        return line;
    }

    const PlaneValues& plane_;
    double level_;
    std::vector<std::array<int, 2>> next_; ///< the edges that a line goes on to, -1: none
};

} // namespace

std::vector<ContourLine> contourLines(const PlaneValues& plane, std::span<const double> levels) {
    assert(plane.values.size() == std::size_t(plane.size.x) * std::size_t(plane.size.y));
    std::vector<ContourLine> out;
    for (const double level : levels) {
        std::vector<ContourLine> lines = LevelLines(plane, level).trace();
        std::ranges::move(lines, std::back_inserter(out));
    }
    return out;
}

} // namespace tessera::volume
