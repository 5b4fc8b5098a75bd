#include "vis/lic/line_integral.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace tessera::vis {

namespace {

constexpr double kStep = 1; ///< texels

/// A number that looks random (T. Wang's and B. Jenkins' mixing of integers).
std::uint32_t mixedBits(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    return x ^ (x >> 16);
}

double noiseAt(int i, int j, std::uint32_t seed) {
    const std::uint32_t bits = mixedBits(std::uint32_t(i) + mixedBits(std::uint32_t(j) + mixedBits(seed)));
    return double(bits) / 2147483648.0 - 1;
}

/// The four texels around a place and their weights.
struct Around {
    glm::ivec2 low;
    glm::dvec2 share;
    explicit Around(glm::dvec2 at) {
        const glm::dvec2 corner = glm::floor(at - 0.5);
        low = glm::ivec2(corner);
        share = at - 0.5 - corner;
    }
    double weight(int i, int j) const { return (i ? share.x : 1 - share.x) * (j ? share.y : 1 - share.y); }
};

/// Convolves along lines through texels of one picture.
class Convolution {
public:
    Convolution(const PlaneField& field, std::span<const float> noise, const LineIntegralSettings& settings)
        : field_(field), noise_(noise), settings_(settings), whole_(field.vectors.size(), 0) {
        for (int y = 0; y + 1 < field.size.y; ++y)
            for (int x = 0; x + 1 < field.size.x; ++x) whole_[field.index({x, y})] = isWhole({x, y});
    }

    float operator()(glm::ivec2 texel) const {
        if (!field_.present(texel)) return std::numeric_limits<float>::quiet_NaN();
        const glm::dvec2 middle = glm::dvec2(texel) + 0.5;
        const std::uint16_t part = field_.parts.empty() ? std::uint16_t(0) : field_.parts[field_.index(texel)];
        const double half = std::max(settings_.length / 2, 0.0);
        double sum = noise_[field_.index(texel)] * kernelWeight(0, settings_.kernel);
        double squares = kernelWeight(0, settings_.kernel) * kernelWeight(0, settings_.kernel);
        for (const double way : {1.0, -1.0}) {
            glm::dvec2 at = middle;
            for (double gone = 0; gone < half - 1e-9;) {
                const double step = std::min(kStep, half - gone);
                const glm::dvec2 first = direction(at, part);
                if (first == glm::dvec2(0)) break;
                const glm::dvec2 halfway = at + first * (0.5 * step * way);
                if (!inside(halfway, part)) break;
                const glm::dvec2 along = direction(halfway, part);
                if (along == glm::dvec2(0)) break;
                const glm::dvec2 next = at + along * (step * way);
                if (!inside(next, part)) break;
                at = next;
                gone += step;
                const double weight = kernelWeight(gone / half, settings_.kernel) * (step / kStep);
                sum += weight * noiseBetween(at);
                squares += weight * weight;
            }
        }
        return float(sum / std::sqrt(squares));
    }

private:
    bool inside(glm::dvec2 at, std::uint16_t part) const {
        const glm::ivec2 texel(glm::floor(at));
        return at.x >= 0 && at.y >= 0 && texel.x < field_.size.x && texel.y < field_.size.y && holds(texel, part);
    }
    bool holds(glm::ivec2 texel, std::uint16_t part) const {
        return field_.present(texel) && (field_.parts.empty() || field_.parts[field_.index(texel)] == part);
    }
    /// Whether a texel and its neighbours to the right and above are present and of one part.
    bool isWhole(glm::ivec2 texel) const {
        for (int i = 0; i < 4; ++i) {
            const glm::ivec2 other = texel + glm::ivec2(i & 1, i >> 1);
            if (!field_.present(other)) return false;
            if (!field_.parts.empty() && field_.parts[field_.index(other)] != field_.parts[field_.index(texel)])
                return false;
        }
        return true;
    }

    /// PlaneField::direction at a place inside, most often without asking what is there.
    glm::dvec2 direction(glm::dvec2 at, std::uint16_t part) const {
        const glm::dvec2 from = at - 0.5;
        if (!(from.x >= 0) || !(from.y >= 0)) return field_.direction(at, part);
        const glm::ivec2 low(from);
        const std::size_t first = field_.index(low);
        if (!whole_[first]) return field_.direction(at, part);
        const glm::dvec2 share = from - glm::dvec2(low);
        const glm::vec2* const below = field_.vectors.data() + first;
        const glm::vec2* const above = below + field_.size.x;
        const glm::dvec2 sum =
            glm::dvec2(below[0]) * ((1 - share.x) * (1 - share.y)) + glm::dvec2(below[1]) * (share.x * (1 - share.y)) +
            glm::dvec2(above[0]) * ((1 - share.x) * share.y) + glm::dvec2(above[1]) * (share.x * share.y);
        const double length = glm::length(sum);
        return length > 0 ? sum / length : glm::dvec2(0);
    }

