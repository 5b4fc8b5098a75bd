#pragma once

#include "vis/scene/scene.h"
#include "volume/field/lattice.h"

/// Proxy geometry as an alternative to ray casting: composite layers drawn as textured surfaces that the frame buffer
/// blends, as on graphics hardware of 2002 (Röber 2002, section 4.4.7). On BCC each surface samples both sublattices
/// (4.4.1).
///
/// The colour of a ray is the front-to-back blend of its intersections with the surfaces inside the box. Each has the
/// opacity correctedOpacity() for its segment of the ray: half the distance to each neighbour, or the full distance to
/// the face of the box if there is none. The kinds differ in where they sample:
///   slices: planes perpendicular to the central ray, spaced like its samples;
///   shells: spheres around the eye, spaced likewise (planes in parallel projection);
///   stacks: lattice planes perpendicular to the axis closest to the central ray: on CC through the samples, on BCC
///           through those of both sublattices. There each surface is a 2D image.
namespace tessera::vis {

struct ProxySurfaces {
    bool shells = false;  ///< spheres, else planes
    glm::dvec3 normal{0}; ///< of the planes, pointing away from the eye
    double first = 0;     ///< radius, or offset along the normal, of the nearest one
    double spacing = 1;   ///< distance between neighbours
    int count = 0;
};

/// Whether a scene can be drawn by proxy geometry: plain composite volumes only.
bool drawnByProxy(const Scene& scene);
/// The surfaces that intersect the box. `stepFactor` increases the spacing of slices and shells as it does the step of
/// rays.
ProxySurfaces proxySurfaces(const Scene& scene, const volume::Lattice& lattice, const WorldFrame& frame,
                            double stepFactor);

} // namespace tessera::vis
