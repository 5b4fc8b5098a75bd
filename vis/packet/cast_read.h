#pragma once

#include "vis/packet/cast_job.h"
#include "vis/packet/lanes.h"
#include "vis/packet/packet_volume.h"
#include "volume/base/numbers.h"
#include "volume/reconstruct/present_coverage.h"

/// Packets of samples read from a PacketVolume: reconstruction, classification, light. Only for cast_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

using Vec = glm::vec<3, Floats>;
using Found = volume::FoundValue<Floats, Mask>;

inline Floats mix(Floats a, Floats b, Floats share) {
    return multiplyAdd(share, b - a, a);
}

/// Where a trilinear sample of one sublattice lies: its first sample's place, and the fractions.
struct Corner {
    Ints place;
    Floats fx, fy, fz;
};

inline Corner cornerAt(const VolumeView& volume, const Vec& at) {
    const auto inside = [](Floats p, int cells) { return smaller(larger(p, Floats(0)), Floats(float(cells) - 0.01f)); };
    const Floats x = inside(at.x, volume.cells.x), y = inside(at.y, volume.cells.y), z = inside(at.z, volume.cells.z);
    const Ints ix = toInts(x), iy = toInts(y), iz = toInts(z);
    Corner out;
    out.place = ix + iy * Ints(kRow) + iz * Ints(kRow * kRow) + (ix >> 4) * Ints(volume.perBrick.x) +
                (iy >> 4) * Ints(volume.perBrick.y) + (iz >> 4) * Ints(volume.perBrick.z);
    out.fx = x - toFloats(ix);
    out.fy = y - toFloats(iy);
    out.fz = z - toFloats(iz);
    return out;
}

/// Weights of two neighbours in 15 bits, in one lane.
inline Ints pairWeights(Floats f) {
    const Ints high = toInts(multiplyAdd(f, Floats(kQuantum), Floats(0.5)));
    return (high << 16) - high + Ints(kQuantum);
}

/// The interpolated 16-bit samples, times kQuantum.
inline Floats trilinear(const std::int16_t* samples, const Corner& corner, Ints weights, Mask lanes) {
    const auto row = [&](int more) {
        return toFloats(dotPairs(gather<2>(samples + more, corner.place, lanes), weights));
    };
    const Floats low = mix(row(0), row(kRow), corner.fy),
                 high = mix(row(kRow * kRow), row(kRow * kRow + kRow), corner.fy);
    return mix(low, high, corner.fz);
}

inline Floats trilinear(const float* samples, const Corner& corner, Mask lanes) {
    const auto row = [&](int more) {
        return mix(gatherFloats(samples + more, corner.place, lanes),
                   gatherFloats(samples + more + 1, corner.place, lanes), corner.fx);
    };
    const Floats low = mix(row(0), row(kRow), corner.fy),
                 high = mix(row(kRow * kRow), row(kRow * kRow + kRow), corner.fy);
    return mix(low, high, corner.fz);
}

/// Reconstructs samples; Bcc and Exact as in PacketVolume. Twin: volume/reconstruct/reconstruct.h.
template <bool Bcc, bool Exact> struct Reader {
    const VolumeView& volume;
    bool masked; ///< some samples may be absent here

    Found operator()(const Vec& at, Mask lanes) const {
        Floats sum(0), coverage(0);
        add(at, 0, lanes, sum, coverage);
        if constexpr (Bcc) add(at - Vec(Floats(0.5), Floats(0.5), Floats(0.5)), volume.oddOffset, lanes, sum, coverage);
        const float unit = (Exact ? 1.0f : 1.0f / kQuantum) * (Bcc ? 0.5f : 1.0f);
        if (!masked) return {sum * Floats(unit), lanes};
        const Floats covered = coverage * Floats((Bcc ? 0.5f : 1.0f) / kQuantum / kQuantum);
        const Mask present = lanes & (covered >= Floats(volume::kPresentCoverage));
        return {sum * Floats(unit) / larger(covered, Floats(1e-9)), present};
    }
    /// The value as far as samples have any weight, see reference::Samples::continued; present where they have.
    Found continued(const Vec& at, Mask lanes) const {
        if (!masked) return (*this)(at, lanes);
        Floats sum(0), coverage(0);
        add(at, 0, lanes, sum, coverage);
        if constexpr (Bcc) add(at - Vec(Floats(0.5), Floats(0.5), Floats(0.5)), volume.oddOffset, lanes, sum, coverage);
        const Floats weight = coverage * Floats(1.0f / kQuantum / kQuantum);
        return {sum * Floats(Exact ? 1.0f : 1.0f / kQuantum) / larger(weight, Floats(1e-9)),
                lanes & (weight > Floats(0))};
    }

private:
    void add(const Vec& at, int offset, Mask lanes, Floats& sum, Floats& coverage) const {
        const Corner corner = cornerAt(volume, at);
        if constexpr (Exact) {
            sum += trilinear(volume.floats + offset, corner, lanes);
            if (masked) coverage += trilinear(volume.present + offset, corner, pairWeights(corner.fx), lanes);
        } else {
            const Ints weights = pairWeights(corner.fx);
            sum += trilinear(volume.shorts + offset, corner, weights, lanes);
            if (masked) coverage += trilinear(volume.present + offset, corner, weights, lanes);
        }
    }
};

/// A place in a transfer function's table.
struct TablePlace {
    Ints entry, weights;
};
inline TablePlace tablePlace(Floats place) {
    const Floats u = clamped(place, Floats(0), Floats(1)) * Floats(kTableEntries - 1);
    const Ints entry = toInts(u);
    return {entry << 2, pairWeights(u - toFloats(entry))};
}
inline Floats tableValue(const LayerView& layer, const TablePlace& at, int component, Mask lanes) {
    return toFloats(dotPairs(gather<4>(layer.table + component, at.entry, lanes), at.weights)) *
           Floats(1.0f / kQuantum / kQuantum);
}
inline Floats opacityAt(const LayerView& layer, const TablePlace& at, Mask lanes) {
    return tableValue(layer, at, 3, lanes) * Floats(layer.opacityScale);
}
inline Vec colorAt(const LayerView& layer, const TablePlace& at, Mask lanes) {
    return {tableValue(layer, at, 0, lanes), tableValue(layer, at, 1, lanes), tableValue(layer, at, 2, lanes)};
}

/// The lit colour of samples with surfaces of weight 0..1, see vis/optics/shade.h (without maps and shadows).
inline Vec litColor(const CastJob& job, const Vec& albedo, const Vec& gradient, Floats weight, const Vec& place,
                    const Vec& toViewer) {
    const Floats squared = inner(gradient, gradient);
    const Mask surface = (squared > Floats(0)) & (weight > Floats(0));
    if (!anyOf(surface)) return albedo;
    // Gradients of samples may be tiny: the squares of their lengths must not vanish.
    const Vec whole(choose(surface, gradient.x, Floats(0)), choose(surface, gradient.y, Floats(0)),
                    choose(surface, gradient.z, Floats(1)));
    const FacingOf<Floats> at = facing(whole, toViewer);
    const ReflectedOf<Floats> even = evenLight(at, albedo, *job.surface);
    const Vec around = (even.diffuse + even.specular) * Floats(job.surface->ambient);
    const Vec lit = around + reflectedLights<Floats>(job.lights, *job.surface, at, albedo, even, place,
                                                     [](int) { return Floats(1); });
    return blended(albedo, lit, choose(surface, weight, Floats(0)));
}

} // namespace tessera::vis::packet::TESSERA_LANES