    double noiseBetween(glm::dvec2 at) const {
        const Around around(at);
        double sum = 0;
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const glm::ivec2 texel = glm::clamp(around.low + glm::ivec2(i, j), glm::ivec2(0), field_.size - 1);
                sum += around.weight(i, j) * double(noise_[field_.index(texel)]);
            }
        return sum;
    }

    const PlaneField& field_;
    std::span<const float> noise_;
    LineIntegralSettings settings_;
    std::vector<std::uint8_t> whole_; ///< isWhole of each texel
};

} // namespace

double noiseAt(glm::ivec3 corner, std::uint32_t seed) {
    const std::uint32_t column = mixedBits(std::uint32_t(corner.z) + mixedBits(seed ^ 0x9e3779b9U));
    return noiseAt(corner.x, corner.y, column);
}

double kernelWeight(double share, StrokeKernel kernel) {
    return kernel == StrokeKernel::Box ? 1 : 0.5 + 0.5 * std::cos(std::numbers::pi * share);
}

void stretchContrast(std::vector<float>& values) {
    double count = 0, sum = 0, squares = 0;
    for (const float value : values)
        if (!std::isnan(value)) {
            ++count;
            sum += double(value);
            squares += double(value) * double(value);
        }
    if (count == 0) return;
    const double mean = sum / count, deviation = std::sqrt(std::max(squares / count - mean * mean, 0.0));
    const double factor = deviation > 0 ? kStrokeDeviation / deviation : 0;
    for (float& value : values)
        if (!std::isnan(value)) value = float(std::clamp((double(value) - mean) * factor, -1.0, 1.0));
}

bool PlaneField::present(glm::ivec2 at) const {
    return !std::isnan(vectors[index(at)].x);
}

glm::dvec2 PlaneField::direction(glm::dvec2 at, std::uint16_t part) const {
    const Around around(at);
    glm::dvec2 sum(0);
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const glm::ivec2 texel = around.low + glm::ivec2(i, j);
            if (texel.x < 0 || texel.y < 0 || texel.x >= size.x || texel.y >= size.y) continue;
            const std::size_t from = index(texel);
            if (std::isnan(vectors[from].x) || (!parts.empty() && parts[from] != part)) continue;
            sum += around.weight(i, j) * glm::dvec2(vectors[from]);
        }
    const double length = glm::length(sum);
    return length > 0 ? sum / length : glm::dvec2(0);
}

std::vector<float> planeNoise(glm::ivec2 size, glm::ivec2 first, int grain, std::uint32_t seed) {
    assert(grain > 0);
    const auto lower = [&](int of) { return int(std::floor(double(of) / grain)); };
    std::vector<float> noise(std::size_t(size.x) * std::size_t(size.y));
    parallelFor(std::size_t(size.y), [&](std::size_t row) {
        const int y = first.y + int(row), j = lower(y);
        const double shareY = double(y - j * grain) / grain;
        for (int column = 0; column < size.x; ++column) {
            const int x = first.x + column, i = lower(x);
            const double shareX = double(x - i * grain) / grain;
            const double low = std::lerp(noiseAt(i, j, seed), noiseAt(i + 1, j, seed), shareX);
            const double high = std::lerp(noiseAt(i, j + 1, seed), noiseAt(i + 1, j + 1, seed), shareX);
            noise[row * std::size_t(size.x) + std::size_t(column)] = float(std::lerp(low, high, shareY));
        }
    });
    return noise;
}

std::vector<float> lineIntegralConvolution(const PlaneField& field, std::span<const float> noise,
                                           const LineIntegralSettings& settings, const Progress& progress) {
    assert(noise.size() == field.vectors.size());
    constexpr std::size_t kRows = 64; // between reports
    const Convolution convolve(field, noise, settings);
    std::vector<float> out(field.vectors.size());
    const auto rows = std::size_t(field.size.y);
    for (std::size_t begin = 0; begin < rows; begin += kRows) {
        progress.advance(double(begin) / double(rows));
        parallelFor(std::min(kRows, rows - begin), [&](std::size_t row) {
            const int y = int(begin + row);
            for (int x = 0; x < field.size.x; ++x) out[field.index({x, y})] = convolve({x, y});
        });
    }
    stretchContrast(out);
    return out;
}

} // namespace tessera::vis
