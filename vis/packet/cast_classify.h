#pragma once

#include "vis/optics/preintegration.h"
#include "vis/packet/cast_look.h"

/// Classification of packets of samples before and over interpolation. Only for cast_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

/// Linear, not premultiplied colours and opacities of samples, and the present fractions of their segments.
struct Classified {
    Vec color;
    Floats opacity, share;
};
inline Classified classified(const glm::vec<4, Floats>& of, Floats share) {
    return {{of.x, of.y, of.z}, of.w, share};
}

/// One end of a ray segment: the place of an IntegralView next to it, and the integrals up to there.
struct SegmentEnd {
    Ints place;
    IntQuad sums;
};
/// Lanes that are not asked for may be anything.
[[gnu::always_inline]] inline SegmentEnd segmentEnd(const LayerView& layer, Ints place, Mask lanes) {
    return {place, loadQuads<16>(layer.integrals.sums, spread(place, lanes), lanes)};
}
/// Of samples.
[[gnu::always_inline]] inline SegmentEnd segmentEnd(const LayerView& layer, Floats value, Mask lanes) {
    constexpr float kLast = kSegmentPlaces - 1;
    const Floats place = multiplyAdd(value, Floats(layer.placeScale * kLast), Floats(layer.placeOffset * kLast + 0.5f));
    return segmentEnd(layer, toInts(clamped(place, Floats(0), Floats(kLast))), lanes);
}
inline SegmentEnd choose(Mask which, const SegmentEnd& a, const SegmentEnd& b) {
    SegmentEnd out{choose(which, a.place, b.place), {}};
    for (int i = 0; i < 4; ++i) out.sums.each[i] = choose(which, a.sums.each[i], b.sums.each[i]);
    return out;
}

/// The mean medium from one place to another; nothing where they are the same.
[[gnu::always_inline]] inline Medium mediumOver(const LayerView& layer, const SegmentEnd& front, const SegmentEnd& back,
                                                Mask lanes) {
    const Floats length = toFloats(back.place - front.place);
    const auto over = [&](int i) { return toFloats(back.sums.each[i] - front.sums.each[i]); };
    const Floats all = over(3), product = length * all, none(0);
    const Floats share = choose(lanes & (product > none), Floats(1) / product, none);
    const Floats perAll = length * share * Floats(float(kQuantum)), perLength = all * share;
    return {{over(0) * perAll, over(1) * perAll, over(2) * perAll},
            all * perLength * Floats(layer.integrals.extinction)};
}
[[gnu::noinline]] inline Medium mediumAround(const LayerView& layer, Ints place, Mask lanes) {
    return mediumOver(layer, segmentEnd(layer, place - Ints(1), lanes), segmentEnd(layer, place + Ints(1), lanes),
                      lanes);
}
/// The mean medium of segments.
[[gnu::always_inline]] inline Medium mediumBetween(const LayerView& layer, const SegmentEnd& front,
                                                   const SegmentEnd& back, Mask lanes) {
    Medium out = mediumOver(layer, front, back, lanes);
    const Mask same = lanes & (back.place == front.place);
    if (!anyOf(same)) return out;
    const Medium own = mediumAround(layer, back.place, same);
    for (int c = 0; c < 3; ++c) out.color[c] = choose(same, own.color[c], out.color[c]);
    out.extinction = choose(same, own.extinction, out.extinction);
    return out;
}

/// Of segments that begin and end with these values of one part each.
inline Classified preintegrated(const LayerView& layer, const Found& front, const SegmentEnd& first, const Found& back,
                                const SegmentEnd& last, Mask samePart, Mask lanes) {
    const auto of = [&](const SegmentEnd& a, const SegmentEnd& b) {
        const Medium mean = mediumBetween(layer, a, b, lanes);
        const Vec color = mean.color * Floats(1.0f / kQuantum);
        return glm::vec<4, Floats>(color.x, color.y, color.z, Floats(1) - powerOfTwo(-mean.extinction));
    };
    const Mask both = front.present & back.present;
    if (!anyOf(lanes & !(both & samePart))) return classified(of(first, last), Floats(1));
    const SegmentEnd a = choose(front.present, first, last), b = choose(back.present, last, first);
    glm::vec<4, Floats> color = of(a, b);
    const Mask apart = both & !samePart;
    if (anyOf(apart)) {
        const glm::vec<4, Floats> halves = inHalves(of(a, a), of(b, b));
        for (int c = 0; c < 4; ++c) color[c] = choose(apart, halves[c], color[c]);
    }
    const Floats share = choose(both, Floats(1), choose(front.present | back.present, Floats(0.5), Floats(0)));
    return classified(color, share);
}

/// Of the samples around positions; `read` of the layer's volume.
template <class Read>
[[gnu::noinline]] Classified preclassified(const LayerView& layer, const Read& read, const Vec& cells, Mask lanes) {
    const glm::vec<4, Floats> none(Floats(0), Floats(0), Floats(0), Floats(0));
    const auto premultiplied = [&](Floats value, Mask of) {
        const Floats place = multiplyAdd(value, Floats(layer.placeScale), Floats(layer.placeOffset));
        const Mask some = of & mayShow(layer, place);
        if (!anyOf(some)) return none;
        const TablePlace at = tablePlace(place);
        const Floats opacity = opacityAt(layer, at, some);
        const Vec color = colorAt(layer.table, at, some) * opacity;
        return glm::vec<4, Floats>(color.x, color.y, color.z, opacity);
    };
    const auto found = read.meanOf(cells, lanes, premultiplied);
    const Floats whole = Floats(1) / larger(found.mean.w, Floats(1e-12));
    return {Vec(found.mean.x, found.mean.y, found.mean.z) * whole, found.mean.w,
            choose(found.present, Floats(1), Floats(0))};
}

} // namespace tessera::vis::packet::TESSERA_LANES
