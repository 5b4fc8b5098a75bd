#pragma once

#include "vis/packet/cast_read.h"

/// Light at packets of samples, by the formulas of vis/optics/shade.h. Only for cast_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

/// What a PackedLight knows of places and of directions.
struct LightAt {
    const PackedLight& light;

    [[gnu::noinline]] glm::vec<4, Floats> visible(const Vec& place) const {
        return betweenCells<Floats>(light.grid, place, [&](Floats index) {
            const IntPair pairs = gatherPairs<8>(light.visible.data(), toInts(index), all());
            const Ints low(0xffff);
            const glm::vec<4, Floats> quanta(toFloats(pairs.low & low), toFloats(pairs.low >> 16),
                                             toFloats(pairs.high & low), toFloats(pairs.high >> 16));
            return quanta * Floats(1.0f / kQuantum);
        });
    }
    [[gnu::noinline]] Vec scattered(const Vec& place) const {
        return betweenCells<Floats>(light.grid, place, [&](Floats index) {
            const float* const from = light.scattered.data();
            const Ints at = toInts(index) << 2;
            return Vec(gatherFloats(from, at, all()), gatherFloats(from + 1, at, all()),
                       gatherFloats(from + 2, at, all()));
        });
    }
    Vec diffuse(const Vec& direction) const { return onMap(light.diffuse, direction); }
    Vec specular(const Vec& direction) const { return onMap(light.specular, direction); }

private:
    static Mask all() { return maskOf((1u << kLanes) - 1); }
    [[gnu::noinline]] static Vec onMap(const PackedMap& map, const Vec& direction) {
        const Floats wide(map.edge + 2);
        return bilinearOnCube<Floats>(map.edge, direction, [&](Floats face, Floats i, Floats j) {
            const auto within = [&](Floats of) { return clamped(of + Floats(1), Floats(0), wide - Floats(1)); };
            const Ints at = toInts(multiplyAdd(multiplyAdd(face, wide, within(j)), wide, within(i))) << 2;
            const float* const from = map.texels.data();
            return Vec(gatherFloats(from, at, all()), gatherFloats(from + 1, at, all()),
                       gatherFloats(from + 2, at, all()));
        });
    }
};

/// The lit colour of samples with surfaces of weight 0..1. `gradient` in world axes.
[[gnu::noinline]] inline Vec litAround(const CastJob& job, const Vec& albedo, const Vec& gradient, Floats weight,
                                       const Vec& place, const Vec& toViewer) {
    return shade<Floats>(job.light, LightAt{*job.around}, albedo, gradient, weight, place, toViewer);
}
inline Vec litColor(const CastJob& job, const Vec& albedo, const Vec& gradient, Floats weight, const Vec& place,
                    const Vec& toViewer) {
    if (job.light.maps || job.light.volume) return litAround(job, albedo, gradient, weight, place, toViewer);
    return shade<Floats>(job.light, NothingAround{}, albedo, gradient, weight, place, toViewer);
}
/// The same of samples without a surface.
inline Vec flatColor(const CastJob& job, const Vec& albedo, const Vec& place) {
    const Vec none(Floats(0), Floats(0), Floats(0));
    return litAround(job, albedo, none, Floats(0), place, none);
}

} // namespace tessera::vis::packet::TESSERA_LANES
