#pragma once

#include <glm/vec3.hpp>

namespace tessera::volume {

/// A box cut by planes of one direction: for a unit normal n and the box [lo, hi], the volume of its part with
/// dot(n, p) <= s, and the area of the plane dot(n, p) = s within it, the derivative of that volume:
///
///     volume(s) = 1 / (m! prod |n_i|) * sum over corners k of (-1)^|k| max(0, s - s_k)^m * prod of edges along the
///     rest
///
/// over the m axes along which the normal has a share. Axes along which n_i * edge is below 1e-4 of the largest one
/// count as lying in the plane: the cut is moved by less than that share of the box.
class BoxCut {
public:
    BoxCut(glm::dvec3 normal, glm::dvec3 lo, glm::dvec3 hi);
    double first() const { return first_; } ///< least dot(n, p) in the box
    double last() const { return last_; }   ///< largest
    double volume(double s) const;
    double area(double s) const;

private:
    double sum(double s, int power) const;

    double first_ = 0, last_ = 0;
    int axes_ = 0;         ///< m
    double edges_[3] = {}; ///< |n_i| * edge of those axes
    double whole_ = 1;     ///< volume of the box
    double scale_ = 1;     ///< prod of edges along the rest / prod |n_i|
};

} // namespace tessera::volume
