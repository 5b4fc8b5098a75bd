#include "vis/processor/drawn_cloud.h"

#include "vis/optics/ray_setup.h"
#include "vis/processor/presented.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::vis {

namespace {

struct Splat {
    glm::dvec2 middle{0}; ///< pixels, y up
    double half = 0;      ///< of its square
    glm::dvec3 color{0};
    double opacity = 0, weight = 0;
};

/// The points that are drawn, where they lie in the picture.
std::vector<Splat> splatsOf(std::span<const CloudPoint> points, const CloudView& view) {
    const auto count = std::size_t(std::ceil(double(points.size()) * std::clamp(view.share, 0.0, 1.0)));
    const glm::dvec2 size(view.size);
    // Radii refer to the centre of the picture, where the magnification depends only on the eye distances.
    const double middle = project(view.projection, 1, glm::dvec4(0)).scale / view.projection.zoom;
    std::vector<Splat> out;
    out.reserve(count);
    const glm::dmat4 first = view.rotation.firstAxes(), further = view.rotation.furtherAxes();
    for (const CloudPoint& point : points.first(count)) {
        const Projected4 placed =
            project(view.projection, 1, first * glm::dvec4(point.position) + further * glm::dvec4(point.further));
        const double wanted = double(view.radiusPixels) / middle * placed.scale;
        const double drawn = std::max(wanted, 0.75); // at least a pixel wide; smaller ones are fainter instead
        const double opacity =
            1 - std::pow(1 - std::min(double(point.color.a), 0.999), double(points.size()) / double(count));
        const double near = 1 - std::clamp(placed.depth, 0.0, 1.0);
        out.push_back({.middle = (placed.at * (std::min(size.x, size.y) / size) + 1.0) / 2.0 * size,
                       .half = drawn + 0.5,
                       .color = glm::dvec3(point.color) * litBy(view.light, first * glm::dvec4(point.normal)),
                       .opacity = opacity * wanted * wanted / (drawn * drawn),
                       .weight = std::clamp(8 * near * near * near, 0.01, 8.0)}); // equation 10
    }
    return out;
}

/// What the splats add up to in a pixel: colours add, transmittances multiply, so that their order does not matter.
struct SplatSum {
    glm::dvec4 color{0};
    double through = 1;
};

/// Adds the part of a splat in rows [begin, end).
void addSplat(const Splat& splat, int begin, int end, int width, std::vector<SplatSum>& sums) {
    const glm::ivec2 lo(glm::ceil(splat.middle - splat.half - 0.5)), hi(glm::ceil(splat.middle + splat.half - 0.5));
    for (int y = std::max(lo.y, begin); y < std::min(hi.y, end); ++y)
        for (int x = std::max(lo.x, 0); x < std::min(hi.x, width); ++x) {
            const glm::dvec2 at = (glm::dvec2(x, y) + 0.5 - splat.middle) / splat.half;
            // Gaussian, 0 at the rim, 1 in the middle
            const double alpha = splat.opacity * std::max(std::exp(-3 * glm::dot(at, at)) - 0.0498, 0.0) * 1.0524;
            SplatSum& sum = sums[std::size_t(y - begin) * std::size_t(width) + std::size_t(x)];
            sum.color += glm::dvec4(splat.color * alpha, alpha) * splat.weight;
            sum.through *= 1 - alpha;
        }
}

} // namespace

MemoryTexture drawnCloud(std::span<const CloudPoint> points, const CloudView& view) {
    constexpr int kRows = 16; // that one core draws in one go
    const std::vector<Splat> splats = splatsOf(points, view);
    const glm::ivec2 size = glm::max(view.size, glm::ivec2(1));
    const glm::dvec3 ground = linearFromSrgb(glm::dvec3(view.background));
    MemoryTexture out{.size = size, .rgba = std::vector<std::uint8_t>(std::size_t(size.x) * std::size_t(size.y) * 4)};
    parallelFor(std::size_t((size.y + kRows - 1) / kRows), [&](std::size_t band) {
        const int begin = int(band) * kRows, end = std::min(begin + kRows, size.y);
        std::vector<SplatSum> sums(std::size_t(end - begin) * std::size_t(size.x));
        for (const Splat& splat : splats) addSplat(splat, begin, end, size.x, sums);
        std::uint8_t* to = &out.rgba[std::size_t(begin) * std::size_t(size.x) * 4];
        for (const SplatSum& sum : sums) {
            const glm::dvec3 mean = glm::dvec3(sum.color) / std::max(sum.color.a, 1e-5);
            const glm::u8vec3 shown = screenColor(glm::mix(mean, ground, sum.through));
            for (int c = 0; c < 3; ++c) *to++ = shown[c];
            *to++ = 255;
        }
    });
    return out;
}

} // namespace tessera::vis
