#pragma once

#include "vis/scene/lighting.h"
#include "volume/base/vectors.h"

#include <array>

/// Cube maps of incoming light: diffuse, indexed by the normal, and specular, indexed by the mirrored direction. A
/// sample costs two texture lookups, however many lights there are.
namespace tessera::vis {

/// Where a direction meets a cube around the origin, by GL's convention: face 0..5, and u, v on it, -1..1.
template <class N> struct CubePlaceOf { N face, u, v; };
template <class N> CubePlaceOf<N> placeOnCube(const glm::vec<3, N>& direction) {
    const auto& [x, y, z] = std::array{direction.x, direction.y, direction.z};
    const N wide = magnitude(x), high = magnitude(y), deep = magnitude(z);
    const auto alongX = (wide >= high) & (wide >= deep);
    const auto alongY = high >= deep;
    const auto of = [&](N onX, N onY, N onZ) { return choose(alongX, onX, choose(alongY, onY, onZ)); };
    const auto bySign = [](N sign, N above, N below) { return choose(sign > N(0), above, below); };
    return {of(bySign(x, N(0), N(1)), bySign(y, N(2), N(3)), bySign(z, N(4), N(5))),
            of(bySign(x, -z, z) / wide, x / high, bySign(z, x, -x) / deep),
            of(-y / wide, bySign(y, z, -z) / high, -y / deep)};
}
/// Bilinear value of a cube map in a direction; `texel(face, i, j)` gives those of a face, -1 .. edge each: what lies
/// beyond the face in the direction of the texel that would be there.
template <class N, class Texel>
glm::vec<3, N> bilinearOnCube(int edge, const glm::vec<3, N>& direction, const Texel& texel) {
    const CubePlaceOf<N> place = placeOnCube(direction);
    const N x = (place.u + N(1)) * N(0.5 * edge) - N(0.5), y = (place.v + N(1)) * N(0.5 * edge) - N(0.5);
    const N i = roundDown(x), j = roundDown(y);
    const auto row = [&](N of) { return blended(texel(place.face, i, of), texel(place.face, i + N(1), of), x - i); };
    return blended(row(j), row(j + N(1)), y - j);
}

/// A map of directions on the faces of a cube, in GL's order and orientation (+x, -x, +y, -y, +z, -z).
struct CubeMap {
    int edge = 1;
    std::vector<glm::dvec3> texels; ///< 6 * edge * edge, rows in GL's order

    /// Unit direction through a point of a face; coordinates beyond -1..1 continue its plane.
    static glm::dvec3 direction(int face, double u, double v); ///< u, v in -1..1
    glm::dvec3 texelDirection(std::size_t index) const;
    /// Solid angle of a texel, in steradians.
    double solidAngle(std::size_t index) const;
    /// Texel of a face, -1 .. edge each, see bilinearOnCube().
    glm::dvec3 texel(int face, int i, int j) const;
    /// Bilinear, also across edges of faces.
    glm::dvec3 at(glm::dvec3 direction) const;
};

/// Radiance of the built-in environments from a direction (length 1, y up), linear; white paper under an open sky is
/// about 1. Environment::Picture is not built in and gives 0.
glm::dvec3 surroundings(Environment environment, glm::dvec3 direction);

/// Both maps of a lighting, in the axes of the environment (`fromWorld` transforms world directions to them).
///   diffuse(n)  = environment: 1 / pi integral of L max(n.l, 0); a light: colour max(n.l, 0)
///   specular(r) = environment: integral of L w(r.l) over integral of w; a light, Phong: colour max(r.l, 0)^(s / 4);
///                 physical: pi colour w(r.l) over integral of w
///   w of Phong: max(c, 0)^(s / 4), c = r.l (a mirrored lobe as wide as (n.h)^s); physical: D(n.h) c with n = v = r,
///   (n.h)^2 = (1 + c) / 2 (Karis, Real shading in Unreal Engine 4, 2013).
/// The environment is multiplied by its strength, in the specular map also by the reflectance. A point light is treated
/// as a directional one, seen from the centre.
struct LightMaps {
    CubeMap diffuse, specular;
    glm::dmat3 fromWorld{1};
};
inline constexpr int kDiffuseEdge = 12, kSpecularEdge = 32, kSurroundingsEdge = 24;

/// Rotation from world directions to the axes of the maps.
glm::dmat3 mapFromWorld(const Lighting& lighting, const Camera& camera);
/// The maps of the environment alone: expensive (some ten milliseconds), to be cached. `picture`: the environment of
/// Environment::Picture, in world axes (vis/image/light_picture.h); null: black.
LightMaps environmentMaps(const Lighting& lighting, const CubeMap* picture = nullptr);
/// Whether two lightings have equal environmentMaps, given equal pictures.
bool sameEnvironment(const Lighting& a, const Lighting& b);
/// Adds the lights to the environment's maps if the lighting uses maps for them.
LightMaps lightMaps(const Lighting& lighting, const Camera& camera, LightMaps environment);

} // namespace tessera::vis
