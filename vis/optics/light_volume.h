#pragma once

#include "vis/optics/surface_light.h"
#include "vis/transfer/transfer_function.h"
#include "volume/base/vectors.h"

#include <algorithm>
#include <glm/vec4.hpp>
#include <numbers>
#include <span>
#include <stop_token>
#include <vector>

/// Light volume for shadows, ambient occlusion and translucency: the transmitted fraction of each light and of ambient
/// light, on a coarse grid over the box. Computed when the extinction of the scene or its lights change, not per frame.
/// Templated on the number type: float for the renderer, double for the reference.
namespace tessera::vis {

/// A grid over the world box: `resolution` cells along the longest edge, of about cubic cells.
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

/// Trilinear value between the centres of cells, constant beyond the outer ones; `at(index)` gives that of a cell.
template <class N, class At> auto betweenCells(const LightGrid& grid, const glm::vec<3, N>& world, const At& at) {
    const glm::dvec3 cell = grid.cell();
    N first[3], second[3], share[3]; // indices along each axis, times what they count for
    for (int axis = 0, stride = 1; axis < 3; stride *= grid.size[axis++]) {
        const double last = grid.size[axis] - 1;
        const N p = clamped((world[axis] + N(grid.halfSize[axis])) * N(1 / cell[axis]) - N(0.5), N(0), N(last));
        const N below = roundDown(p);
        first[axis] = below * N(stride);
        second[axis] = smaller(below + N(1), N(last)) * N(stride);
        share[axis] = p - below;
    }
    const auto row = [&](N y, N z) { return blended(at(first[0] + y + z), at(second[0] + y + z), share[0]); };
    const auto slice = [&](N z) { return blended(row(first[1], z), row(second[1], z), share[1]); };
    return blended(slice(first[2]), slice(second[2]), share[2]);
}

/// Optical properties of a cell, from kMediumSamples^3 points (the centres of its subcells): a = extinction per world
/// unit, rgb = extinction times colour (linear).
///   Composite layers: the mean over the points of -ln(1 - min(opacity, kThickest)) density / kReferenceLength,
///     opacity of the transfer function times the factor of the degree of interest; absent and clipped points have
///       none.
///   Iso layers: -ln(1 - min(opacity, kThickest)) max(0, 1 - d / h) / h with h the longest edge of a cell and d = |m -
///     value| / g the distance to the surface, from the mean m of the points and the gradient g of their trilinear
///     fit; none if a point is absent or the centre clipped. Integrated along the normal it gives the opacity.
inline constexpr int kMediumSamples = 2;
inline constexpr double kThickest = 0.999;
template <class Number> using Medium = std::vector<glm::vec<4, Number>>;

/// Formulas of the extinction as templates over the number (volume/base/numbers.h). Twin:
/// vis/shaders/light_medium.frag.glsl.
enum class MediumKind { None, Volume, Surface };
/// What a layer adds to the extinction.
struct MediumLayer {
    MediumKind kind = MediumKind::None;
    double density = 1; ///< of a volume
    double value = 0;   ///< of a surface
};

/// Optical depth of an opacity.
template <class N> N opticalDepth(N opacity) {
    return logarithm(N(1) - smaller(opacity, N(kThickest))) * N(-std::numbers::ln2);
}

/// The points around the centre of a cell, between which a surface is looked for.
template <class N> struct SurfacePoints {
    static constexpr int kPoints = kMediumSamples * kMediumSamples * kMediumSamples;
    N mean{0}, found{0};
    glm::vec<3, N> slope{N(0), N(0), N(0)}; ///< of their trilinear fit

    /// Way in cells from the centre, times 2.
    static glm::dvec3 way(int point) { return glm::dvec3(point & 1, point >> 1 & 1, point >> 2) - 0.5; }
    /// A value that is present (0: none), and whether it belongs to the part of the first point.
    template <class Which> void add(int point, const glm::dvec3& edges, N value, Which same) {
        found += choose(same, N(1), N(0));
        mean += value * N(1.0 / kPoints);
        // kPoints (1/2) / 4 (upper mean - lower mean) / (edge / 2)
        slope = slope + spreadOut<N>(way(point) / edges) * value;
    }
    /// Of a surface of this depth, per world unit; none unless all points are present.
    N extinction(double value, N depth, double longest) const {
        const N away = magnitude(mean - N(value)) / larger(lengthOf(slope), N(1e-20));
        const N own = depth * larger(N(0), N(1) - away * N(1 / longest)) * N(1 / longest);
        return choose(found > N(kPoints - 0.5), own, N(0));
    }
};

/// The extinction of a cell (a), and extinction times colour (rgb). `scene` has layers(), layer(i) (a MediumLayer),
/// kept(world) for clips, and of layer i read(i, world), which gives value, present and part, and at(i, value, world)
/// and surface(i, world), which give colour and opacity of a volume's value and of a surface after brushes and lenses.
template <class N, class Scene>
glm::vec<4, N> mediumAt(const Scene& scene, const LightGrid& grid, const glm::vec<3, N>& center) {
    using Points = SurfacePoints<N>;
    const glm::dvec3 edges = grid.cell();
    const double longest = std::max({edges.x, edges.y, edges.z});
    glm::vec<4, N> sum(N(0), N(0), N(0), N(0));
    const auto add = [&](const glm::vec<4, N>& color, N extinction) {
        sum = sum + glm::vec<4, N>(color.x, color.y, color.z, N(1)) * extinction;
    };
    for (int i = 0; i < scene.layers(); ++i) {
        const MediumLayer layer = scene.layer(i);
        if (layer.kind == MediumKind::None) continue;
        Points points;
        N part(0); // of the first point; a surface lies within one part
        for (int n = 0; n < Points::kPoints; ++n) {
            const glm::vec<3, N> world = center + spreadOut<N>(0.5 * Points::way(n) * edges);
            const auto found = scene.read(i, world);
            if (layer.kind == MediumKind::Volume) {
                const glm::vec<4, N> own = scene.at(i, found, world);
                const N extinction = opticalDepth(own.w) * N(layer.density / kReferenceLength / Points::kPoints);
                add(own, choose(found.present & scene.kept(world), extinction, N(0)));
                continue;
            }
            if (n == 0) part = choose(found.present, found.part, N(0));
            const auto same = found.present & (found.part >= part) & (found.part <= part);
            points.add(n, edges, choose(found.present, found.value, N(0)), same);
        }
        if (layer.kind != MediumKind::Surface) continue;
        const glm::vec<4, N> own = scene.surface(i, center);
        const N extinction = points.extinction(layer.value, opticalDepth(own.w), longest);
        add(own, choose(scene.kept(center), extinction, N(0)));
    }
    return sum;
}

inline constexpr int kShadowLights = 3; ///< number of lights, from the first, that cast shadows

template <class Number> struct LightVolume {
    using Vec3 = glm::vec<3, Number>;
    using Vec4 = glm::vec<4, Number>;
    LightGrid grid;
    std::vector<Vec4> visible;   ///< transmitted fractions of the first three lights and of ambient light
    std::vector<Vec3> scattered; ///< forward-scattered light, coloured and blurred; empty: none

    /// Trilinear between cell centres, clamped at the border.
    Vec4 visibleAt(glm::dvec3 world) const;
    Vec3 scatteredAt(glm::dvec3 world) const;
};

/// Propagates light through the volume.
///
/// Directional lights: slice by slice along the axis closest to the light direction. The optical depth of a cell is
/// that of the point one slice towards the light (bilinear, 0 outside) plus the extinction of the segment (mean of both
/// ends); visible = exp(-depth). Point lights: marched from each cell in steps of half a cell.
/// Ambient light: 14 directional lights (6 faces, 8 corners) whose depth is attenuated by exp(-distance / reach);
/// visible = min(1, 2 mean exp(-depth)), so that a flat surface, which half of them reach, is not darkened.
/// Translucency t (directional lights only; after Kniss, Premoze, Hansen, Ebert, Interactive translucent volume
/// rendering and procedural modeling, 2002): a second light is propagated with extinction a - t rgb per channel
/// (forward-scattered light keeps the colour of the medium), and in each slice a fraction scatter / 2 of it is replaced
/// by the mean of the four neighbours one cell aside; scattered = the sum over lights of colour times its excess over
/// the direct light. Stops early, with an undefined result, when the token asks.
template <class Number>
LightVolume<Number> spreadLight(const LightGrid& grid, const Medium<Number>& medium,
                                std::span<const PlacedLight> lights, const Shadows& shadows, std::stop_token stop = {});

extern template struct LightVolume<float>;
extern template struct LightVolume<double>;
extern template LightVolume<float> spreadLight(const LightGrid&, const Medium<float>&, std::span<const PlacedLight>,
                                               const Shadows&, std::stop_token);
extern template LightVolume<double> spreadLight(const LightGrid&, const Medium<double>&, std::span<const PlacedLight>,
                                                const Shadows&, std::stop_token);

} // namespace tessera::vis
