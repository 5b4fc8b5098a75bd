#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>

/// Formulas that exist once for one number (double) and for a packet of numbers (vis/packet/lanes.h): they are
/// templates over the number, take decisions by choose(), and call these functions, which packets have of their own.
namespace tessera {

inline double choose(bool which, double a, double b) {
    return which ? a : b;
}
inline bool anyOf(bool which) {
    return which;
}
inline double smaller(double a, double b) {
    return std::min(a, b);
}
inline double larger(double a, double b) {
    return std::max(a, b);
}
inline double magnitude(double a) {
    return std::abs(a);
}
inline double squareRoot(double a) {
    return std::sqrt(a);
}
inline double roundDown(double a) {
    return std::floor(a);
}
inline double roundUp(double a) {
    return std::ceil(a);
}
/// base >= 0.
inline double power(double base, double exponent) {
    return std::pow(base, exponent);
}
/// 2^a.
inline double powerOfTwo(double a) {
    return std::exp2(a);
}
/// Base-two logarithm.
inline double logarithm(double a) {
    return std::log2(a);
}
inline double sine(double radians) {
    return std::sin(radians);
}
inline double cosine(double radians) {
    return std::cos(radians);
}
/// The angle of (x, y), -pi .. pi.
inline double angleOf(double y, double x) {
    return std::atan2(y, x);
}

template <class N> N clamped(N x, N lo, N hi) {
    return smaller(larger(x, lo), hi);
}
template <class N> N blended(N a, N b, N share) {
    return a * (N(1) - share) + b * share;
}
template <class N> glm::vec<3, N> blended(const glm::vec<3, N>& a, const glm::vec<3, N>& b, N share) {
    return a * (N(1) - share) + b * share;
}
/// 0 up to lo, 1 from hi on, smooth between.
template <class N> N smoothStep(N lo, N hi, N x) {
    const N t = clamped((x - lo) / (hi - lo), N(0), N(1));
    return t * t * (N(3) - N(2) * t);
}
template <class N> N inner(const glm::vec<3, N>& a, const glm::vec<3, N>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class N> glm::vec<3, N> crossProduct(const glm::vec<3, N>& a, const glm::vec<3, N>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class N> N lengthOf(const glm::vec<3, N>& a) {
    return squareRoot(inner(a, a));
}
template <class N> glm::vec<3, N> unit(const glm::vec<3, N>& a) {
    return a * (N(1) / lengthOf(a));
}
/// A vector of single numbers as one of packets.
template <class N, class T> glm::vec<3, N> spreadOut(const glm::vec<3, T>& a) {
    return {N(a.x), N(a.y), N(a.z)};
}

} // namespace tessera
