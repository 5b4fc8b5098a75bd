#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

/// Data that are a plane of others in space and time.
namespace tessera::volume {

/// The points p = (x, y, z, t) with dot(normal, p) + e = 0, over three of the four axes. Positions of such data are
/// places (x, y, z), where time stands in place of the axis that the plane is solved for: a time t lies at
/// t / timePerLength.
struct SpaceTimePlane {
    glm::dvec4 normal{0, 0, 0, 1}; ///< per unit of length, and of time
    double e = 0;
    int solved = 3;           ///< the axis that follows from the others: 0..2 is x, y, z, 3 is t
    double timePerLength = 1; ///< where t takes the place of x, y or z
    glm::dvec4 lo{0}, hi{0};  ///< the first and the last place and time of the data it is cut from
    bool operator==(const SpaceTimePlane&) const = default;

    /// Whether an axis is time, not length: `solved`.
    bool hasTimeAxis() const { return solved < 3; }
    /// The point in space and time at a position of the data, in the plane; it may lie outside of what it is cut from.
    glm::dvec4 pointAt(glm::dvec3 position) const;
    /// The position of a point of the plane; of another that of the point that has its three axes.
    glm::dvec3 positionOf(glm::dvec4 point) const;
    /// Whether a point lies in the plane, within the rounding of its numbers.
    bool holds(glm::dvec4 point) const;
    /// Whether a point lies in the data that the plane is cut from; one that is outside by rounding alone is moved in.
    bool reaches(glm::dvec4& point) const;
};

} // namespace tessera::volume
