#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>

/// One step along a vector field that may change with time.
namespace tessera::volume {

/// A vector at a place and a time, lengths per time; empty where there is none.
using ChangingField = std::function<std::optional<glm::dvec3>(glm::dvec3 position, double time)>;

struct FlowStep {
    bool present = false;        ///< false: the field is absent at a place that the step asks for
    glm::dvec3 end{0}, slope{0}; ///< slope: the field at the end
    double error = 0;            ///< estimate, cells
    double reach = 0;            ///< farthest place that was asked for, or the first absent one, cells from the start
};

/// One step from a place and a time, where the field is `slope`, over the time `h`, which may be negative. `cell`:
/// edges of a cell, in which errors and distances are measured.
///
/// J. R. Dormand, P. J. Prince: A family of embedded Runge-Kutta formulae, J. Comp. Appl. Math. 6, 1980: fifth order,
/// the error estimated by the difference from the fourth.
FlowStep flowStep(const ChangingField& field, glm::dvec3 from, double time, glm::dvec3 slope, double h,
                  glm::dvec3 cell);

/// By how much a step of that error is to be longer or shorter so that the next one is within the tolerance.
double stepFactor(double tolerance, double error);

} // namespace tessera::volume
