#pragma once

#include "volume/flow/paths.h"

#include <glm/vec3.hpp>
#include <vector>

/// Lines that are made of particles: streaklines and timelines.
namespace tessera::volume {

struct StreakSettings {
    PathSettings path = {};
    double apart = 1; ///< cells: neighbours that are farther apart get another particle between them
    int most = 4000;  ///< particles of a line
};

/// Neighbouring particles of a line in order of what tells them apart. Each row is where they are at one moment.
struct ParticleLine {
    std::vector<double> marks;                 ///< of particles: when, or where on the line, they were released
    std::vector<std::vector<glm::dvec3>> rows; ///< [moment][particle]
};

/// Where all particles are now that were released at `seed` from time `begin` until now: pieces of a streakline, each
/// from its oldest to its newest particle, marks: times of release. A line falls apart where particles have left the
/// field. Particles are inserted until neighbours are `apart` at most; a piece that comes and goes between two releases
/// at 1/64 of the time is missed. Throws Cancelled.
std::vector<ParticleLine> streakline(const ChangingField& field, glm::dvec3 seed, double begin, double now,
                                     const StreakSettings& settings, const Progress& progress = {});

/// Where the particles are at each of the moments (rising, none before `released`) that were released together along
/// the line between two places: pieces of a timeline, marks: 0 to 1 along the line of seeds. Of what leaves the field
/// before the last moment nothing is kept. As streakline(). Throws Cancelled.
std::vector<ParticleLine> timeline(const ChangingField& field, glm::dvec3 from, glm::dvec3 to, double released,
                                   const std::vector<double>& moments, const StreakSettings& settings,
                                   const Progress& progress = {});

} // namespace tessera::volume
