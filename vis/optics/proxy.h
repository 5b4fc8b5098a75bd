#pragma once

#include "vis/scene/scene.h"
#include "volume/field/lattice.h"

/// Proxy geometry beside the ray caster: composite layers drawn as textured surfaces that the frame buffer blends, as
/// graphics hardware of 2002 did it (Röber 2002, section 4.4.7). On BCC each surface samples both sublattices (4.4.1).
///
/// The colour of a ray is the blend, front to back, of its meetings with the surfaces inside the box, where each has
/// the opacity correctedOpacity for its part of the ray: half the way to each neighbour, or all of the way to the face
/// of the box where there is none. What differs from the ray caster is where it samples:
///   slices: planes across the middle ray, as far apart as the middle ray's samples;
///   shells: spheres around the eye, likewise (planes in parallel projection);
///   stacks: the lattice's own planes across the axis that the middle ray follows most nearly: on CC through the
///           samples, on BCC through those of either sublattice. There each surface is a 2D image.
namespace tessera::vis {

struct ProxySurfaces {
    bool shells = false;  ///< spheres, else planes
    glm::dvec3 normal{0}; ///< of the planes, away from the eye
    double first = 0;     ///< radius, or offset along the normal, of the nearest one
    double spacing = 1;   ///< between neighbours
    int count = 0;
};

/// Whether a scene can be drawn by proxies: plain composite volumes and nothing else.
bool drawnByProxy(const Scene& scene);
/// The surfaces that meet the box. `stepFactor` widens the distance of slices and shells, as it does the step of rays.
ProxySurfaces proxySurfaces(const Scene& scene, const volume::Lattice& lattice, const WorldFrame& frame,
                            double stepFactor);

} // namespace tessera::vis
