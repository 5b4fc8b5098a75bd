#pragma once

#include "vis/optics/adaptive_step.h"
#include "vis/raycast/ray_plan.h"

namespace tessera::vis {

/// The step code (stepCode() with stepUnit()) of every block of the plan's common grid, 0 where steps cannot be longer.
/// Empty: the scene has no adaptive steps, or the fields have no common grid.
std::vector<std::uint8_t> blockSteps(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info,
                                     const volume::Lattice& lattice);

/// Approximate share of samples that remain with a step code in a block of `edge` cells a side.
double samplesLeft(int code, const Scene& scene, const volume::DatasetInfo& info, const volume::Lattice& lattice,
                   double edge);

} // namespace tessera::vis
