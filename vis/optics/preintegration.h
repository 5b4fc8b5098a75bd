#pragma once

#include "vis/transfer/transfer_function.h"
#include "volume/base/vectors.h"

#include <glm/vec4.hpp>
#include <numbers>
#include <vector>

/// Pre-integrated classification: colour and opacity of a ray segment along which the value changes linearly between
/// two positions of the transfer function.
///
/// K. Engel, M. Kraus, T. Ertl: High-quality pre-integrated volume rendering using hardware-accelerated pixel shading,
/// 2001, with the approximation of their section 3.3 (no attenuation within a segment), which allows integral
/// functions. We store means per unit of length instead of integrals per segment: mean extinction as the opacity of a
/// layer kReferenceLength thick, and mean emission as its colour. correctedOpacity() then accounts for the segment
/// length as for any other opacity, so one table serves all step lengths.
namespace tessera::vis {

/// Integrals over the position x in 0..1 of extinction t = -log(1 - opacity) and of t * colour (linear light), both
/// assumed linear between the nodes x = i / (size - 1).
struct IntegralFunctions {
    std::vector<glm::dvec4> density;  ///< t * colour, t at the nodes
    std::vector<glm::dvec4> integral; ///< integral of density from 0 to the node

    double last() const { return double(density.size() - 1); }
};

inline constexpr int kIntegralNodes = 4096;
/// From a function's opacity curve and colours over a range; O(nodes).
IntegralFunctions integralFunctions(const TransferFunction& function, Range range, int nodes = kIntegralNodes);
/// The integral from 0 to a position.
glm::dvec4 integralAt(const IntegralFunctions& functions, double position);

/// A position between two nodes, `last` the number of the last one.
template <class N> struct NodePlaceOf { N below, along; };
template <class N> NodePlaceOf<N> nodePlace(double last, N x) {
    const N at = clamped(x, N(0), N(1)) * N(last), below = smaller(roundDown(at), N(last - 1));
    return {below, at - below};
}
/// The integral from a node, where the density is `here`, to a place between it and the next one.
template <class N>
glm::vec<4, N> integralBeyond(const glm::vec<4, N>& here, const glm::vec<4, N>& next, N along, double last) {
    return (here + (next - here) * (along * N(0.5))) * (along * N(1 / last));
}
/// Colour and opacity from the means of t * colour and t.
template <class N> glm::vec<4, N> fromDensity(const glm::vec<4, N>& mean) {
    const auto some = mean.w > N(1e-11); // rounding dominates if there is next to no extinction
    const N whole = choose(some, N(1) / choose(some, mean.w, N(1)), N(0));
    const auto color = [&](N part) { return clamped(part * whole, N(0), N(1)); };
    const N opacity = N(1) - powerOfTwo(mean.w * N(-std::numbers::log2e));
    return {color(mean.x), color(mean.y), color(mean.z), choose(some, opacity, N(0))};
}

/// One end of a ray segment: a position, clamped to 0..1, and what `Functions` say of the nodes around it.
template <class N, class Functions> struct SegmentEnd {
    N position;
    NodePlaceOf<N> at;
    glm::vec<4, N> density, next; ///< at the node below and the one above
    typename Functions::Sum sum;  ///< from node 0 to the node below
};
template <class N, class Functions> SegmentEnd<N, Functions> segmentEnd(const Functions& functions, N position) {
    const N inside = clamped(position, N(0), N(1));
    const NodePlaceOf<N> at = nodePlace(functions.last(), inside);
    return {inside, at, functions.density(at.below), functions.density(at.below + N(1)), functions.sum(at.below)};
}

/// Colour (linear light, not premultiplied: mean weighted by extinction) and opacity of the segment between two ends;
/// symmetric in both. For equal positions (closer than `same`, so that their difference has significant digits), the
/// values of that position. `functions` has last(), the number of the last node, density(node), sum(node), the integral
/// up to it, and apart(a, b), the difference of two of these. A template over the number (volume/base/numbers.h).
template <class N, class Functions>
glm::vec<4, N> preintegrated(const Functions& functions, const SegmentEnd<N, Functions>& front,
                             const SegmentEnd<N, Functions>& back, double same) {
    using Vec4 = glm::vec<4, N>;
    const double last = functions.last();
    const N length = back.position - front.position;
    const auto equal = larger(length, N(0) - length) < N(same);
    const Vec4 sum = functions.apart(front.sum, back.sum) +
                     integralBeyond(back.density, back.next, back.at.along, last) -
                     integralBeyond(front.density, front.next, front.at.along, last);
    const N middle = (front.position + back.position) * N(0.5 * last);
    const Vec4 within = blended(front.density, front.next, middle - front.at.below);
    const N share = N(1) / choose(equal, N(1), length);
    const auto of = [&](N apart, N here) { return choose(equal, here, apart * share); };
    return fromDensity(Vec4(of(sum.x, within.x), of(sum.y, within.y), of(sum.z, within.z), of(sum.w, within.w)));
}
glm::dvec4 preintegrated(const IntegralFunctions& functions, double front, double back);

/// Colour and opacity of a segment whose two halves have their own, where the value jumps between two parts. Twin:
/// lib/layers/classify.glsl.
template <class N> glm::vec<4, N> inHalves(const glm::vec<4, N>& front, const glm::vec<4, N>& back) {
    const N whole = N(1) / larger(front.w + back.w, N(1e-12));
    const auto color = [&](N a, N b) { return (a * front.w + b * back.w) * whole; };
    return {color(front.x, back.x), color(front.y, back.y), color(front.z, back.z),
            N(1) - squareRoot((N(1) - front.w) * (N(1) - back.w))};
}

/// preintegrated() for front = x / (size - 1), back = y / (size - 1), x fastest, with premultiplied colours so that
/// entries can be interpolated; O(size^2).
std::vector<glm::vec4> preintegrationTable(const IntegralFunctions& functions, int size);

} // namespace tessera::vis
