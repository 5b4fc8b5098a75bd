#include "vis/optics/grain.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
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

/// Dots of a tile of half the edge. Candidates lie on a jittered grid; the next dot is the one with the least
/// potential of those before.
struct DotTile {
    static constexpr int kEdge = kGrainEdge / 2, kGrid = kEdge / 2;
    static constexpr std::size_t kCount = std::size_t(kEdge) * kEdge / 9; ///< spacing of kGrainTexels
    std::vector<glm::vec2> places;                                        ///< in texels, in order

    DotTile() {
        const std::vector<float> jitter = whiteNoise(4);
        // Potential of a dot by distance in candidates, periodic.
        std::vector<float> kernel(std::size_t(kGrid) * kGrid), potential(kernel.size());
        for (int y = 0; y < kGrid; ++y)
            for (int x = 0; x < kGrid; ++x) {
                const int dx = std::min(x, kGrid - x), dy = std::min(y, kGrid - y);
                const float squared = float(dx * dx + dy * dy) + 0.5f;
                kernel[std::size_t(y) * kGrid + std::size_t(x)] = 1 / (squared * squared);
            }
        for (std::size_t i = 0; i < potential.size(); ++i) potential[i] = 1e-5f * (jitter[i] + 0.5f);
        while (places.size() < kCount) {
            const auto least = std::size_t(std::min_element(potential.begin(), potential.end()) - potential.begin());
            const auto x = int(least) % kGrid, y = int(least) / kGrid;
            places.push_back((glm::vec2(x, y) + 0.5f) * 2.0f + glm::vec2(jitter[2 * least], jitter[2 * least + 1]));
            for (int j = 0; j < kGrid; ++j) {
                float* row = &potential[std::size_t(j) * kGrid];
                const float* from = &kernel[std::size_t((j - y) & (kGrid - 1)) * kGrid];
                for (int i = 0; i < kGrid; ++i) row[i] += from[(i - x) & (kGrid - 1)];
            }
        }
    }

    /// Darkness from which on each texel of the tile is covered.
    std::vector<float> thresholds() const {
        constexpr float kRadius = 0.5f * float(kGrainTexels);
        std::vector<float> first(kTexels / 4, 1e9f); // number of the dot that covers it, or beyond all its distance
        for (std::size_t n = 0; n < places.size(); ++n)
            for (int y = -4; y <= 4; ++y)
                for (int x = -4; x <= 4; ++x) {
                    const glm::ivec2 at = glm::ivec2(glm::floor(places[n])) + glm::ivec2(x, y);
                    const float away = glm::length(glm::vec2(at) + 0.5f - places[n]);
                    float& own = first[std::size_t(at.y & (kEdge - 1)) * kEdge + std::size_t(at.x & (kEdge - 1))];
                    own = std::min(own, away < kRadius ? float(n) : float(kCount) + away);
                }
        std::vector<float> sorted = first, out(kTexels);
        std::sort(sorted.begin(), sorted.end());
        for (std::size_t i = 0; i < kTexels; ++i) {
            const std::size_t y = i / kGrainEdge % kEdge, x = i % kGrainEdge % kEdge;
            const auto covered = std::lower_bound(sorted.begin(), sorted.end(), first[y * kEdge + x]);
            out[i] = float(covered - sorted.begin()) / float(sorted.size());
        }
        return out;
    }
};

/// Divides by the standard deviation; the mean is about 0.
std::vector<float> normalized(std::vector<float> values) {
    double squares = 0;
    for (const float value : values) squares += double(value) * double(value);
    const auto scale = float(1 / std::sqrt(squares / double(values.size())));
    for (float& value : values) value *= scale;
    return values;
}

/// Strokes of a hand along the diagonal: about kStrokeGap texels apart, wavering, each with a beginning and an end.
std::vector<float> strokeTile() {
    const std::vector<float> length = normalized(blurred(blurred(whiteNoise(3), {1, 1}, 40), {1, -1}, 2));
    const std::vector<float> waver = normalized(blurred(blurred(whiteNoise(5), {1, 1}, 64), {1, -1}, 8));
    std::vector<float> out(kTexels);
    for (std::size_t i = 0; i < kTexels; ++i) {
        const float across = float(int(i % kGrainEdge) - int(i / kGrainEdge)) + 1.2f * waver[i];
        out[i] = std::cos(2 * std::numbers::pi_v<float> * across / float(kStrokeGap)) + 0.5f * length[i];
    }
    return out;
}

GrainTile makeTile() {
    // Paper grains of about three texels, mixed with some of twice the size.
    const std::vector<float> noise = whiteNoise(1);
    const std::vector<float> fine = blurred(blurred(noise, {1, 0}, 1), {0, 1}, 1);
    const std::vector<float> wide = blurred(blurred(whiteNoise(2), {1, 0}, 4), {0, 1}, 4);
    std::vector<float> tooth(kTexels);
    for (std::size_t i = 0; i < kTexels; ++i) tooth[i] = fine[i] + 0.25f * wide[i];
    const std::vector<float> even = equalized(tooth), strokes = equalized(strokeTile()), dots = DotTile().thresholds();
    GrainTile tile;
    for (std::size_t i = 0; i < kTexels; ++i) tile.texels.emplace_back(even[i], strokes[i], dots[i]);
    return tile;
}

} // namespace

const std::shared_ptr<const GrainTile>& grainTile() {
    static const auto tile = std::make_shared<const GrainTile>(makeTile());
    return tile;
}

glm::dvec3 GrainTile::at(glm::dvec2 texel) const {
    return {patternAt(*this, 0, texel), patternAt(*this, 1, texel), patternAt(*this, 2, texel)};
}

double paperShade(const GrainTile& tile, glm::dvec2 at, double tooth) {
    const double lit = tile.at(at).x - tile.at(at + glm::dvec2(-1.5, 1.5)).x, pulp = tile.at(at / 7.3).x - 0.5;
    return 1 + tooth * (0.1 * lit + 0.05 * pulp);
}

} // namespace tessera::vis
