#pragma once

#include "vis/scene/lighting.h"

#include <array>

/// Cube maps of light: diffuse by the normal, specular by the mirrored direction. However many lights they are made of,
/// a sample looks at two texels.
namespace tessera::vis {

/// A map of directions on the faces of a cube, in GL's order and orientation (+x, -x, +y, -y, +z, -z).
struct CubeMap {
    int edge = 1;
    std::vector<glm::dvec3> texels; ///< 6 * edge * edge, rows in GL's order

    /// Direction through the middle of a texel, length 1; texels beyond an edge continue the plane of the face.
    static glm::dvec3 direction(int face, double u, double v); ///< u, v in -1..1
    glm::dvec3 texelDirection(std::size_t index) const;
    /// Share of the sphere that a texel covers, times 4 pi.
    double solidAngle(std::size_t index) const;
    /// Bilinear; across edges with the texels of the next face.
    glm::dvec3 at(glm::dvec3 direction) const;
};

/// Light of the built-in surroundings from a direction (length 1, y up), linear; white paper under an open one is
/// about 1. A picture's is not built in: none.
glm::dvec3 surroundings(Environment environment, glm::dvec3 direction);

/// Both maps of a lighting, in the axes of the environment (`fromWorld` turns world directions into them).
///   diffuse(n)  = environment: 1 / pi integral of L max(n.l, 0); a light: colour max(n.l, 0)
///   specular(r) = environment: integral of L w(r.l) over integral of w; a light, Phong: colour max(r.l, 0)^(s / 4);
///                 physical: pi colour w(r.l) over integral of w
///   w of Phong: max(c, 0)^(s / 4), c = r.l (a mirrored lobe as wide as (n.h)^s); physical: D(n.h) c with n = v = r,
///   (n.h)^2 = (1 + c) / 2 (Karis, Real shading in Unreal Engine 4, 2013).
/// The environment is multiplied by its strength, in the specular map by the reflection too. A point light counts as a
/// far one seen from the centre.
struct LightMaps {
    CubeMap diffuse, specular;
    glm::dmat3 fromWorld{1};
};
inline constexpr int kDiffuseEdge = 12, kSpecularEdge = 32, kSurroundingsEdge = 24;

/// Turns world directions into the axes of the maps.
glm::dmat3 mapFromWorld(const Lighting& lighting, const Camera& camera);
/// The part that only depends on the environment and the surface: costly (some ten milliseconds), to be kept.
/// `picture`: the surroundings of Environment::Picture, in world axes (vis/image/light_picture.h); null: dark.
LightMaps environmentMaps(const Lighting& lighting, const CubeMap* picture = nullptr);
/// Whether two lightings have equal environmentMaps, if their pictures are equal.
bool sameEnvironment(const Lighting& a, const Lighting& b);
/// With the lights added where the lighting wants them in maps.
LightMaps lightMaps(const Lighting& lighting, const Camera& camera, LightMaps environment);

} // namespace tessera::vis
