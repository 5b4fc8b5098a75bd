#include "volume/flow/even_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>

namespace tessera::volume {

namespace {

constexpr double kPointsApart = 0.25;  ///< of the separation: what stands for a line in the grid
constexpr double kOwnWay = 1.6;        ///< separations along a line within which it may be near to itself
constexpr double kMostGridSeeds = 2e5; ///< of the grid that is searched for empty places

/// Points of lines in cells as large as the separation.
class OccupiedCells {
public:
    OccupiedCells(glm::dvec3 origin, double edge) : origin_(origin), edge_(edge) {}
    /// `way`: along the line that is being made, for points of itself.
    void add(glm::dvec3 place, double way = std::numeric_limits<double>::infinity()) {
        cells_[keyOf(place)].push_back({place, way});
    }
    void clear() { cells_.clear(); }
    /// Whether a point that is farther than `apart` along the same line lies nearer than `distance` (one edge at most).
    bool near(glm::dvec3 place, double distance, double way = 0, double apart = 0) const {
        const Key middle = keyOf(place);
        for (std::int64_t x = -1; x <= 1; ++x)
            for (std::int64_t y = -1; y <= 1; ++y)
                for (std::int64_t z = -1; z <= 1; ++z) {
                    const auto cell = cells_.find({middle[0] + x, middle[1] + y, middle[2] + z});
                    if (cell == cells_.end()) continue;
                    for (const Point& point : cell->second)
                        if (std::abs(point.way - way) >= apart && glm::distance(point.place, place) < distance)
                            return true;
                }
        return false;
    }

private:
    struct Point {
        glm::dvec3 place;
        double way;
    };
    using Key = std::array<std::int64_t, 3>;
    Key keyOf(glm::dvec3 place) const {
        const glm::dvec3 cell = glm::floor((place - origin_) / edge_);
        return {std::int64_t(cell.x), std::int64_t(cell.y), std::int64_t(cell.z)};
    }
    glm::dvec3 origin_;
    double edge_;
    std::map<Key, std::vector<Point>> cells_;
};

class EvenSpacing {
public:
    EvenSpacing(const std::function<std::vector<glm::dvec3>(glm::dvec3)>& trace,
                const std::function<bool(glm::dvec3)>& allowed, const EvenSettings& settings)
        : trace_(trace), allowed_(allowed), s_(settings), lo_(glm::min(s_.from, s_.to)), hi_(glm::max(s_.from, s_.to)),
          others_(lo_, s_.separation), own_(lo_, s_.separation) {}

    EvenLines make() {
        seed((lo_ + hi_) * 0.5);
        fill();
        const glm::dvec3 size = hi_ - lo_;
        // Wider than the separation if there are too many places.
        double edge = s_.separation;
        const auto places = [&] {
            return (1 + std::floor(size.x / edge)) * (1 + std::floor(size.y / edge)) * (1 + std::floor(size.z / edge));
        };
        while (places() > kMostGridSeeds) edge *= 1.25;
        const glm::ivec3 n = glm::ivec3(size / edge) + 1;
        for (int z = 0; z < n.z; ++z)
            for (int y = 0; y < n.y; ++y)
                for (int x = 0; x < n.x; ++x) {
                    seed(lo_ + size * ((glm::dvec3(x, y, z) + 0.5) / glm::dvec3(n)));
                    fill();
                }
        return std::move(out_);
    }

private:
    bool full() const { return int(out_.seeds.size()) >= s_.most; }

    /// Takes a seed, with its line, unless it is too near to a line.
    void seed(glm::dvec3 place) {
        for (int axis = 0; axis < 3; ++axis)
            if (place[axis] < lo_[axis] || place[axis] > hi_[axis]) return;
        if (full() || others_.near(place, s_.separation) || !allowed_(place)) return;
        const std::vector<glm::dvec3> whole = trace_(place);
        const auto at = std::find(whole.begin(), whole.end(), place);
        if (at == whole.end()) return;
        own_.clear();
        own_.add(place, 0);
        std::vector<glm::dvec3> back = side(std::vector(std::make_reverse_iterator(at), whole.rend()), place, -1);
        std::vector<glm::dvec3> line(back.rbegin(), back.rend());
        line.push_back(place);
        const std::vector<glm::dvec3> onward = side(std::vector(at + 1, whole.end()), place, 1);
        line.insert(line.end(), onward.begin(), onward.end());
        if (whole.size() > 1 && line.size() < 2) return;
        out_.seeds.push_back(place);
        for (std::size_t i = 0; i < line.size(); ++i)
            along(i > 0 ? line[i - 1] : line[i], line[i], [&](glm::dvec3 point) { others_.add(point); });
        out_.lines.push_back(std::move(line));
    }

