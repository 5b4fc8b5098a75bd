#pragma once

#include "vis/optics/look_shading.h"

/// Inputs of a look at a place, templates over the number (volume/base/numbers.h); twin:
/// vis/shaders/lib/shading/look_sample.glsl.
namespace tessera::vis {

/// Where a look draws.
template <class N> struct LookPlaceOf {
    glm::vec<3, N> world, toViewer; ///< toViewer: a unit vector
    N along{0}, distance{0};        ///< from the camera: along the direction of view, and along the ray
    N share{1}, steepness{0};       ///< as in LookSampleOf
    glm::vec<3, N> gradient;        ///< in world axes, or the normal of a mesh; 0: there is no surface
    N weight{0};                    ///< of the surface, if there is one
    bool cut = false;               ///< whether the surface ends where the box cuts it (a volume does not)
};

/// All but curvature and grain.
template <class N> LookSampleOf<N> lookSampleAt(const Look& look, const LookView& view, const LookPlaceOf<N>& place) {
    const glm::vec<3, N>& gradient = place.gradient;
    const glm::vec<3, N> none(N(0), N(0), N(0));
    LookSampleOf<N> sample;
    sample.share = place.share;
    sample.steepness = place.steepness;
    sample.depth = clamped((place.along - N(view.nearest)) * N(1 / (view.farthest - view.nearest)), N(0), N(1));
    sample.pixel = N(view.pixel.x) + N(view.pixel.y) * place.distance;
    glm::vec<3, N> way = spreadOut<N>(view.light.place);
    if (view.light.point) way = way - place.world;
    sample.toLight = way * (N(1) / larger(lengthOf(way), N(1e-6)));
    const auto surface = inner(gradient, gradient) > N(0);
    sample.at = facing<N>(choose(surface, gradient, {N(0), N(0), N(1)}), place.toViewer);
    sample.at.normal = choose(surface, sample.at.normal, none);
    sample.at.front = choose(surface, sample.at.front, N(1));
    sample.weight = choose(surface, place.weight, N(0));
    if (look.wire)
        sample.wire = sample.weight * wireCoverage(place.world, sample.at.normal, sample.at.toViewer,
                                                   double(look.wire->spacing), double(look.wire->width), sample.pixel);
    if (place.cut && (look.charcoal || look.cartoon))
        sample.cut = cutDistance<N>(place.world, sample.at.normal, sample.at.toViewer, view.halfSize, sample.pixel);
    return sample;
}

/// At a sample of a volume. `beside(offset) -> FoundValue`: of the part it belongs to, at an offset in world units.
template <class N, class Beside>
LookSampleOf<N> lookSampleAt(const Look& look, const LookView& view, const LookPlaceOf<N>& place,
                             const Beside& beside) {
    LookSampleOf<N> sample = lookSampleAt<N>(look, view, place);
    SurfaceBendOf<N> bend(N(0), N(0), N(0));
    if (look.charcoal || look.cartoon) { // they draw outlines, and strokes that follow the surface
        const glm::vec<3, N>& normal = sample.at.normal;
        const glm::vec<3, N> tangent = place.toViewer - normal * inner(place.toViewer, normal);
        const glm::vec<3, N> across = tangent * (N(1) / larger(lengthOf(tangent), N(1e-6)));
        const double reach = bendReach(look, view);
        const auto surface = inner(place.gradient, place.gradient) > N(0);
        const N perReach = choose(surface, N(1 / reach) / choose(surface, lengthOf(place.gradient), N(1)), N(0));
        const auto centre = beside(glm::vec<3, N>(N(0), N(0), N(0)));
        N turned(0);
        if (look.charcoal && look.charcoal->mark == Mark::Strokes && look.charcoal->follow > 0) {
            bend = surfaceBend<N>(beside, centre, normal, reach) * perReach;
            turned = bendAlong(bend, normal, across);
        } else {
            turned = secondDifference<N>(beside, centre, across * N(reach)) * perReach;
        }
        sample.curvature = magnitude(turned) * N(1 / reach);
    }
    if (look.charcoal) sample.grain = marksAt(*look.charcoal, place.world, sample.at.normal, bend, sample.pixel);
    return sample;
}

} // namespace tessera::vis
