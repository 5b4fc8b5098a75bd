#pragma once

#include "vis/optics/adaptive_step.h"
#include "vis/raycast/ray_plan.h"

namespace tessera::vis {

/// For every block of the plan's common grid the code of its step (stepCode() with stepUnit()), 0 where something keeps
/// it from being a longer one. Empty: the scene has none, or the fields have no common grid.
std::vector<std::uint8_t> blockSteps(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info,
                                     const volume::Lattice& lattice);

/// About the share of its samples that a step leaves in a block, `edge` cells a side.
double samplesLeft(int code, const Scene& scene, const volume::DatasetInfo& info, const volume::Lattice& lattice,
                   double edge);

} // namespace tessera::vis