    /// Points of a piece of a line, its end among them.
    template <class Use> void along(glm::dvec3 from, glm::dvec3 to, const Use& use) const {
        const int n = std::max(1, int(std::ceil(glm::distance(from, to) / (s_.separation * kPointsApart))));
        for (int i = 1; i <= n; ++i) use(i == n ? to : from + (to - from) * (double(i) / n));
    }

    /// What is kept of the vertices on one side of the seed.
    std::vector<glm::dvec3> side(const std::vector<glm::dvec3>& vertices, glm::dvec3 place, double sign) {
        const double least = s_.closest * s_.separation;
        std::vector<glm::dvec3> kept;
        double way = 0;
        for (const glm::dvec3& to : vertices) {
            bool near = false;
            double at = way;
            glm::dvec3 last = place;
            along(place, to, [&](glm::dvec3 point) {
                at += glm::distance(last, point);
                last = point;
                near =
                    near || others_.near(point, least) || own_.near(point, least, sign * at, kOwnWay * s_.separation);
                if (!near) own_.add(point, sign * at);
            });
            if (near) break;
            way = at;
            kept.push_back(place = to);
        }
        return kept;
    }

    /// Seeds beside lines until there is no room left.
    void fill() {
        for (; next_ < out_.lines.size() && !full(); ++next_) {
            const std::vector<glm::dvec3> line = out_.lines[next_];
            double way = s_.separation; // the first vertex has candidates
            for (std::size_t i = 0; i < line.size(); ++i) {
                if (i > 0) way += glm::distance(line[i - 1], line[i]);
                if (way < s_.separation) continue;
                way = 0;
                const glm::dvec3 along = line[std::min(i + 1, line.size() - 1)] - line[i > 0 ? i - 1 : 0];
                for (const glm::dvec3& side : sidesOf(along)) seed(line[i] + side * (s_.separation * (1 + 1e-9)));
            }
        }
    }

    /// Directions across a line, or any from a point, that stay in the plane of the box where it is one.
    std::vector<glm::dvec3> sidesOf(glm::dvec3 along) const {
        constexpr double kPi = 3.14159265358979323846;
        glm::dvec3 u(1, 0, 0), v(0, 1, 0);
        int flat = -1;
        for (int axis = 0; axis < 3; ++axis)
            if (lo_[axis] == hi_[axis]) flat = axis;
        const bool line = glm::length(along) > 0;
        if (flat >= 0) {
            glm::dvec3 normal(0);
            normal[flat] = 1;
            const glm::dvec3 side = line ? glm::cross(normal, along) : glm::dvec3(0);
            if (glm::length(side) > 0) return {glm::normalize(side), -glm::normalize(side)};
            u = v = glm::dvec3(0);
            u[(flat + 1) % 3] = v[(flat + 2) % 3] = 1;
        } else if (line) {
            const glm::dvec3 way = glm::normalize(along);
            u = glm::normalize(glm::cross(way, std::abs(way.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
            v = glm::cross(way, u);
        }
        std::vector<glm::dvec3> out;
        for (int i = 0; i < 6; ++i) out.push_back(u * std::cos(kPi * i / 3) + v * std::sin(kPi * i / 3));
        if (flat < 0 && !line) out.insert(out.end(), {glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)});
        return out;
    }

    const std::function<std::vector<glm::dvec3>(glm::dvec3)>& trace_;
    const std::function<bool(glm::dvec3)>& allowed_;
    EvenSettings s_;
    glm::dvec3 lo_, hi_;
    OccupiedCells others_, own_;
    EvenLines out_;
    std::size_t next_ = 0;
};

} // namespace

EvenLines evenLines(const std::function<std::vector<glm::dvec3>(glm::dvec3 seed)>& trace,
                    const std::function<bool(glm::dvec3 place)>& allowed, const EvenSettings& settings) {
    return EvenSpacing(trace, allowed, settings).make();
}

} // namespace tessera::volume
