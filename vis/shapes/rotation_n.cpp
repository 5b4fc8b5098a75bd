#include "vis/shapes/rotation_n.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

namespace tessera::vis {

RotationN::RotationN() {
    for (int i = 0; i < kMostAxes; ++i) at(i, i) = 1;
}

PointN RotationN::operator*(const PointN& point) const {
    PointN out{};
    for (int row = 0; row < kMostAxes; ++row)
        for (int column = 0; column < kMostAxes; ++column)
            out[std::size_t(row)] += at(row, column) * point[std::size_t(column)];
    return out;
}

RotationN RotationN::operator*(const RotationN& first) const {
    RotationN out;
    for (int row = 0; row < kMostAxes; ++row)
        for (int column = 0; column < kMostAxes; ++column) {
            double sum = 0;
            for (int k = 0; k < kMostAxes; ++k) sum += at(row, k) * first.at(k, column);
            out.at(row, column) = sum;
        }
    return out;
}

RotationN RotationN::inverse() const {
    RotationN out;
    for (int row = 0; row < kMostAxes; ++row)
        for (int column = 0; column < kMostAxes; ++column) out.at(row, column) = at(column, row);
    return out;
}

glm::dmat4 RotationN::firstAxes() const {
    glm::dmat4 out(0);
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) out[column][row] = at(row, column);
    return out;
}

glm::dmat4 RotationN::furtherAxes() const {
    glm::dmat4 out(0);
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) out[column][row] = at(row, column + 4);
    return out;
}

std::pair<int, int> planeAxes(int plane) {
    int b = 1;
    while (planeCount(b + 1) <= plane) ++b;
    return {plane - planeCount(b), b};
}

RotationN planeRotation(int a, int b, double angle) {
    RotationN out;
    out.at(a, a) = out.at(b, b) = std::cos(angle);
    out.at(b, a) = std::sin(angle);
    out.at(a, b) = -std::sin(angle);
    return out;
}

RotationN rotationOf(const std::vector<double>& degrees) {
    RotationN out;
    const int planes = std::min(int(degrees.size()), planeCount(kMostAxes));
    for (int plane = 0; plane < planes; ++plane) {
        const auto [a, b] = planeAxes(plane);
        out = planeRotation(a, b, glm::radians(degrees[std::size_t(plane)])) * out;
    }
    return out;
}

std::vector<double> anglesOf(const RotationN& rotation, int axes) {
    std::vector<double> angles(std::size_t(planeCount(axes)));
    RotationN rest = rotation;
    for (int last = axes - 1; last > 0; --last) {
        // The image of the last axis is (-sin 0, -sin 1 cos 0, -sin 2 cos 1 cos 0, ..., cos ... cos 0).
        double length = rest.at(last, last);
        for (int a = last - 1; a >= 0; --a) {
            const double part = rest.at(a, last);
            angles[std::size_t(planeIndex(a, last))] = std::atan2(-part, length);
            length = std::hypot(length, part);
        }
        for (int a = last - 1; a >= 0; --a)
            rest = planeRotation(a, last, -angles[std::size_t(planeIndex(a, last))]) * rest;
    }
    for (double& angle : angles) angle = glm::degrees(angle);
    return angles;
}

std::optional<std::array<int, 2>> facedAxes(const RotationN& rotation, double tolerance) {
    std::array<int, 2> found{-1, -1};
    for (int row = 0; row < 2; ++row)
        for (int axis = 0; axis < kMostAxes; ++axis) {
            if (std::abs(rotation.at(row, axis)) <= tolerance) continue;
            if (found[std::size_t(row)] >= 0 || rotation.at(row, axis) < 0) return std::nullopt;
            found[std::size_t(row)] = axis;
        }
    return found;
}

RotationN nearestFaced(const RotationN& rotation, int axes, const std::vector<int>& among) {
    std::vector<int> offered = among;
    for (int axis = 0; axis < axes && among.empty(); ++axis) offered.push_back(axis);
    std::array<int, 2> best{0, 1};
    double most = -3;
    for (const int right : offered)
        for (const int up : offered) {
            const double sum = rotation.at(0, right) + rotation.at(1, up);
            if (up != right && sum > most) most = sum, best = {right, up};
        }
    std::vector<int> order{best[0], best[1]};
    for (int axis = 0; axis < axes; ++axis)
        if (axis != best[0] && axis != best[1]) order.push_back(axis);
    int swaps = 0; // parity of the permutation
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t j = i + 1; j < order.size(); ++j) swaps += order[i] > order[j] ? 1 : 0;
    RotationN out;
    for (int row = 0; row < axes; ++row)
        for (int column = 0; column < axes; ++column) out.at(row, column) = column == order[std::size_t(row)] ? 1 : 0;
    if (swaps % 2 != 0) out.at(axes - 1, order.back()) = -1;
    return out;
}

} // namespace tessera::vis
