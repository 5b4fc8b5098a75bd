#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <vector>

namespace tessera::volume {

struct EvenSettings {
    glm::dvec3 from{0}, to{1}; ///< corners of the box of the seeds; without width along an axis: a plane
    double separation = 0.1;   ///< of a seed from every line that was there before
    double closest = 0.5;      ///< share of the separation at which a line ends before another, or before itself
    int most = 1000;           ///< lines
};

struct EvenLines {
    std::vector<glm::dvec3> seeds;
    std::vector<std::vector<glm::dvec3>> lines; ///< through the seeds, cut where they come too near to others
};

/// Lines with even distances. `trace` gives the line through a seed, the seed one of its vertices, or nothing;
/// `allowed` says where seeds may be. Seeds lie beside lines that are there already, at the separation; where there are
/// none, on a grid. Deterministic. A `trace` that gives the seed alone makes evenly spaced points.
///
/// B. Jobard, W. Lefer: Creating Evenly-Spaced Streamlines of Arbitrary Density, Visualization in Scientific Computing
/// 1997; in space candidates lie on six sides of a line, and distances are found by a grid of occupied cells.
EvenLines evenLines(const std::function<std::vector<glm::dvec3>(glm::dvec3 seed)>& trace,
                    const std::function<bool(glm::dvec3 place)>& allowed, const EvenSettings& settings);

} // namespace tessera::volume
