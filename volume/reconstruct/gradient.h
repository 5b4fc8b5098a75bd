#pragma once

#include "volume/base/numbers.h"
#include "volume/field/lattice.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string_view>

/// Gradients of a reconstructed signal, by differences along the lattice's own directions.
namespace tessera::volume {

/// Span of the differences. Neighbours: from half-way towards one nearest neighbour to half-way towards the opposite
/// one, so that a difference spans one sample distance: along the three axes on CC, along the four diagonals <111> on
/// BCC. This is the derivative of the reconstruction kernel, smoothed over that distance; half-way between two samples
/// of an interpolating filter it is their difference. (Compare Z. Hossain, U. Alim, T. Moeller, Toward high-quality
/// gradient estimation on regular lattices, TVCG 2011: derivatives along nearest neighbours, shifted to between them.)
/// Wide: along the three axes over two cells of the CC grid, which smooths noise and damps fine detail.
enum class GradientSpan { Neighbours, Wide };
inline constexpr std::string_view kGradientSpanNames[] = {"neighbours", "wide"};

/// `count` directions with components of -1, 0 or 1, whose outer products sum to `squares` times the identity: the
/// gradient is the sum of direction * derivative along it, divided by `squares`. Each difference goes from
/// -reach * direction to +reach * direction (cells of the sublattice).
struct GradientStencil {
    int count = 3;
    bool diagonal = false;
    double reach = 0.5, squares = 1;

    glm::dvec3 direction(int i) const {
        if (diagonal) return {i == 1 ? -1 : 1, i == 2 ? -1 : 1, i == 3 ? -1 : 1};
        return {i == 0, i == 1, i == 2};
    }
};

inline GradientStencil gradientStencil(LatticeKind kind, GradientSpan span) {
    const bool bcc = kind == LatticeKind::BCC;
    if (span == GradientSpan::Wide) return {3, false, bcc ? 1 / kBccSpacing : 1, 1};
    return bcc ? GradientStencil{4, true, 0.25, 4} : GradientStencil{3, false, 0.5, 1};
}

/// What is read at a position: for one number a value and a bool, for a packet of them a packet of each.
template <class N, class Present> struct FoundValue {
    N value;
    Present present;
};

/// Gradient, per cell and axis, of `value(cells) -> FoundValue`. A difference is one-sided where one end is absent, and
/// 0 where both are, or the centre, too. Divide by Lattice::spacing for physical units.
template <class N, class Value>
glm::vec<3, N> gradientOf(const Value& value, const glm::vec<3, N>& cells, const GradientStencil& stencil) {
    glm::vec<3, N> out(N(0), N(0), N(0));
    const N width(2 * stencil.reach * stencil.squares);
    for (int i = 0; i < stencil.count; ++i) {
        const glm::dvec3 direction = stencil.direction(i);
        const glm::vec<3, N> offset = spreadOut<N>(direction * stencil.reach);
        const auto lower = value(cells - offset), upper = value(cells + offset);
        N difference = choose(lower.present & upper.present, (upper.value - lower.value) / width, N(0));
        const auto onlyLower = lower.present & !upper.present, onlyUpper = upper.present & !lower.present;
        if (anyOf(onlyLower | onlyUpper)) {
            const auto centre = value(cells);
            const N half = width * N(0.5);
            difference = choose(onlyLower & centre.present, (centre.value - lower.value) / half, difference);
            difference = choose(onlyUpper & centre.present, (upper.value - centre.value) / half, difference);
        }
        out.x += N(direction.x) * difference;
        out.y += N(direction.y) * difference;
        out.z += N(direction.z) * difference;
    }
    return out;
}

/// `value(cells) -> std::optional<double>` as one that gives FoundValue.
template <class Value> auto foundBy(const Value& value) {
    return [&value](const glm::dvec3& at) {
        const std::optional<double> one = value(at);
        return FoundValue<double, bool>{one.value_or(0), one.has_value()};
    };
}
/// The same of `value(cells) -> std::optional<double>`.
template <class Value> glm::dvec3 gradient(const Value& value, glm::dvec3 cells, const GradientStencil& stencil) {
    return gradientOf<double>(foundBy(value), cells, stencil);
}

/// Width in cells of the sublattice of `voxels` cells of the CC grid with the same sample density.
inline double smoothReach(LatticeKind kind, double voxels) {
    return voxels * (kind == LatticeKind::BCC ? 1 / kBccSpacing : 1);
}

inline constexpr double kSmoothDepth =
    0.5; ///< reach of smoothGradient() along the normal, as a share of that across it

/// Gradient of a smoothed field, per cell and axis, of `value(cells) -> FoundValue`: the least-squares fit of the
/// differences between -o and +o for the offsets o = `reach` A d, d the four diagonals (1, 1, 1), ..., A = 1 - (1 -
/// kSmoothDepth) n n^T, n = `narrow` / |narrow|. So each component is a mean of parallel differences, which smooths
/// over `reach` across a surface with the unsmoothed gradient `narrow` but less along its normal, where beyond a thin
/// wall other things begin. Where less than 0.1 to 0.4 of the gradient is left, `reach` is wider than what is there,
/// and the unsmoothed one stays. Absent values as in gradient().
template <class N, class Value>
glm::vec<3, N> smoothGradientOf(const Value& value, const glm::vec<3, N>& cells, double reach,
                                const glm::vec<3, N>& narrow) {
    const N length = lengthOf(narrow);
    const auto slopes = length > N(0);
    const N perLength = choose(slopes, N(1) / choose(slopes, length, N(1)), N(0));
    const glm::vec<3, N> normal = narrow * perLength;
    const auto centre = value(cells);
    glm::vec<3, N> sum(N(0), N(0), N(0));
    for (int i = 0; i < 4; ++i) {
        const glm::vec<3, N> way(N(i == 1 ? -1 : 1), N(i == 2 ? -1 : 1), N(i == 3 ? -1 : 1));
        const glm::vec<3, N> offset = (way - normal * (N(1 - kSmoothDepth) * inner(way, normal))) * N(reach);
        const auto lower = value(cells - offset), upper = value(cells + offset);
        const auto both = lower.present & upper.present;
        const N high = choose(upper.present, upper.value, centre.value),
                low = choose(lower.present, lower.value, centre.value);
        const N one = choose(centre.present, high - low, N(0));
        sum = sum + way * choose(both, N(0.5) * (upper.value - lower.value), one);
    }
    const glm::vec<3, N> smooth = (sum + normal * (N(1 / kSmoothDepth - 1) * inner(sum, normal))) * N(1 / (4 * reach));
    return blended(narrow, smooth, smoothStep(N(0.1), N(0.4), inner(smooth, normal) * perLength));
}

/// The same of `value(cells) -> std::optional<double>`.
template <class Value>
glm::dvec3 smoothGradient(const Value& value, glm::dvec3 cells, double reach, glm::dvec3 narrow) {
    return smoothGradientOf<double>(foundBy(value), cells, reach, narrow);
}

} // namespace tessera::volume
