#pragma once

#include "vis/optics/surface_light.h"

#include <glm/vec4.hpp>
#include <span>
#include <stop_token>
#include <vector>

/// Light inside the volume: how much of each light, and of the light from everywhere, reaches a place through what lies
/// in between, on a coarse grid over the box. Made when the picture's matter or its lights change, not per frame. A
/// template on the number type: float for the picture, double for the reference.
namespace tessera::vis {

/// Cells over the world box: as many along the longest edge as wanted, about cubes.
struct LightGrid {
    glm::ivec3 size{1};
    glm::dvec3 halfSize{0.5};

    glm::dvec3 cell() const { return 2.0 * halfSize / glm::dvec3(size); }
    std::size_t count() const { return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z); }
    std::size_t index(glm::ivec3 at) const {
        return (std::size_t(at.z) * std::size_t(size.y) + std::size_t(at.y)) * std::size_t(size.x) + std::size_t(at.x);
    }
    glm::dvec3 center(glm::ivec3 at) const { return (glm::dvec3(at) + 0.5) * cell() - halfSize; }
    bool operator==(const LightGrid&) const = default;
};
LightGrid lightGrid(const WorldFrame& frame, const Shadows& shadows);

/// Matter of a cell, made of kMatterSamples^3 points (the middles of its parts): a = extinction per world unit, rgb =
/// extinction times colour (linear).
///   Composite layers: the mean over the points of -ln(1 - min(opacity, kThickest)) density / kReferenceLength,
///     opacity of the transfer function times the DOI's factor; absent and clipped points have none.
///   Iso layers: -ln(1 - min(opacity, kThickest)) max(0, 1 - d / h) / h with h the longest edge of a cell and d = |m -
///     value| / g the distance to the surface, from the mean m of the points and the gradient g of their trilinear
///     fit; none where a point is absent or the centre clipped. Along the normal it adds up to the opacity.
inline constexpr int kMatterSamples = 2;
inline constexpr double kThickest = 0.999;
template <class Number> using Matter = std::vector<glm::vec<4, Number>>;

inline constexpr int kShadowLights = 3; ///< lights, from the first, that cast shadows

template <class Number> struct LightVolume {
    using Vec3 = glm::vec<3, Number>;
    using Vec4 = glm::vec<4, Number>;
    LightGrid grid;
    std::vector<Vec4> visible;   ///< share of the first three lights, and of light from everywhere, that comes through
    std::vector<Vec3> scattered; ///< light that came through matter, coloured and blurred; empty: none

    /// Trilinear between cell centres, constant beyond the outermost.
    Vec4 visibleAt(glm::dvec3 world) const;
    Vec3 scatteredAt(glm::dvec3 world) const;
};

/// Spreads light through matter.
///
/// A far light goes from slice to slice along the axis it is most aligned with: the optical depth of a cell is that of
/// the place one slice towards the light (bilinear, none outside) plus the extinction on the way (mean of both ends);
/// visible = exp(-depth). A point light is marched to from each cell in steps of half a cell.
/// Light from everywhere: 14 far lights (6 faces, 8 corners) whose depth fades with exp(-distance / reach); visible =
/// min(1, 2 mean exp(-depth)), so that a flat surface, which half of them reach, is not darkened.
/// Translucency t (far lights only; after Kniss, Premoze, Hansen, Ebert, Interactive translucent volume rendering and
/// procedural modeling, 2002): a second light goes the same way with extinction a - t rgb per channel (what matter
/// scatters forward keeps its colour) and in each slice a share scatter / 2 of it is the mean of the four neighbours
/// one cell aside; scattered = the sum over lights of colour times what it has more than the direct light. Stops early,
/// with an undefined result, when the token asks.
template <class Number>
LightVolume<Number> spreadLight(const LightGrid& grid, const Matter<Number>& matter,
                                std::span<const PlacedLight> lights, const Shadows& shadows, std::stop_token stop = {});

extern template struct LightVolume<float>;
extern template struct LightVolume<double>;
extern template LightVolume<float> spreadLight(const LightGrid&, const Matter<float>&, std::span<const PlacedLight>,
                                               const Shadows&, std::stop_token);
extern template LightVolume<double> spreadLight(const LightGrid&, const Matter<double>&, std::span<const PlacedLight>,
                                                const Shadows&, std::stop_token);

} // namespace tessera::vis
