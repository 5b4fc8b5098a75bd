#include "app/views/scatter3d/cloud_raster.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tessera::app {

namespace {

/// The share of each pixel in [from, to] that lies between two ends, of their distance; calls visit(pixel, share).
void forEachCovered(double lo, double hi, int pixels, const auto& visit) {
    const double length = std::max(hi - lo, 1e-9);
    const int first = std::max(0, static_cast<int>(std::floor(lo))),
              last = std::min(pixels - 1, static_cast<int>(std::ceil(hi)) - 1);
    for (int i = first; i <= last; ++i) {
        const double covered = std::min(hi, i + 1.0) - std::max(lo, double(i));
        if (covered > 0) visit(i, covered / length);
    }
}

} // namespace

std::array<glm::dvec3, 3> cloudDirections(glm::dvec2 turn) {
    const glm::dvec2 angle = turn * (std::numbers::pi / 180);
    const double c = std::cos(angle.x), s = std::sin(angle.x), ct = std::cos(angle.y), st = std::sin(angle.y);
    const glm::dvec3 right(c, s, 0), away(-s, c, 0), up(0, 0, 1);
    return {right, ct * up + st * away, ct * away - st * up};
}

glm::dvec2 CloudPlace::pixel(glm::dvec3 shares) const {
    const glm::dvec3 at = shares - 0.5;
    return middle + edge * glm::dvec2(glm::dot(directions[0], at), -glm::dot(directions[1], at));
}

std::optional<std::array<int, 2>> facedAxes(const std::array<glm::dvec3, 3>& directions) {
    std::array<int, 2> out{-1, -1};
    for (int k = 0; k < 2; ++k)
        for (int axis = 0; axis < 3; ++axis)
            if (directions[std::size_t(k)][axis] > 1 - 1e-9) out[std::size_t(k)] = axis;
    if (out[0] < 0 || out[1] < 0) return {};
    return out;
}

GapDensity rasterCloud(const volume::PlaceCounts& cube, int bins, const CloudPlace& place, int width, int height) {
    GapDensity out{width, height, {}, {}};
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    out.all.resize(pixels);
    out.selected.assign(cube.selected.size(), std::vector<double>(pixels));
    glm::dvec2 half(0); // of what a cell covers
    for (int k = 0; k < 2; ++k)
        for (int axis = 0; axis < 3; ++axis)
            half[k] += std::abs(place.directions[std::size_t(k)][axis]) * place.edge / bins / 2;
    const auto n = static_cast<std::size_t>(bins);
    for (std::size_t cell = 0; cell < cube.all.size(); ++cell) {
        if (cube.all[cell] == 0) continue;
        const glm::dvec3 at(double(cell / n / n), double(cell / n % n), double(cell % n));
        const glm::dvec2 middle = place.pixel((at + 0.5) / double(bins));
        forEachCovered(middle.y - half.y, middle.y + half.y, height, [&](int row, double shareY) {
            forEachCovered(middle.x - half.x, middle.x + half.x, width, [&](int column, double shareX) {
                const auto to =
                    static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
                out.all[to] += double(cube.all[cell]) * shareX * shareY;
                for (std::size_t g = 0; g < cube.selected.size(); ++g)
                    out.selected[g][to] += cube.selected[g][cell] * shareX * shareY;
            });
        });
    }
    return out;
}

} // namespace tessera::app
