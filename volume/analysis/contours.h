#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

/// Lines on which the values of a plane are all the same.
namespace tessera::volume {

/// Values on the nodes of a plane, row by row from its lower edge, x fastest.
struct PlaneValues {
    glm::ivec2 size{0};
    std::vector<double> values; ///< NaN where absent
    std::vector<int> parts;     ///< of each value (volume/field/parts.h); empty: all is one part
};

struct ContourLine {
    double level = 0;
    std::vector<glm::dvec2> points; ///< in nodes: 0 .. size - 1; a closed line ends where it begins
    bool closed() const { return points.size() > 2 && points.front() == points.back(); }
};

/// The lines of each level, by marching squares: a point lies where the values of two neighbouring nodes, mixed
/// linearly, are the level. No line runs where a node of its cell is absent, nor between nodes of different parts. A
/// saddle goes with the mean of its cell.
std::vector<ContourLine> contourLines(const PlaneValues& plane, std::span<const double> levels);

/// A coordinate in nodes as one in space, given the places of the nodes: linear between them, so that contours of
/// uneven axes lie where values between samples are the level. `places` has at least one.
inline double placeOfNode(std::span<const double> places, double node) {
    if (places.size() < 2) return places.front();
    const auto i = std::size_t(std::clamp(std::floor(node), 0.0, double(places.size() - 2)));
    return places[i] + (node - double(i)) * (places[i + 1] - places[i]);
}

} // namespace tessera::volume
