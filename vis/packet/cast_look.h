#pragma once

#include "vis/optics/look_sample.h"
#include "vis/packet/cast_focus.h"
#include "vis/packet/cast_gradient.h"

/// Looks of packets of samples, by the formulas of vis/optics/look_sample.h and look_shading.h. Only for cast_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

/// Overload of patternOf() in vis/optics/grain.h.
inline Floats patternOf(const GrainTile& tile, int pattern, Floats x, Floats y) {
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float) && kGrainEdge == 1 << 9);
    const Ints wrap(kGrainEdge - 1), texel = (toInts(x) & wrap) + ((toInts(y) & wrap) << 9);
    return gatherFloats(&tile.texels[0].x + pattern, texel + texel + texel, maskOf((1u << kLanes) - 1));
}

/// A sample that a look draws.
struct LookInput {
    const LayerView& layer;
    Vec cells, world, direction; ///< direction: of the rays
    Floats distance, doi;        ///< along the ray; degree of interest
    Vec narrow;                  ///< gradient in world axes
    Floats steepness, weight;    ///< change over a cell; of the surface
    bool surface = false;        ///< an iso-surface
};

/// Moved into the box.
inline Vec withinBox(const CastJob& job, const Vec& cells) {
    Vec out;
    for (int axis = 0; axis < 3; ++axis) {
        const double half = job.box.halfSize[axis] * __builtin_fabs(job.box.cellsPerWorld[axis]),
                     middle = job.box.cellsOffset[axis];
        out[axis] = clamped(cells[axis], Floats(middle - half), Floats(middle + half));
    }
    return out;
}

/// The gradient in world axes that a look is shaded by; `value` gives what is at a position in cells.
template <class Value> Vec lookGradient(const CastJob& job, const LookInput& at, const Value& value) {
    if (!(at.layer.smooth > 0)) return at.narrow;
    const Vec edges = spreadOut<Floats>(job.box.edges);
    return volume::smoothGradientOf<Floats>(value, at.cells, double(at.layer.smooth), at.narrow * edges) / edges;
}

/// Inputs of the look of samples with a gradient in world axes.
template <class Value>
LookSampleOf<Floats> lookSample(const CastJob& job, const LookInput& at, const Value& value, const Vec& gradient) {
    const Look& look = *at.layer.look;
    const Vec perWorld = spreadOut<Floats>(job.box.cellsPerWorld);
    const LookPlaceOf<Floats> place{.world = at.world,
                                    .toViewer = -at.direction,
                                    .along = at.distance * inner(at.direction, spreadOut<Floats>(job.middle)),
                                    .distance = at.distance,
                                    .share = lookShare(look.part, at.doi),
                                    .steepness = at.steepness * Floats(at.layer.gradientScale),
                                    .gradient = gradient,
                                    .weight = at.weight,
                                    .cut = at.surface};
    return lookSampleAt<Floats>(look, job.look, place,
                                [&](const Vec& offset) { return value(at.cells + offset * perWorld); });
}

} // namespace tessera::vis::packet::TESSERA_LANES
