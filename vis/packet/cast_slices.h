#pragma once

#include "vis/optics/contour.h"
#include "vis/packet/cast_layers.h"

/// Slices that packets of rays meet. Only for cast_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

/// How much a quantity differs between the two pixels of a pair, the sum over both axes of the picture; where the other
/// one has no value by nothing. Packets begin at even pixels of their tile, as the pairs of graphics cards do.
inline Floats changeBetweenPixels(Floats of, Mask present) {
    float own[kLanes], out[kLanes];
    of.store(own);
    const unsigned there = bitsOf(present);
    for (int i = 0; i < kLanes; ++i) {
        out[i] = 0;
        for (const int other : {i ^ 1, i ^ kColumns})
            if (there >> other & 1) out[i] += __builtin_fabsf(own[other] - own[i]);
    }
    return Floats::load(out);
}

/// Finds them all. Rays end behind slices that are opaque, alone or together, one sample after them.
template <bool Bcc, bool Exact> void findSlices(Caster<Bcc, Exact>& caster) {
    constexpr double kFaceTolerance = 1e-5; // in world units, for a slice on a face of the box
    const CastJob& job = caster.job;
    Packet& packet = caster.packet;
    const RayOf<Floats>& ray = packet.ray;
    const Vec half = spreadOut<Floats>(job.halfSize), scale = spreadOut<Floats>(job.cellsPerWorld);
    const Mask all = maskOf((1u << kLanes) - 1);
    const Floats face = Floats(kFaceTolerance) / larger(packet.step, Floats(1e-20));
    for (const SliceView& slice : job.slices) {
        const Floats t = planeDistance(slice.plane, ray.origin, ray.direction);
        const Floats at = (t - packet.enter) / larger(packet.step, Floats(1e-20)) - packet.phase;
        Vec cells;
        for (int axis = 0; axis < 3; ++axis) {
            const Floats world =
                clamped(multiplyAdd(t, ray.direction[axis], ray.origin[axis]), -half[axis], half[axis]);
            cells[axis] = multiplyAdd(world, scale[axis], Floats(job.cellsOffset[axis]));
        }
        const LayerView& look = slice.look;
        const Found found = Caster<Bcc, Exact>::reader(look, true)(cells, all);
        caster.count(packet.meets);
        const Mask within =
            (at > -packet.phase - face) & (at <= packet.count - packet.phase + face) &
            (magnitude(inner(spreadOut<Floats>(slice.plane.normal), ray.direction)) > Floats(kParallel));
        const Mask seen = packet.meets & within & found.present & packet.shows(at);
        if (!anyOf(seen)) continue;
        const Floats place = multiplyAdd(found.value, Floats(look.placeScale), Floats(look.placeOffset));
        Vec color = colorAt(look, tablePlace(place), seen);
        if (slice.contours > 0) {
            const Floats level = place * Floats(slice.contours + 1);
            color = withContours(color, level, changeBetweenPixels(level, found.present), slice.contours);
        }
        Floats opacity(slice.opacity);
        if (job.focus.any) {
            const Focus focus = caster.focusOf(look, cells, at, true, seen);
            color = focused(job.focus, look, color, focus);
            opacity = smaller(Floats(1), opacity * focus.opacity);
        }
        packet.slices[packet.sliceCount++] = {choose(seen, at, Floats(kFar)), color, choose(seen, opacity, Floats(0))};
    }
    sortByDistance(packet.slices, packet.sliceCount);
    Floats through(1);
    for (int i = 0; i < packet.sliceCount; ++i) {
        through *= Floats(1) - packet.slices[i].opacity;
        const Mask ends = through <= Floats(1 - kOpaque);
        const Floats count = larger(Floats(0), roundUp(packet.slices[i].at) + Floats(1));
        packet.count = choose(ends, smaller(packet.count, count), packet.count);
    }
}

} // namespace tessera::vis::packet::TESSERA_LANES
