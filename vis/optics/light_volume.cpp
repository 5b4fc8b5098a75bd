#include "vis/optics/light_volume.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::vis {

LightGrid lightGrid(const WorldFrame& frame, const Shadows& shadows) {
    LightGrid grid;
    grid.halfSize = glm::max(frame.halfSize, glm::dvec3(1e-5));
    grid.size = glm::max(glm::ivec3(glm::round(2.0 * grid.halfSize * double(shadows.resolution))), glm::ivec3(1));
    return grid;
}

namespace {

/// Slice-by-slice propagation of a directional light through a grid.
struct Sweep {
    int axis = 2, u = 0, v = 1; ///< axis across the slices, and the two within them
    int first = 0, last = 0, step = 1;
    double length = 0;     ///< world distance between slices along the light
    int du = 0, dv = 0;    ///< offset of the lower of the two upstream neighbours per axis
    double wu = 0, wv = 0; ///< interpolation weight of the upper one

    Sweep(const LightGrid& grid, glm::dvec3 towards) {
        const glm::dvec3 e = towards / grid.cell();
        for (int i = 0; i < 3; ++i)
            if (std::abs(e[i]) > std::abs(e[axis]) + 1e-12) axis = i;
        u = (axis + 1) % 3;
        v = (axis + 2) % 3;
        const glm::dvec3 perSlice = e / std::abs(e[axis]);
        length = glm::length(perSlice * grid.cell());
        step = e[axis] > 0 ? -1 : 1;
        first = step > 0 ? 0 : grid.size[axis] - 1;
        last = grid.size[axis] - 1 - first;
        du = int(std::floor(perSlice[u]));
        dv = int(std::floor(perSlice[v]));
        wu = perSlice[u] - du;
        wv = perSlice[v] - dv;
    }

    /// Calls visit(cell index, upstream) for every cell, starting at the light; upstream(of) interpolates `of(cell
    /// index)` in the previous slice, shifted by (a, b) cells within it; `outside` applies beyond the grid.
    template <class Visit> void run(const LightGrid& grid, std::stop_token stop, Visit visit) const {
        for (int s = first;; s += step) {
            if (stop.stop_requested()) return;
            for (int j = 0; j < grid.size[v]; ++j)
                for (int i = 0; i < grid.size[u]; ++i) {
                    const auto cellAt = [&](int slice, int a, int b) {
                        glm::ivec3 at;
                        at[axis] = slice;
                        at[u] = a;
                        at[v] = b;
                        return grid.index(at);
                    };
                    const auto upstream = [&](auto of, auto outside, int a, int b) {
                        decltype(outside) sum(0);
                        for (int q = 0; q < 2; ++q)
                            for (int p = 0; p < 2; ++p) {
                                using Scalar = std::decay_t<decltype(outside.x)>;
                                const auto weight = Scalar((p == 0 ? 1 - wu : wu) * (q == 0 ? 1 - wv : wv));
                                const int x = i + du + p + a, y = j + dv + q + b;
                                const bool in = s != first && x >= 0 && y >= 0 && x < grid.size[u] && y < grid.size[v];
                                sum += weight * (in ? of(cellAt(s - step, x, y)) : outside);
                            }
                        return sum;
                    };
                    visit(cellAt(s, i, j), upstream);
                }
            if (s == last) return;
        }
    }
};

template <class Number> struct Spreader {
    using Vec2 = glm::vec<2, Number>;
    using Vec3 = glm::vec<3, Number>;
    using Vec4 = glm::vec<4, Number>;
    const LightGrid& grid;
    const Medium<Number>& medium;
    std::stop_token stop;

    /// Optical depth towards a directional light, attenuated with distance over `reach` (infinite: not attenuated).
    std::vector<Number> depthTo(glm::dvec3 towards, double reach) const {
        const Sweep sweep(grid, towards);
        std::vector<Number> depth(grid.count());
        const auto fade = Number(std::exp(-sweep.length / reach)), half = Number(sweep.length / 2);
        sweep.run(grid, stop, [&](std::size_t cell, auto upstream) {
            const Vec2 before =
                upstream([&](std::size_t from) { return Vec2(depth[from], medium[from].a); }, Vec2(0), 0, 0);
            depth[cell] = fade * (before.x + half * before.y) + half * medium[cell].a;
        });
        return depth;
    }

    /// Optical depth towards a point light.
    std::vector<Number> depthToPoint(glm::dvec3 light) const {
        std::vector<Number> depth(grid.count());
        const glm::dvec3 cell = grid.cell();
        const double wanted = 0.5 * std::min({cell.x, cell.y, cell.z});
        parallelFor(std::size_t(grid.size.z), [&](std::size_t z) {
            for (int y = 0; y < grid.size.y && !stop.stop_requested(); ++y)
                for (int x = 0; x < grid.size.x; ++x) {
                    const glm::ivec3 at(x, y, int(z));
                    const glm::dvec3 from = grid.center(at), way = light - from;
                    // March only to the boundary of the box.
                    double reach = 1;
                    for (int i = 0; i < 3; ++i)
                        if (way[i] != 0)
                            reach = std::min(reach,
                                             ((way[i] > 0 ? grid.halfSize[i] : -grid.halfSize[i]) - from[i]) / way[i]);
                    const double length = glm::length(way) * std::max(reach, 0.0);
                    const int steps = std::max(1, int(std::ceil(length / wanted)));
                    Number sum = 0;
                    for (int k = 0; k < steps; ++k) sum += extinctionAt(from + way * (reach * (k + 0.5) / steps));
                    depth[grid.index(at)] = sum * Number(length / steps);
                }
        });
        return depth;
    }

    Number extinctionAt(glm::dvec3 world) const {
        const glm::dvec3 p = (world + grid.halfSize) / grid.cell() - 0.5;
        const glm::ivec3 lo(glm::floor(p));
        const glm::dvec3 w = p - glm::dvec3(lo);
        Number sum = 0;
        for (int c = 0; c < 8; ++c) {
            const glm::ivec3 at = lo + glm::ivec3(c & 1, c >> 1 & 1, c >> 2);
            if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, grid.size))) continue;
            double weight = 1;
            for (int i = 0; i < 3; ++i) weight *= at[i] == lo[i] ? 1 - w[i] : w[i];
            sum += Number(weight) * medium[grid.index(at)].a;
        }
        return sum;
    }

    /// The excess of the forward-scattered light, colour 1, over the direct light.
    std::vector<Vec3> scatteredFrom(glm::dvec3 towards, const std::vector<Number>& depth, double translucency,
                                    double scatter) const {
        const Sweep sweep(grid, towards);
        std::vector<Vec3> light(grid.count()), more(grid.count());
        const auto half = Number(sweep.length / 2), aside = Number(scatter / 8), t = Number(translucency);
        const auto extinction = [&](std::size_t cell) {
            return glm::max(Vec3(medium[cell].a) - t * Vec3(medium[cell]), Vec3(0));
        };
        const auto lightOf = [&](std::size_t from) { return light[from]; };
        sweep.run(grid, stop, [&](std::size_t cell, auto upstream) {
            Vec3 before = (1 - 4 * aside) * upstream(lightOf, Vec3(1), 0, 0);
            for (const auto& [a, b] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
                before += aside * upstream(lightOf, Vec3(1), a, b);
            const Vec3 way = half * (upstream(extinction, Vec3(0), 0, 0) + extinction(cell));
            light[cell] = before * glm::exp(-way);
            more[cell] = glm::max(light[cell] - std::exp(-depth[cell]), Vec3(0));
        });
        return more;
    }
};

} // namespace

