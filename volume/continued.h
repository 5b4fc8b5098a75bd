#pragma once

#include "volume/reconstruct.h"

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <optional>

/// How a part of a field (volume/parts.h) goes on beyond its border: extrapolated from its own samples.
namespace tessera::volume {

/// Directions to neighbours on a lattice, in half cells, and how far these are, nearest first.
struct LineDirection {
    glm::ivec3 step{0};
    double length = 0; ///< half cells
};
inline std::array<LineDirection, 26> lineDirections(LatticeKind kind) {
    std::array<LineDirection, 26> out;
    std::size_t n = 0;
    const auto add = [&](int least, int most, int scale) { // so many components that are not 0
        for (int i = 0; i < 27; ++i) {
            const glm::ivec3 d(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
            const int parts = d.x * d.x + d.y * d.y + d.z * d.z;
            if (parts >= least && parts <= most) out[n++] = {d * scale, std::sqrt(double(parts)) * scale};
        }
    };
    if (kind == LatticeKind::BCC) add(3, 3, 1);
    add(1, 1, 2);
    add(2, 2, 2);
    if (kind == LatticeKind::CC) add(3, 3, 2);
    return out;
}

/// Storage index of a place in half cells (all even, on BCC or all odd), and back.
inline glm::ivec3 halfCellsOf(LatticeKind kind, glm::ivec3 at) {
    if (kind == LatticeKind::CC) return at * 2;
    return {2 * at.x + (at.z & 1), 2 * at.y + (at.z & 1), at.z};
}
inline glm::ivec3 storageOf(LatticeKind kind, glm::ivec3 half) {
    if (kind == LatticeKind::CC) return {half.x >> 1, half.y >> 1, half.z >> 1};
    return {half.x >> 1, half.y >> 1, half.z};
}

/// The value with which a part goes on at a storage index that it has no sample at; `own(index)` gives its samples,
/// nothing elsewhere and beyond the lattice. The two nearest samples along each line to neighbours are continued
/// linearly: of all lines the one counts whose samples are nearest, of equals the mean. A line with one sample counts
/// where the others' are half as far again. `counts(index)`: whether a line may begin at a sample, so that none does
/// beyond a gap. Nothing where no sample lies within kLineReach steps.
inline constexpr int kLineReach = 3;
template <class Own, class Counts>
std::optional<double> continued(LatticeKind kind, glm::ivec3 at, const Own& own, const Counts& counts) {
    static const std::array<LineDirection, 26> kDirections[] = {lineDirections(LatticeKind::CC),
                                                                lineDirections(LatticeKind::BCC)};
    struct Mean {
        double sum = 0, distance = 1e300;
        int count = 0;
        void add(double value, double from) {
            constexpr double kSame = 1e-6;
            if (from > distance + kSame) return;
            if (from < distance - kSame) sum = 0, count = 0, distance = from;
            sum += value;
            ++count;
        }
    } lines, single;
    const glm::ivec3 place = halfCellsOf(kind, at);
    for (const LineDirection& direction : kDirections[kind == LatticeKind::BCC ? 1 : 0])
        for (int m = 1; m <= kLineReach && m * direction.length < lines.distance + 1e-6; ++m) {
            const auto sample = [&](int n) { return own(storageOf(kind, place + n * direction.step)); };
            const std::optional<double> a = sample(m);
            if (!a) continue;
            if (!counts(storageOf(kind, place + m * direction.step))) break;
            if (const std::optional<double> b = sample(m + 1)) {
                lines.add(*a + m * (*a - *b), m * direction.length);
            } else {
                single.add(*a, m * direction.length);
            }
            break;
        }
    constexpr double kFurther = 1.5;
    const Mean& best = lines.count > 0 && lines.distance <= kFurther * single.distance ? lines : single;
    if (best.count == 0) return std::nullopt;
    return best.sum / best.count;
}

/// Whether two storage indices lie within a cell of each other along each axis: no absent sample lies between them.
inline bool isBeside(LatticeKind kind, glm::ivec3 a, glm::ivec3 b) {
    const glm::ivec3 apart = glm::abs(halfCellsOf(kind, a) - halfCellsOf(kind, b));
    return apart.x <= 2 && apart.y <= 2 && apart.z <= 2;
}

/// A sample accessor (volume/reconstruct.h) that shows one part of another: that of the sample at `near`, a storage
/// index inside a lattice of `size`, continued to the places of other parts. `partOf(at)` may be asked for any place,
/// as `samples`. Refers to both.
template <class Samples, class PartOf> class OwnPart {
public:
    OwnPart(LatticeKind kind, glm::ivec3 size, const Samples& samples, const PartOf& partOf, glm::ivec3 near)
        : kind_(kind), size_(size), samples_(samples), partOf_(partOf), near_(near), here_(samples(near)),
          own_(partOf(near)) {}

    Sample operator()(glm::ivec3 at) const {
        if (partOf_(at) == own_) return samples_(at);
        if (!here_.present) return {0, false};
        const auto own = [&](glm::ivec3 there) -> std::optional<double> {
            if (clampToLattice(kind_, size_, there) != there || partOf_(there) != own_) return std::nullopt;
            const Sample sample = samples_(there);
            return sample.present ? std::optional(sample.value) : std::nullopt;
        };
        const auto counts = [&](glm::ivec3 there) { return isBeside(kind_, there, near_); };
        return {continued(kind_, at, own, counts).value_or(here_.value), true};
    }

private:
    LatticeKind kind_;
    glm::ivec3 size_;
    const Samples& samples_;
    const PartOf& partOf_;
    glm::ivec3 near_;
    Sample here_;
    int own_;
};

} // namespace tessera::volume
