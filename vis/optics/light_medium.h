#pragma once

#include "vis/optics/light_volume.h"
#include "vis/transfer/transfer_function.h"
#include "volume/base/vectors.h"

#include <numbers>

/// Extinction of a cell of a light grid, by the formulas of vis/optics/light_volume.h. Templates over the number
/// (volume/base/numbers.h). Twin: vis/shaders/light_medium.frag.glsl.
namespace tessera::vis {

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

} // namespace tessera::vis
