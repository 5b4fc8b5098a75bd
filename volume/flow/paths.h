#pragma once

#include "volume/base/progress.h"
#include "volume/field/lattice.h"
#include "volume/flow/runge_kutta.h"

#include <atomic>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

/// Particles in a vector field that changes with time. The unit of the field is lengths per time.
namespace tessera::volume {

struct PathSettings {
    glm::dvec3 cell{1};                  ///< steps and errors are measured in these lengths
    std::optional<Lattice> lattice = {}; ///< in those of its cells instead (StreamlineSettings)
    std::vector<double> times = {};      ///< rising; no step goes beyond one: the field has a kink there
    double tolerance = 1e-5;             ///< error of a step, cells
    double longestStep = 0.5;            ///< cells
    double longest = 1e300;              ///< of a path, each way, physical
    int mostSteps = 50000;               ///< each way
    /// Counts particles that stop after that many steps, on any thread; null: nobody asks.
    std::atomic<std::size_t>* stopped = nullptr;
};

/// The path of a particle: vertices in order of time.
struct Pathline {
    std::vector<glm::dvec3> places;
    std::vector<double> times;
};

/// The path of a particle that is at `seed` at a time, from where it enters the field (or `begin`) to where it leaves
/// it (or `end`), to 1/256 of a cell. Where the field rests for a while the particle waits. Empty if the vector at the
/// point is absent. Steps are those of flowStep(), none beyond half a cell, a stored time or 1/16 of the whole time.
Pathline pathline(const ChangingField& field, glm::dvec3 seed, double time, double begin, double end,
                  const PathSettings& settings);

/// Pathlines of all seeds, in order; the result does not depend on the number of threads. `field` is called from
/// several threads. Throws Cancelled.
std::vector<Pathline> pathlines(const ChangingField& field, std::span<const glm::dvec3> seeds, double time,
                                double begin, double end, const PathSettings& settings, const Progress& progress = {});

/// Where a particle that is at a place at one time is at another, later or earlier; nothing if it is outside of the
/// field by then. The map of flow.
std::optional<glm::dvec3> carried(const ChangingField& field, glm::dvec3 place, double from, double to,
                                  const PathSettings& settings);

} // namespace tessera::volume
