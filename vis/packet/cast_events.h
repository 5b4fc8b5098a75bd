#pragma once

#include "vis/formulas/colors.h"
#include "vis/packet/cast_layers.h"

/// Slices and rasterised surfaces that packets of rays meet. Only for cast_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

/// How much a quantity differs between the two pixels of a pair, the sum over both axes of the picture; where the other
/// one has no value, or one of another part, by nothing. Packets begin at even pixels of their tile, as the pairs of
/// graphics cards do.
inline Floats changeBetweenPixels(Floats of, Floats part, Mask present) {
    float own[kLanes], parts[kLanes], out[kLanes];
    of.store(own);
    part.store(parts);
    const unsigned there = bitsOf(present);
    for (int i = 0; i < kLanes; ++i) {
        out[i] = 0;
        for (const int other : {i ^ 1, i ^ kColumns})
            if ((there >> other & 1) && int(parts[other]) == int(parts[i]))
                out[i] += __builtin_fabsf(own[other] - own[i]);
    }
    return Floats::load(out);
}

/// Position in samples of a distance along the rays.
inline Floats sampleAt(const Packet& packet, Floats t) {
    return (t - packet.enter) / larger(packet.step, Floats(1e-20)) - packet.phase;
}

/// Position in cells of points, moved into the box.
inline Vec cellsInBox(const CastJob& job, const Vec& world) {
    Vec cells;
    for (int axis = 0; axis < 3; ++axis) {
        const Floats half(job.box.halfSize[axis]), within = clamped(world[axis], -half, half);
        cells[axis] = multiplyAdd(within, Floats(job.box.cellsPerWorld[axis]), Floats(job.box.cellsOffset[axis]));
    }
    return cells;
}

/// Strokes of a slice at places of the world: lightness times coverage, and coverage; twin: sliceStrokes in
/// vis/scene/strokes.h.
inline glm::vec<2, Floats> sliceStrokes(const StrokesView& strokes, const Vec& world, Mask seen) {
    const auto along = [&](const glm::vec4& map) {
        return world.x * Floats(map.x) + world.y * Floats(map.y) + world.z * Floats(map.z) + Floats(map.w - 0.5f);
    };
    const Floats x = along(strokes.across), y = along(strokes.up), left = roundDown(x), low = roundDown(y);
    const auto within = [](Floats at, int size) { return toInts(clamped(at, Floats(0), Floats(size - 1))); };
    const Ints columns[2] = {within(left, strokes.size.x), within(left + Floats(1), strokes.size.x)};
    const Ints rows[2] = {within(low, strokes.size.y), within(low + Floats(1), strokes.size.y)};
    glm::vec<2, Floats> out;
    for (int part = 0; part < 2; ++part) {
        const auto read = [&](int i, int j) {
            return gatherFloats(strokes.texels + part, (rows[j] * Ints(strokes.size.x) + columns[i]) << 1, seen);
        };
        out[part] = mix(mix(read(0, 0), read(1, 0), x - left), mix(read(0, 1), read(1, 1), x - left), y - low);
    }
    return out;
}

template <bool Bcc, bool Exact> void addSlices(Caster<Bcc, Exact>& caster) {
    constexpr double kFaceTolerance = 1e-5; // in world units, for a slice on a face of the box
    const CastJob& job = caster.job;
    Packet& packet = caster.packet;
    const RayOf<Floats>& ray = packet.ray;
    const Mask all = maskOf((1u << kLanes) - 1);
    const Floats face = Floats(kFaceTolerance) / larger(packet.step, Floats(1e-20));
    for (const SliceView& slice : job.slices) {
        const Floats t = planeDistance(slice.plane, ray.origin, ray.direction);
        const Floats at = sampleAt(packet, t);
        const Vec cells = cellsInBox(job, ray.origin + ray.direction * t);
        const LayerView& look = slice.look;
        const Found found = caster.reader(look, true)(cells, all);
        caster.count(packet.meets);
        const Mask within =
            (at > -packet.phase - face) & (at <= packet.count - packet.phase + face) &
            (magnitude(inner(spreadOut<Floats>(slice.plane.normal), ray.direction)) > Floats(kParallel));
        Mask seen = packet.meets & within & found.present & packet.shows(at);
        if (!anyOf(seen)) continue;
        const Floats place = multiplyAdd(found.value, Floats(look.placeScale), Floats(look.placeOffset));
        Vec color = colorAt(look.table, tablePlace(place), seen);
        if (slice.strokes.texels) {
            const glm::vec<2, Floats> strokes = sliceStrokes(slice.strokes, ray.origin + ray.direction * t, seen);
            if (slice.strokes.grey) {
                color = Vec(Floats(kStrokeGrey), Floats(kStrokeGrey), Floats(kStrokeGrey));
                seen = seen & (strokes.y >= Floats(0.5f));
            }
            color = withStrokes(color, strokes.x, Floats(slice.strokes.strength));
        }
        if (slice.contours > 0) {
            const Floats level = multiplyAdd(found.value, Floats(slice.levelScale), Floats(slice.levelOffset)) *
                                 Floats(slice.contours + 1);
            const Floats width = changeBetweenPixels(level, caster.reader(look, true).part(cells, all), found.present);
            color = withContours(color, level, width, slice.contours);
        }
        Floats opacity(slice.opacity);
        if (job.focus.any) {
            const Focus focus = caster.focusOf(look, cells, at, true, seen);
            color = focused(job.focus, look, color, focus);
            opacity = smaller(Floats(1), opacity * focus.opacity);
        }
        packet.events[packet.eventCount++] = {choose(seen, at, Floats(kFar)), color, choose(seen, opacity, Floats(0))};
    }
}

