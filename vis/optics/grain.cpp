#include "vis/optics/grain.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <numeric>

namespace tessera::vis {

namespace {

constexpr std::size_t kTexels = std::size_t(kGrainEdge) * kGrainEdge;

/// White noise, identical on all machines.
std::vector<float> whiteNoise(std::uint32_t seed) {
    std::vector<float> out(kTexels);
    for (std::size_t i = 0; i < kTexels; ++i) {
        std::uint32_t h = std::uint32_t(i) * 0x9e3779b9u + seed;
        h = (h ^ (h >> 16)) * 0x85ebca6bu;
        h = (h ^ (h >> 13)) * 0xc2b2ae35u;
        out[i] = float((h ^ (h >> 16)) >> 8) / float(1 << 24) - 0.5f;
    }
    return out;
}

/// Blurs periodically along a direction of whole texels, with a binomial-like kernel of `radius` steps.
std::vector<float> blurred(const std::vector<float>& in, glm::ivec2 along, int radius) {
    std::vector<float> out(kTexels);
    const auto wrap = [](int i) { return std::size_t(i & (kGrainEdge - 1)); };
    for (int y = 0; y < kGrainEdge; ++y)
        for (int x = 0; x < kGrainEdge; ++x) {
            float sum = 0;
            for (int k = -radius; k <= radius; ++k) {
                const float t = float(k) / float(radius + 1), weight = (1 - t * t) * (1 - t * t);
                sum += weight * in[wrap(y + k * along.y) * kGrainEdge + wrap(x + k * along.x)];
            }
            out[std::size_t(y) * kGrainEdge + std::size_t(x)] = sum;
        }
    return out;
}

/// Replaces each value by its rank, 0..1.
std::vector<float> equalized(const std::vector<float>& in) {
    std::vector<std::uint32_t> order(kTexels);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return in[a] != in[b] ? in[a] < in[b] : a < b; });
    std::vector<float> out(kTexels);
    for (std::size_t i = 0; i < kTexels; ++i) out[order[i]] = float(i) / float(kTexels - 1);
    return out;
}

GrainTile makeTile() {
    // Paper grains of about three texels, mixed with some of twice the size.
    const std::vector<float> noise = whiteNoise(1);
    const std::vector<float> fine = blurred(blurred(noise, {1, 0}, 1), {0, 1}, 1);
    const std::vector<float> wide = blurred(blurred(whiteNoise(2), {1, 0}, 4), {0, 1}, 4);
    std::vector<float> tooth(kTexels);
    for (std::size_t i = 0; i < kTexels; ++i) tooth[i] = fine[i] + 0.25f * wide[i];
    // Strokes: long along the diagonal, a few texels wide.
    std::vector<float> strokes = blurred(blurred(blurred(whiteNoise(3), {1, 1}, 36), {1, -1}, 2), {1, 0}, 1);
    const std::vector<float> even = equalized(tooth), long_ = equalized(strokes);
    GrainTile tile;
    for (std::size_t i = 0; i < kTexels; ++i) tile.texels.emplace_back(even[i], long_[i]);
    return tile;
}

} // namespace

std::shared_ptr<const GrainTile> grainTile() {
    static const auto tile = std::make_shared<const GrainTile>(makeTile());
    return tile;
}

glm::dvec2 GrainTile::at(glm::dvec2 texel) const {
    const glm::dvec2 moved = texel - 0.5, base = glm::floor(moved), part = moved - base;
    const auto fetch = [&](int x, int y) {
        const int i = (int(base.x) + x) & (kGrainEdge - 1), j = (int(base.y) + y) & (kGrainEdge - 1);
        return glm::dvec2(texels[std::size_t(j) * kGrainEdge + std::size_t(i)]);
    };
    return glm::mix(glm::mix(fetch(0, 0), fetch(1, 0), part.x), glm::mix(fetch(0, 1), fetch(1, 1), part.x), part.y);
}

glm::dvec2 grainAt(const GrainTile& tile, glm::dvec3 place, glm::dvec3 normal, double size, double turn) {
    const double octave = std::log2(std::max(size, 1e-9)), whole = std::floor(octave), part = octave - whole;
    const double cosine = std::cos(glm::radians(turn)), sine = std::sin(glm::radians(turn));
    glm::dvec3 planes = normal * normal * normal * normal;
    planes /= std::max(planes.x + planes.y + planes.z, 1e-12);
    glm::dvec2 sum(0);
    double squares = 0;
    for (int scale = 0; scale < 2; ++scale) {
        const glm::dvec3 texel = place * std::exp2(-whole - scale);
        for (int axis = 0; axis < 3; ++axis) {
            const double weight = planes[axis] * (scale == 0 ? 1 - part : part);
            // Offsets, so that no plane passes through the origin of another.
            const glm::dvec2 on = glm::dvec2(texel[(axis + 1) % 3], texel[(axis + 2) % 3]) + 17.3 * (axis + 1);
            sum += weight * (tile.at({cosine * on.x - sine * on.y, sine * on.x + cosine * on.y}) - 0.5);
            squares += weight * weight;
        }
    }
    return glm::clamp(0.5 + sum / std::sqrt(std::max(squares, 1e-12)), 0.0, 1.0);
}

double paperShade(const GrainTile& tile, glm::dvec2 at, double tooth) {
    const double lit = tile.at(at).x - tile.at(at + glm::dvec2(-1.5, 1.5)).x, pulp = tile.at(at / 7.3).x - 0.5;
    return 1 + tooth * (0.1 * lit + 0.05 * pulp);
}

} // namespace tessera::vis
