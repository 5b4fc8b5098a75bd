#pragma once

#include "tests/reference/prepared.h"
#include "vis/optics/projection_sums.h"

#include <optional>

namespace tessera::vis::reference {

/// Accumulates a projection layer along a ray; the ray styles are defined in vis/optics/ray_setup.h.
class Projected {
public:
    /// Adds a sample at a world position with a step length; an absent one ends the rise to a local maximum.
    void add(const Prepared& scene, const DrawnLayer& layer, std::optional<Reading> found, glm::dvec3 place,
             double step);

    /// The result; nullopt if no sample was present.
    struct Shown {
        glm::dvec3 color{0}; ///< linear light
        double opacity = 0, interest = 1;
    };
    std::optional<Shown> shown(const Prepared& scene, const DrawnLayer& layer) const;

private:
    glm::dvec3 colorOfSum(const DrawnLayer& layer, glm::dvec4 own) const;

    ProjectionSums<double, bool> sums_{.found = false};
    glm::dvec3 bestWorld_{0};
    Interest bestInterest_ = {};
    LensAction bestLens_ = {};
    double tint_ = 0, tintWeight_ = 0; ///< of sums: weighted sum of the colour channel, and its weight
};

} // namespace tessera::vis::reference
