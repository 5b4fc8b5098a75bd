#include "volume/reconstruct.h"

#include <algorithm>

#include <cassert>

namespace tessera::volume {

BrickSamples prefilter(const BrickSamples& gathered, const LevelGeometry& geometry) {
    const int slices = geometry.kind == LatticeKind::BCC ? 2 : 1;
    const glm::ivec3 from = gathered.size;
    assert(from.x > 2 && from.y > 2 && from.z > 2 * slices && from.z % slices == 0);
    BrickSamples out;
    out.size = from - glm::ivec3(2, 2, 2 * slices);
    const std::size_t total = std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z);
    out.values.resize(total);
    if (!gathered.present.empty()) out.present.resize(total);

    // Where the neighbours of a sample lie, as distances in memory; BCC: of even and of odd slices.
    const std::ptrdiff_t row = from.x, slice = std::ptrdiff_t(from.x) * from.y;
    std::vector<std::ptrdiff_t> neighbours[2];
    for (int parity = 0; parity < 2; ++parity)
        if (geometry.bccNeighbours()) {
            for (int z : {-1, 1})
                for (int y : {parity - 1, parity})
                    for (int x : {parity - 1, parity}) neighbours[parity].push_back(z * slice + y * row + x);
        } else {
            neighbours[parity] = {-1, 1, -row, row, -slice * slices, slice * slices};
        }

    const float* values = gathered.values.data();
    const std::uint8_t* present = gathered.present.empty() ? nullptr : gathered.present.data();
    std::size_t to = 0;
    for (int z = 0; z < out.size.z; ++z)
        for (int y = 0; y < out.size.y; ++y)
            for (int x = 0; x < out.size.x; ++x, ++to) {
                const std::ptrdiff_t at = (z + slices) * slice + (y + 1) * row + x + 1;
                if (present != nullptr) out.present[to] = present[at];
                if (present != nullptr && present[at] == 0) continue;
                const double centre = double(values[at]);
                double differences = 0;
                for (const std::ptrdiff_t step : neighbours[z & 1])
                    if (present == nullptr || present[at + step] != 0)
                        differences += double(values[at + step]) - centre;
                out.values[to] = float(centre - differences / 12);
            }
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
