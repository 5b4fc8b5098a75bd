#pragma once

#include "vis/reference/prepared.h"

#include <optional>

namespace tessera::vis::reference {

/// What a layer that looks at the whole ray has seen of it; the styles are those of vis/optics/ray_setup.h.
class Projected {
public:
    /// A sample at a world place, `step` long; absent ones end the rise to a local maximum.
    void add(const Prepared& scene, const DrawnLayer& layer, std::optional<Reading> found, glm::dvec3 place,
             double step);

    /// What it shows in the end; nullopt where it has seen nothing.
    struct Shown {
        glm::dvec3 color{0}; ///< linear light
        double opacity = 0, interest = 1;
    };
    std::optional<Shown> shown(const Prepared& scene, const DrawnLayer& layer) const;

private:
    glm::dvec3 colorOfSum(const DrawnLayer& layer, glm::dvec4 own) const;

    double best_ = -1, bestPlace_ = 0;
    glm::dvec3 bestWorld_{0};
    Interest bestInterest_ = {};
    LensAction bestLens_ = {};
    bool found_ = false; ///< a local maximum
    double factors_ = 0, weighted_ = 0, absorbed_ = 0;
    double tint_ = 0, tintWeight_ = 0; ///< of sums: what they are coloured by, times its weight; that weight
    int count_ = 0;
};

} // namespace tessera::vis::reference
