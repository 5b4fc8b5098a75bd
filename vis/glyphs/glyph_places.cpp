#include "vis/glyphs/glyph_places.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <random>

namespace tessera::vis {

namespace {

constexpr double kLeastWeight = 0.02; ///< lower ones do not lie farther apart

/// Numbers in 0..1; distributions of the standard library differ between implementations.
class RandomShares {
public:
    explicit RandomShares(std::uint32_t seed) : engine_(seed) {}
    double operator()() { return double(engine_() >> 11) * 0x1p-53; }

private:
    std::mt19937_64 engine_;
};

/// The box of the places as drawn: edges that have no length are left out.
struct PlaceBox {
    glm::dvec3 lo{0}, edges{0};
    int dimensions() const { return (edges.x > 0) + (edges.y > 0) + (edges.z > 0); }
};

PlaceBox placeBox(const GlyphSpace& space) {
    const glm::dvec3 a = space.from * space.stretch, b = space.to * space.stretch;
    PlaceBox box{glm::min(a, b), glm::abs(b - a)};
    if (space.place != GlyphPlace::Plane) return box;
    const int across = thinnestAxis(box.edges);
    box.lo[across] += 0.5 * box.edges[across];
    box.edges[across] = 0;
    return box;
}

/// As many columns of a grid along each axis as keep `step` between them.
glm::ivec3 gridOf(glm::dvec3 edges, double step) {
    glm::ivec3 size(1);
    for (int axis = 0; axis < 3; ++axis) size[axis] = std::max(1, int(std::min(edges[axis] / step + 1e-9, 1e6)));
    return size;
}

double countOf(glm::ivec3 size) {
    return double(size.x) * size.y * size.z;
}

std::vector<glm::dvec3> onGrid(const GlyphSpace& space) {
    const PlaceBox box = placeBox(space);
    const double longest = std::max({box.edges.x, box.edges.y, box.edges.z});
    if (!(longest > 0)) return {box.lo};
    double wide = longest * 2, narrow = std::max(space.apart, longest / 1e5);
    if (countOf(gridOf(box.edges, narrow)) > space.count)
        for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * (wide + narrow);
            (countOf(gridOf(box.edges, middle)) > space.count ? narrow : wide) = middle;
        }
    else
        wide = narrow;
    const glm::ivec3 size = gridOf(box.edges, wide);
    std::vector<glm::dvec3> out;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                out.push_back(box.lo + box.edges * ((glm::dvec3(x, y, z) + 0.5) / glm::dvec3(size)));
    return out;
}

/// Even distances from end to end, or at random.
std::vector<glm::dvec3> onLine(const GlyphSpace& space, int count, bool even, RandomShares& random) {
    const glm::dvec3 a = space.from * space.stretch, b = space.to * space.stretch;
    const double length = glm::distance(a, b);
    if (even && space.apart > 0) count = std::min(count, int(std::min(length / space.apart + 1 + 1e-9, 1e6)));
    std::vector<glm::dvec3> out;
    for (int i = 0; i < count; ++i)
        out.push_back(glm::mix(a, b, !even ? random() : count > 1 ? double(i) / (count - 1) : 0.5));
    return out;
}

/// Random points of a mesh, as dense everywhere as it is drawn.
std::vector<GlyphStand> onSurface(const GlyphSpace& space, int count, RandomShares& random) {
    const volume::SurfaceMesh& mesh = *space.surface;
    const auto corner = [&](std::uint32_t v) { return (mesh.origin + glm::dvec3(mesh.positions[v])) * space.stretch; };
    std::vector<double> areas;
    double total = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a = corner(t.x);
        areas.push_back(total += glm::length(glm::cross(corner(t.y) - a, corner(t.z) - a)));
    }
    std::vector<GlyphStand> out;
    if (!(total > 0)) return out;
    const glm::dvec3 lo = glm::min(space.from, space.to), hi = glm::max(space.from, space.to);
    for (int i = 0; i < count; ++i) {
        const auto found = std::ranges::upper_bound(areas, random() * total);
        const auto n = std::min(std::size_t(found - areas.begin()), areas.size() - 1);
        const glm::uvec3& t = mesh.triangles[n];
        const glm::dvec3 a = corner(t.x), b = corner(t.y), c = corner(t.z);
        double u = random(), v = random();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const glm::dvec3 place = (a + (b - a) * u + (c - a) * v) / space.stretch;
        if (glm::any(glm::lessThan(place, lo)) || glm::any(glm::greaterThan(place, hi))) continue;
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        if (glm::length(normal) > 0) out.push_back({place, glm::normalize(normal)});
    }
    return out;
}

