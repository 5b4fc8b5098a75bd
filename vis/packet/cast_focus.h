#pragma once

#include "vis/packet/cast_light.h"
#include "vis/packet/cast_skip.h"

/// Brushes and lenses at packets of samples: focus and context. Only for cast_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

/// Degree of interest of samples; colour (linear) of the brush that holds them most, and how much that is.
struct Interest {
    Floats doi{1};
    Vec color{Floats(0), Floats(0), Floats(0)};
    Floats held{0};
};

/// What brushes and lenses do to the samples of a layer.
struct Focus {
    Interest interest;
    Floats opacity{1}, saturation{1}; ///< factors
};

/// Twin: LassoTable::at in vis/scene/selection.h; u and v are -1 .. 1 in the table.
inline Floats lassoDoi(const float* table, Floats u, Floats v, Mask lanes) {
    constexpr float kLast = kLassoTable - 1;
    const Floats x = (u + Floats(1)) * Floats(0.5f * kLast), y = (v + Floats(1)) * Floats(0.5f * kLast);
    const Mask inside = lanes & (x >= Floats(0)) & (y >= Floats(0)) & (x <= Floats(kLast)) & (y <= Floats(kLast));
    const Ints i = toInts(clamped(x, Floats(0), Floats(kLast - 1))),
               j = toInts(clamped(y, Floats(0), Floats(kLast - 1)));
    const Floats fx = x - toFloats(i), fy = y - toFloats(j);
    const auto row = [&](int more) {
        const Ints at = i + (j << 7);
        return mix(gatherFloats(table + more, at, inside), gatherFloats(table + more + 1, at, inside), fx);
    };
    static_assert(kLassoTable == 1 << 7);
    return choose(inside, mix(row(0), row(kLassoTable), fy), Floats(0));
}

/// Where the values that a test asks for are present.
inline Mask canPass(const BrushView& test, const Found* values) {
    const bool asks =
        test.kind == BrushTestKind::Range || test.kind == BrushTestKind::Ellipse || test.kind == BrushTestKind::Lasso;
    if (!asks) return Floats(0) <= Floats(0);
    if (test.x < 0 || test.y < 0) return Floats(0) > Floats(0);
    return values[test.x].present & values[test.y].present;
}

/// How far samples with these values of the brushed channels pass one test, 0..1.
inline Floats passBrush(const FocusView& focus, const BrushView& test, const Found* values, const Vec& cells,
                        const Vec& world, Mask lanes) {
    const auto radial = [&](Floats radii) { return softEdge(larger(radii - Floats(1), Floats(0)), test.soft); };
    switch (test.kind) {
    case BrushTestKind::Always:
        return Floats(1);
    case BrushTestKind::Sphere:
    case BrushTestKind::Box: {
        const Vec from = (cells - spreadOut<Floats>(test.center)) * spreadOut<Floats>(test.inverseRadius);
        if (test.kind == BrushTestKind::Sphere) return radial(lengthOf(from));
        return radial(larger(larger(magnitude(from.x), magnitude(from.y)), magnitude(from.z)));
    }
    case BrushTestKind::Lens: {
        Floats most(0);
        for (std::size_t i = 0; i < focus.lenses.size(); ++i)
            if (test.x >> i & 1) most = larger(most, focus.lenses[i].weight(world));
        return most;
    }
    case BrushTestKind::Range:
    case BrushTestKind::Ellipse:
    case BrushTestKind::Lasso:
        break;
    }
    if (test.x < 0 || test.y < 0) return Floats(0);
    const Found &a = values[test.x], &b = values[test.y];
    const Mask both = a.present & b.present;
    Floats own(0);
    if (test.kind == BrushTestKind::Range) {
        const Floats below = Floats(test.place.x) - a.value, above = a.value - Floats(test.place.y);
        own = softEdge(larger(larger(below, above), Floats(0)), test.soft);
    } else {
        const Floats u = (a.value - Floats(test.place.x)) * Floats(test.place.z),
                     v = (b.value - Floats(test.place.y)) * Floats(test.place.w);
        if (test.kind == BrushTestKind::Lasso) return lassoDoi(test.lasso, u, v, both & lanes);
        own = radial(squareRoot(larger(ellipseSquare(u, v, test.correlation), Floats(0))));
    }
    return choose(both, own, Floats(0));
}

/// Twin: DoiFunction in vis/scene/selection.h.
inline Interest interestOf(const FocusView& focus, const Found* values, const Vec& cells, const Vec& world,
                           Mask lanes) {
    Interest out;
    if (focus.brushes.empty()) return out;
    Floats doi(focus.start), own(1), there(1);
    for (const BrushView& test : focus.brushes) {
        if (test.flags & BrushTest::First) own = there = Floats(1);
        there = choose(canPass(test, values), there, Floats(0));
        own = smaller(own, passBrush(focus, test, values, cells, world, lanes));
        if (!(test.flags & BrushTest::Last)) continue;
        if (focus.brushColor > 0 && test.holds) {
            const Mask more = own > out.held;
            out.held = choose(more, own, out.held);
            out.color = choose(more, spreadOut<Floats>(test.color), out.color);
        }
        if (test.flags & BrushTest::Inverted) own = Floats(1) - own;
        if (test.flags & BrushTest::Present) own = smaller(own, there);
        doi = test.flags & BrushTest::Or ? larger(doi, own) : smaller(doi, own);
    }
    out.doi = confine<Floats>(focus.lenses, doi, world);
    return out;
}

/// What brushes and lenses do to samples at `cells`; `read(field)` gives the values of a brushed channel.
template <class Read>
Focus focusAt(const FocusView& focus, const LayerView& layer, const Vec& cells, const Vec& world, Mask lanes,
              const Read& read) {
    Found values[kMostBrushFields];
    for (std::size_t i = 0; i < focus.fields.size(); ++i) values[i] = read(*focus.fields[i]);
    Focus out;
    out.interest = interestOf(focus, values, cells, world, lanes);
    const LensActionOf<Floats> lens = lensAction<Floats>(focus.lenses, layer.lens, world, out.interest.doi);
    out.opacity = lens.opacity * brushedOpacity(layer.brushes, Floats(focus.contextOpacity), out.interest.doi);
    out.saturation = lens.saturation;
    return out;
}

/// A layer's colour after brushes and lenses.
inline Vec focused(const FocusView& focus, const LayerView& layer, const Vec& color, const Focus& of) {
    const Vec out =
        focusedColor<Floats>(layer.brushes, focus.context, color, luminance(color), of.interest.doi, of.saturation);
    if (!(focus.brushColor > 0) || layer.brushes == BrushEffect::None) return out;
    return blended(out, of.interest.color, of.interest.held * of.interest.doi * Floats(focus.brushColor));
}

} // namespace tessera::vis::packet::TESSERA_LANES