template <class Number> auto LightVolume<Number>::visibleAt(glm::dvec3 world) const -> Vec4 {
    return Vec4(betweenCells<double>(grid, world, [&](double i) { return glm::dvec4(visible[std::size_t(i)]); }));
}
template <class Number> auto LightVolume<Number>::scatteredAt(glm::dvec3 world) const -> Vec3 {
    if (scattered.empty()) return Vec3(0);
    return Vec3(betweenCells<double>(grid, world, [&](double i) { return glm::dvec3(scattered[std::size_t(i)]); }));
}

template <class Number>
LightVolume<Number> spreadLight(const LightGrid& grid, const Medium<Number>& medium,
                                std::span<const PlacedLight> lights, const Shadows& shadows, std::stop_token stop) {
    using Vec3 = glm::vec<3, Number>;
    const Spreader<Number> spreader{grid, medium, stop};
    LightVolume<Number> out;
    out.grid = grid;
    out.visible.assign(grid.count(), glm::vec<4, Number>(1));
    const bool translucent = shadows.translucency > 0;
    if (translucent) out.scattered.assign(grid.count(), Vec3(0));
    const std::size_t casting =
        shadows.strength > 0 || translucent ? std::min<std::size_t>(lights.size(), kShadowLights) : 0;
    for (std::size_t i = 0; i < casting; ++i) {
        const PlacedLight& light = lights[i];
        const std::vector<Number> depth =
            light.point ? spreader.depthToPoint(light.place) : spreader.depthTo(light.place, 1e30);
        for (std::size_t c = 0; c < depth.size(); ++c) out.visible[c][int(i)] = std::exp(-depth[c]);
        if (!translucent || light.point) continue;
        const std::vector<Vec3> more =
            spreader.scatteredFrom(light.place, depth, double(shadows.translucency), double(shadows.scatter));
        for (std::size_t c = 0; c < more.size(); ++c) out.scattered[c] += Vec3(light.color) * more[c];
    }
    if (shadows.occlusion > 0) {
        std::vector<Number> open(grid.count(), Number(0));
        int count = 0;
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) {
                    const int sides = std::abs(x) + std::abs(y) + std::abs(z);
                    if (sides != 1 && sides != 3) continue;
                    const std::vector<Number> depth =
                        spreader.depthTo(glm::normalize(glm::dvec3(x, y, z)), double(shadows.reach));
                    for (std::size_t c = 0; c < depth.size(); ++c) open[c] += std::exp(-depth[c]);
                    ++count;
                }
        for (std::size_t c = 0; c < open.size(); ++c)
            out.visible[c].a = std::min(Number(1), 2 * open[c] / Number(count));
    }
    return out;
}

template struct LightVolume<float>;
template struct LightVolume<double>;
template LightVolume<float> spreadLight(const LightGrid&, const Medium<float>&, std::span<const PlacedLight>,
                                        const Shadows&, std::stop_token);
template LightVolume<double> spreadLight(const LightGrid&, const Medium<double>&, std::span<const PlacedLight>,
                                         const Shadows&, std::stop_token);

} // namespace tessera::vis
