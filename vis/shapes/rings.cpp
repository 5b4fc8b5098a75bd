#include "vis/shapes/rings.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace tessera::vis {

namespace {

constexpr int kSides = 12;

} // namespace

AxisFrame frameAlong(glm::dvec3 direction) {
    const glm::dvec3 along = glm::normalize(direction);
    const glm::dvec3 other = std::abs(along.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(other, along));
    return {along, u, glm::cross(along, u)};
}

LineCourse simplified(const LineCourse& course, double apart, double step) {
    const std::size_t n = course.places.size();
    if (n < 3) return course;
    std::vector<bool> kept(n, false);
    kept.front() = kept.back() = true;
    std::vector<std::pair<std::size_t, std::size_t>> parts{{0, n - 1}};
    while (!parts.empty()) {
        const auto [first, last] = parts.back();
        parts.pop_back();
        const glm::dvec3 from = course.places[first], way = course.places[last] - from;
        const double length2 = glm::dot(way, way);
        double worst = 1;
        std::size_t at = first;
        for (std::size_t i = first + 1; i < last; ++i) {
            const glm::dvec3 to = course.places[i] - from;
            const double t = length2 > 0 ? std::clamp(glm::dot(to, way) / length2, 0.0, 1.0) : 0;
            const double even = (1 - t) * double(course.scalars[first]) + t * double(course.scalars[last]);
            const double colour = std::abs(double(course.scalars[i]) - even);
            double error = glm::length(to - t * way) / apart;
            if (step > 0 && colour > error * step) error = colour / step;
            if (error > worst) worst = error, at = i;
        }
        if (at == first) continue;
        kept[at] = true;
        parts.emplace_back(first, at);
        parts.emplace_back(at, last);
    }
    LineCourse out;
    for (std::size_t i = 0; i < n; ++i) {
        if (!kept[i]) continue;
        out.places.push_back(course.places[i]);
        out.scalars.push_back(course.scalars[i]);
    }
    return out;
}

LineCourse courseOf(const LineSet& lines, std::uint32_t begin, std::uint32_t end, double apart, glm::dvec3 stretch) {
    LineCourse out;
    for (std::uint32_t i = begin; i < end; ++i) {
        const glm::dvec3 place = glm::dvec3(lines.positions[i]) * stretch;
        if (!out.places.empty() && glm::distance(place, out.places.back()) <= apart) continue;
        out.places.push_back(place);
        out.scalars.push_back(lines.scalars.empty() ? 0 : lines.scalars[i]);
    }
    return out;
}

double colorStep(const std::vector<float>& scalars) {
    constexpr double kColorSteps = 250; // distinguishable colours over the range
    const auto [least, most] = std::minmax_element(scalars.begin(), scalars.end());
    return scalars.empty() ? 0 : double(*most - *least) / kColorSteps;
}

std::vector<AxisFrame> framesOf(std::span<const glm::dvec3> places, AxisFrame frame) {
    std::vector<AxisFrame> out;
    const std::size_t n = places.size();
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec3 way = places[std::min(i + 1, n - 1)] - places[i > 0 ? i - 1 : 0];
        if (glm::length(way) > 0) frame.along = glm::normalize(way);
        const glm::dvec3 u = frame.u - frame.along * glm::dot(frame.u, frame.along);
        frame.u = glm::length(u) > 1e-6 ? glm::normalize(u) : frameAlong(frame.along).u;
        frame.v = glm::cross(frame.along, frame.u);
        out.push_back(frame);
    }
    return out;
}

void Rings::add(glm::dvec3 centre, const AxisFrame& frame, double radius, double lean, double outwards, float scalar) {
    for (int i = 0; i < kSides; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSides;
        const glm::dvec3 out = frame.u * std::cos(angle) + frame.v * (std::sin(angle) * flat_);
        const glm::dvec3 across = glm::normalize(frame.u * (std::cos(angle) * flat_) + frame.v * std::sin(angle));
        mesh.positions.emplace_back((centre + out * radius) / stretch_);
        // Normals transform with the inverse transpose.
        mesh.normals.emplace_back(glm::normalize((across * outwards + frame.along * lean) * stretch_));
        mesh.scalars.push_back(scalar);
    }
}

void Rings::connect() {
    const auto first = std::uint32_t(mesh.positions.size()) - 2 * kSides;
    for (std::uint32_t i = 0; i < kSides; ++i) {
        const std::uint32_t next = (i + 1) % kSides;
        const std::uint32_t a = first + i, b = first + next, c = a + kSides, d = b + kSides;
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, d, c});
    }
}

void Rings::face(glm::dvec3 from, glm::dvec3 to, const AxisFrame& frame, double radiusFrom, double radiusTo,
                 float scalar) {
    const double rise = glm::dot(to - from, frame.along), fall = radiusFrom - radiusTo;
    add(from, frame, radiusFrom, fall, rise, scalar);
    add(to, frame, radiusTo, fall, rise, scalar);
    connect();
}

} // namespace tessera::vis
