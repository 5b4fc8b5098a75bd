#pragma once

#include "vis/packet/cast_focus.h"
#include "vis/packet/cast_gradient.h"

/// Looks of packets of samples, by the formulas of vis/optics/look_shading.h. Only for cast_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

/// Overload of patternOf() in vis/optics/grain.h.
inline Floats patternOf(const GrainTile& tile, int pattern, Floats x, Floats y) {
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float) && kGrainEdge == 1 << 9);
    const Ints wrap(kGrainEdge - 1), texel = (toInts(x) & wrap) + ((toInts(y) & wrap) << 9);
    return gatherFloats(&tile.texels[0].x + pattern, texel + texel + texel, maskOf((1u << kLanes) - 1));
}

/// A sample that a look draws.
struct Looked {
    const LayerView& layer;
    Vec cells, world, direction; ///< direction: of the rays
    Floats distance, doi;        ///< along the ray; degree of interest
    Vec narrow;                  ///< gradient in world axes
    Floats steepness, weight;    ///< change over a cell; of the surface
};

/// Moved into the box.
inline Vec withinBox(const CastJob& job, const Vec& cells) {
    Vec out;
    for (int axis = 0; axis < 3; ++axis) {
        const double half = job.halfSize[axis] * __builtin_fabs(job.cellsPerWorld[axis]),
                     middle = job.cellsOffset[axis];
        out[axis] = clamped(cells[axis], Floats(middle - half), Floats(middle + half));
    }
    return out;
}

/// The gradient in world axes that a look is shaded by; `value` gives what is at a position in cells.
template <class Value> Vec lookGradient(const CastJob& job, const Looked& at, const Value& value) {
    if (!(at.layer.smooth > 0)) return at.narrow;
    const Vec edges = spreadOut<Floats>(job.edges);
    return volume::smoothGradientOf<Floats>(value, at.cells, double(at.layer.smooth), at.narrow * edges) / edges;
}

/// Curvature of surfaces in the direction of the viewer, and for strokes that follow it that in all directions. Twin:
/// lookSample() in vis/reference/raycast.cpp.
template <class Value>
void addCurvature(const CastJob& job, const Looked& at, const Value& value, const Vec& gradient, Mask surface,
                  LookSampleOf<Floats>& sample, SurfaceBendOf<Floats>& bend) {
    const Look& look = *at.layer.look;
    const bool follows = look.charcoal && look.charcoal->mark == Mark::Strokes && look.charcoal->follow > 0;
    if (!follows && !look.charcoal && !look.cartoon) return;
    const Vec& normal = sample.at.normal;
    const Vec tangent = sample.at.toViewer - normal * inner(sample.at.toViewer, normal);
    const Vec across = tangent * (Floats(1) / larger(lengthOf(tangent), Floats(1e-6)));
    const double reach = bendReach(look, job.look);
    const Floats perReach = Floats(1 / reach) / choose(surface, lengthOf(gradient), Floats(1));
    const Found centre = value(at.cells);
    const Vec perWorld = spreadOut<Floats>(job.cellsPerWorld);
    const auto beside = [&](const Vec& offset) { return value(at.cells + offset * perWorld); };
    Floats turned(0);
    if (follows) {
        bend = surfaceBend<Floats>(beside, centre, normal, reach) * choose(surface, perReach, Floats(0));
        turned = bendAlong(bend, normal, across);
    } else {
        turned = secondDifference<Floats>(beside, centre, across * Floats(reach)) * perReach;
    }
    sample.curvature = choose(surface, magnitude(turned) * Floats(1 / reach), Floats(0));
}

/// Inputs of the look of samples with a gradient in world axes.
template <class Value>
LookSampleOf<Floats> lookSample(const CastJob& job, const Looked& at, const Value& value, const Vec& gradient) {
    const Look& look = *at.layer.look;
    const LookView& view = job.look;
    LookSampleOf<Floats> sample;
    sample.share = lookShare(look.part, at.doi);
    sample.steepness = at.steepness * Floats(at.layer.gradientScale);
    const Floats along = at.distance * inner(at.direction, spreadOut<Floats>(job.middle));
    sample.depth =
        clamped((along - Floats(view.nearest)) * Floats(1 / (view.farthest - view.nearest)), Floats(0), Floats(1));
    sample.pixel = multiplyAdd(Floats(view.pixel.y), at.distance, Floats(view.pixel.x));
    Vec way = spreadOut<Floats>(view.light.place);
    if (view.light.point) way = way - at.world;
    sample.toLight = way * (Floats(1) / larger(lengthOf(way), Floats(1e-6)));
    const Mask surface = inner(gradient, gradient) > Floats(0);
    const Vec none(Floats(0), Floats(0), Floats(0));
    sample.at = facing<Floats>(choose(surface, gradient, {Floats(0), Floats(0), Floats(1)}), -at.direction);
    sample.at.normal = choose(surface, sample.at.normal, none);
    sample.at.front = choose(surface, sample.at.front, Floats(1));
    sample.weight = choose(surface, at.weight, Floats(0));
    SurfaceBendOf<Floats> bend = none;
    addCurvature(job, at, value, gradient, surface, sample, bend);
    if (look.wire)
        sample.wire = sample.weight * wireCoverage(at.world, sample.at.normal, sample.at.toViewer,
                                                   double(look.wire->spacing), double(look.wire->width), sample.pixel);
    if (look.charcoal) sample.grain = marksAt(*look.charcoal, at.world, sample.at.normal, bend, sample.pixel);
    return sample;
}

} // namespace tessera::vis::packet::TESSERA_LANES
