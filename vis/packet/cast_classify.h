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

/// An IntegralView as preintegrated() wants it.
struct Nodes {
    const IntegralView& functions;
    double last() const { return functions.last; }
    glm::vec<4, Floats> density(Floats node) const { return four(functions.density, toInts(node) << 2); }
    struct Sum {
        glm::vec<4, Floats> whole, rest; ///< two floats for each number
    };
    Sum sum(Floats node) const {
        const Ints at = toInts(node) << 3;
        return {four(functions.integral, at), four(functions.integral + 4, at)};
    }
    static glm::vec<4, Floats> apart(const Sum& a, const Sum& b) { return (b.whole - a.whole) + (b.rest - a.rest); }

private:
    static glm::vec<4, Floats> four(const float* from, Ints at) {
        const Mask all = maskOf((1u << kLanes) - 1);
        return {gatherFloats(from, at, all), gatherFloats(from + 1, at, all), gatherFloats(from + 2, at, all),
                gatherFloats(from + 3, at, all)};
    }
};
inline constexpr double kSamePlace = 1e-5; ///< places closer than this count as equal

/// Of segments that begin and end with these values of one part each.
[[gnu::noinline]] inline Classified preintegrated(const LayerView& layer, const Found& front, const Found& back,
                                                  Mask samePart) {
    const auto place = [&](const Found& of) {
        return multiplyAdd(of.value, Floats(layer.placeScale), Floats(layer.placeOffset));
    };
    const Nodes nodes{layer.integrals};
    const auto of = [&](Floats a, Floats b) {
        return vis::preintegrated(nodes, segmentEnd(nodes, a), segmentEnd(nodes, b), kSamePlace);
    };
    const Floats first = place(front), last = place(back);
    const Floats a = choose(front.present, first, last), b = choose(back.present, last, first);
    glm::vec<4, Floats> color = of(a, b);
    const Mask both = front.present & back.present, apart = both & !samePart;
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