/// Candidates of blue noise, in random order.
std::vector<GlyphStand> candidates(const GlyphSpace& space) {
    const int count = int(std::min(600'000L, 16L * space.count + 400));
    RandomShares random(space.random);
    if (space.place == GlyphPlace::Surface) return onSurface(space, count, random);
    std::vector<GlyphStand> out;
    if (space.place == GlyphPlace::Line) {
        for (const glm::dvec3& at : onLine(space, count, false, random)) out.push_back({at / space.stretch});
        return out;
    }
    const PlaceBox box = placeBox(space);
    for (int i = 0; i < count; ++i) {
        glm::dvec3 share;
        for (int axis = 0; axis < 3; ++axis) share[axis] = random();
        out.push_back({(box.lo + box.edges * share) / space.stretch});
    }
    return out;
}

/// Points that are kept, in cells, so that near ones are found.
class KeptPoints {
public:
    KeptPoints(double cell, std::size_t most) : cell_(cell) {
        std::size_t size = 64;
        while (size < most) size *= 2;
        heads_.assign(size, -1);
    }
    bool anyWithin(glm::dvec3 at, double distance) const {
        const auto near = [&](const glm::dvec3& point) {
            const glm::dvec3 way = point - at;
            return glm::dot(way, way) < distance * distance;
        };
        const glm::ivec3 lo = cellOf(at - distance), hi = cellOf(at + distance);
        const glm::dvec3 cells = glm::dvec3(hi - lo) + 1.0;
        if (cells.x * cells.y * cells.z > double(points_.size())) return std::ranges::any_of(points_, near);
        for (int z = lo.z; z <= hi.z; ++z)
            for (int y = lo.y; y <= hi.y; ++y)
                for (int x = lo.x; x <= hi.x; ++x)
                    for (int i = heads_[slot({x, y, z})]; i >= 0; i = next_[std::size_t(i)])
                        if (near(points_[std::size_t(i)])) return true;
        return false;
    }
    void add(glm::dvec3 at) {
        int& head = heads_[slot(cellOf(at))];
        next_.push_back(head);
        head = int(points_.size());
        points_.push_back(at);
    }

private:
    glm::ivec3 cellOf(glm::dvec3 at) const { return glm::ivec3(glm::floor(at / cell_)); }
    std::size_t slot(glm::ivec3 cell) const {
        const auto part = [](int n, std::uint64_t factor) { return std::uint64_t(std::uint32_t(n)) * factor; };
        const std::uint64_t mixed =
            part(cell.x, 0x9E3779B97F4A7C15u) ^ part(cell.y, 0xC2B2AE3D27D4EB4Fu) ^ part(cell.z, 0x165667B19E3779F9u);
        return std::size_t(mixed >> 20) & (heads_.size() - 1);
    }
    double cell_;
    std::vector<int> heads_, next_;
    std::vector<glm::dvec3> points_;
};

struct Dart {
    glm::dvec3 at; ///< as drawn, less the first of all
    double reach;  ///< distance per distance of those with weight 1
};

/// Which of the darts stay if those of weight 1 are at least `distance` apart, and none nearer than `apart`.
std::vector<std::size_t> thrown(const std::vector<Dart>& darts, double distance, double apart) {
    KeptPoints kept(std::max(distance, apart), darts.size() / 2);
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < darts.size(); ++i) {
        if (kept.anyWithin(darts[i].at, std::max(apart, distance * darts[i].reach))) continue;
        kept.add(darts[i].at);
        out.push_back(i);
    }
    return out;
}

/// As evenly distributed as `count` of them can be.
std::vector<std::size_t> spread(const std::vector<Dart>& darts, const GlyphSpace& space, int dimensions) {
    if (darts.empty()) return {};
    glm::dvec3 lo = darts.front().at, hi = lo;
    for (const Dart& dart : darts) lo = glm::min(lo, dart.at), hi = glm::max(hi, dart.at);
    const double reach = std::max(glm::distance(lo, hi), 1e-300), wanted = space.count;
    const double least = std::max(space.apart, reach * 1e-4);
    std::vector<std::size_t> best; // the fewest that are enough, else the most
    double enough = 0, few = 0;    // distances that leave enough, and too few; 0: not known
    double distance = std::max(least, reach / std::pow(wanted, 1.0 / dimensions));
    for (int i = 0; i < 14; ++i) {
        auto kept = thrown(darts, distance, space.apart);
        const auto count = double(kept.size());
        if (count >= wanted || (enough == 0 && kept.size() > best.size())) best = std::move(kept);
        (count >= wanted ? enough : few) = distance;
        if ((count >= wanted && count <= wanted * 1.02) || (count < wanted && distance <= least)) break;
        distance = enough > 0 && few > 0 ? 0.5 * (enough + few)
                                         : std::max(least, distance * std::pow(count / wanted, 1.0 / dimensions) *
                                                               (count >= wanted ? 1.05 : 0.95));
    }
    if (double(best.size()) > wanted) best.resize(std::size_t(space.count));
    return best;
}

} // namespace

int thinnestAxis(glm::dvec3 edges) {
    int axis = 2;
    for (const int other : {1, 0})
        if (edges[other] < edges[axis]) axis = other;
    return axis;
}

std::vector<GlyphStand> placeGlyphs(const GlyphSpace& space, const GlyphWeights& weights) {
    std::vector<GlyphStand> stands;
    if (space.place == GlyphPlace::Surface && !space.surface) return stands;
    RandomShares random(space.random ^ 0x5bd1e995u);
    if (space.place == GlyphPlace::Cursor) {
        stands.push_back({space.cursor});
    } else if (space.even && space.place != GlyphPlace::Surface) {
        const auto places = space.place == GlyphPlace::Line ? onLine(space, space.count, true, random) : onGrid(space);
        for (const glm::dvec3& at : places) stands.push_back({at / space.stretch});
    } else {
        const std::vector<GlyphStand> all = candidates(space);
        const std::vector<double> weight = weights(all);
        const int dimensions = space.place == GlyphPlace::Surface ? 2
                               : space.place == GlyphPlace::Line  ? 1
                                                                  : std::max(placeBox(space).dimensions(), 1);
        std::vector<Dart> darts;
        std::vector<std::size_t> of;
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (!(random() < weight[i])) continue;
            darts.push_back({(all[i].place - all.front().place) * space.stretch,
                             std::pow(std::max(weight[i], kLeastWeight), -1.0 / dimensions)});
            of.push_back(i);
        }
        for (const std::size_t i : spread(darts, space, dimensions)) stands.push_back(all[of[i]]);
        return stands;
    }
    const std::vector<double> weight = weights(stands);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < stands.size(); ++i)
        if (weight[i] > 0) stands[kept++] = stands[i];
    stands.resize(kept);
    return stands;
}

} // namespace tessera::vis
