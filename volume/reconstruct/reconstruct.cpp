#include "volume/reconstruct/reconstruct.h"

#include "volume/base/parallel.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace tessera::volume {

namespace {

/// Offsets in memory of a sample's neighbours, for even and for odd slices.
template <std::size_t kCount> using Steps = std::array<std::array<std::ptrdiff_t, kCount>, 2>;

Steps<6> ccSteps(glm::ivec3 size, int slices) {
    const std::ptrdiff_t row = size.x, slice = std::ptrdiff_t(size.x) * size.y * slices;
    const std::array<std::ptrdiff_t, 6> steps{-1, 1, -row, row, -slice, slice};
    return {steps, steps};
}

Steps<8> bccSteps(glm::ivec3 size) {
    const std::ptrdiff_t row = size.x, slice = std::ptrdiff_t(size.x) * size.y;
    Steps<8> steps;
    for (int parity = 0; parity < 2; ++parity) {
        std::size_t n = 0;
        for (int z : {-1, 1})
            for (int y : {parity - 1, parity})
                for (int x : {parity - 1, parity}) steps[std::size_t(parity)][n++] = z * slice + y * row + x;
    }
    return steps;
}

/// Prefilter: subtracts from every sample a twelfth of the sum of differences to its present neighbours.
template <std::size_t kCount>
void subtractDifferences(const BrickSamples& gathered, int slices, const Steps<kCount>& steps, BrickSamples& out) {
    const std::ptrdiff_t row = gathered.size.x, slice = row * gathered.size.y;
    const bool masked = !gathered.present.empty();
    parallelFor(std::size_t(out.size.z), [&](std::size_t z) {
        const auto& step = steps[z & 1];
        for (int y = 0; y < out.size.y; ++y) {
            const std::size_t to = (z * std::size_t(out.size.y) + std::size_t(y)) * std::size_t(out.size.x);
            const std::ptrdiff_t at = (std::ptrdiff_t(z) + slices) * slice + (y + 1) * row + 1;
            const float* from = gathered.values.data() + at;
            float* result = out.values.data() + to;
            if (!masked) {
                for (int x = 0; x < out.size.x; ++x) {
                    const double centre = double(from[x]);
                    double differences = 0;
                    for (std::size_t n = 0; n < kCount; ++n) differences += double(from[x + step[n]]) - centre;
                    result[x] = float(centre - differences / 12);
                }
                continue;
            }
            const std::uint8_t* present = gathered.present.data() + at;
            for (int x = 0; x < out.size.x; ++x) {
                out.present[to + std::size_t(x)] = present[x];
                if (present[x] == 0) continue;
                const double centre = double(from[x]);
                double differences = 0;
                for (std::size_t n = 0; n < kCount; ++n)
                    if (present[x + step[n]] != 0) differences += double(from[x + step[n]]) - centre;
                result[x] = float(centre - differences / 12);
            }
        }
    });
}

} // namespace

BrickSamples prefilter(const BrickSamples& gathered, const LevelGeometry& geometry) {
    const int slices = geometry.kind == LatticeKind::BCC ? 2 : 1;
    const glm::ivec3 from = gathered.size;
    assert(from.x > 2 && from.y > 2 && from.z > 2 * slices && from.z % slices == 0);
    BrickSamples out;
    out.size = from - glm::ivec3(2, 2, 2 * slices);
    const std::size_t total = std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z);
    out.values.resize(total);
    if (!gathered.present.empty()) out.present.resize(total);

    if (geometry.bccNeighbours())
        subtractDifferences<8>(gathered, slices, bccSteps(gathered.size), out);
    else
        subtractDifferences<6>(gathered, slices, ccSteps(gathered.size, slices), out);
    return out;
}

namespace {

/// The truncated power of the directions (-1,1,1), (1,-1,1), (1,1,-1) and (1,1,1), each twice, times four: the integral
/// over s of s (a - s)(b - s)(c - s), where a, b, c are the coordinates of the point along the first three directions.
double truncatedPower(glm::dvec3 p) {
    const double a = (p.y + p.z) / 2, b = (p.x + p.z) / 2, c = (p.x + p.y) / 2;
    const double s = std::min({a, b, c});
    if (s <= 0) return 0;
    // s abc - s^2 (ab + bc + ca) + s^3 (a + b + c) - s^4, integrated.
    return s * s * (a * b * c / 2 + s * (-(a * b + b * c + c * a) / 3 + s * ((a + b + c) / 4 - s / 5)));
}

} // namespace

double quinticBoxSpline(glm::dvec3 halfCells) {
    const glm::dvec3 p = glm::abs(halfCells);
    if (p.x + p.y >= 4 || p.x + p.z >= 4 || p.y + p.z >= 4) return 0;
    constexpr double kDifference[] = {1, -2, 1};
    double sum = 0;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
            for (int c = 0; c < 3; ++c)
                for (int d = 0; d < 3; ++d) {
                    const int i = a - 1, j = b - 1, k = c - 1, l = d - 1;
                    const glm::dvec3 moved(-i + j + k + l, i - j + k + l, i + j - k + l);
                    sum +=
                        kDifference[a] * kDifference[b] * kDifference[c] * kDifference[d] * truncatedPower(p - moved);
                }
    return sum;
}

} // namespace tessera::volume