/// The rasterised surfaces of the pixels from `begin` on, those below `end`. Brushes act here, after light, because the
/// rasteriser does not know them.
template <bool Bcc, bool Exact> void addGeometry(Caster<Bcc, Exact>& caster, glm::ivec2 begin, glm::ivec2 end) {
    const CastJob& job = caster.job;
    Packet& packet = caster.packet;
    for (int peel = 0; peel < job.peels; ++peel) {
        float t[kLanes], effect[kLanes], color[4][kLanes];
        for (int i = 0; i < kLanes; ++i) {
            const glm::ivec2 pixel(begin.x + i % kColumns, begin.y + i / kColumns);
            const bool within = pixel.x < end.x && pixel.y < end.y;
            const std::size_t from = within ? std::size_t(peel) * job.pixels + placeOf(job, pixel) : 0;
            t[i] = within ? job.peelDistance[from * 2] : kFar;
            effect[i] = within ? job.peelDistance[from * 2 + 1] : 0;
            for (int c = 0; c < 4; ++c) color[c][i] = within ? job.peelColor[from * 4 + std::size_t(c)] : 0;
        }
        const Floats distance = Floats::load(t);
        Floats opacity = Floats::load(color[3]);
        const Mask seen = packet.meets & (distance < Floats(0.1f * kFar)) & (opacity > Floats(0));
        if (!anyOf(seen)) continue;
        const Floats whole = Floats(1) / larger(opacity, Floats(1e-6));
        Vec own(Floats::load(color[0]) * whole, Floats::load(color[1]) * whole, Floats::load(color[2]) * whole);
        const Floats at = choose(seen, sampleAt(packet, distance), Floats(kFar));
        if (!job.focus.brushes.empty()) {
            const Vec world = packet.ray.origin + packet.ray.direction * choose(seen, distance, Floats(0));
            const Interest interest = caster.interestAt(cellsInBox(job, world), world, seen);
            const Floats effects = Floats::load(effect) + Floats(0.5);
            for (int kind = 0; kind < int(std::size(kBrushEffectNames)); ++kind) {
                const Mask which = seen & (effects >= Floats(kind)) & (effects < Floats(kind + 1));
                if (!anyOf(which)) continue;
                LayerView layer;
                layer.brushes = BrushEffect(kind);
                Focus focus; // the rasteriser knows the lenses
                focus.interest = interest;
                focus.opacity = brushedOpacity(layer.brushes, Floats(job.focus.contextOpacity), interest.doi);
                own = choose(which, focused(job.focus, layer, own, focus), own);
                opacity = choose(which, opacity * focus.opacity, opacity);
            }
        }
        packet.events[packet.eventCount++] = {at, own, choose(seen, opacity, Floats(0))};
    }
}

/// Finds all events of a packet. Rays end behind those that are opaque together, one sample after them.
template <bool Bcc, bool Exact> void findEvents(Caster<Bcc, Exact>& caster, glm::ivec2 begin, glm::ivec2 end) {
    Packet& packet = caster.packet;
    addSlices(caster);
    addGeometry(caster, begin, end);
    sortByDistance(packet.events, packet.eventCount);
    Floats through(1);
    for (int i = 0; i < packet.eventCount; ++i) {
        through *= Floats(1) - packet.events[i].opacity;
        const Mask ends = through <= Floats(1 - kOpaque);
        const Floats count = larger(Floats(0), roundUp(packet.events[i].at) + Floats(1));
        packet.count = choose(ends, smaller(packet.count, count), packet.count);
    }
}

} // namespace tessera::vis::packet::TESSERA_LANES
