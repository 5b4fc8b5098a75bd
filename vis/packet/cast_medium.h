#pragma once

#include "vis/packet/cast_sample.h"

/// Extinction of the cells of a light grid, one in each lane. Only for cast_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

/// A packet whose sample 0 lies at a place.
inline Packet packetAt(const CastJob& job, const Vec& world) {
    Packet packet;
    packet.meets = maskOf((1u << kLanes) - 1);
    packet.ray.origin = world;
    packet.ray.direction = packet.advance = Vec(Floats(0), Floats(0), Floats(0));
    packet.first = world * spreadOut<Floats>(job.box.cellsPerWorld) + spreadOut<Floats>(job.box.cellsOffset);
    packet.count = Floats(1);
    packet.step = packet.enter = packet.phase = Floats(0);
    for (std::size_t i = 0; i < job.focus.lenses.size(); ++i) packet.bends |= job.focus.magnifies[i] > 0;
    return packet;
}

/// The layers of a job as mediumAt() wants them.
template <bool Bcc, bool Exact> struct MediumScene {
    const CastJob& job;

    int layers() const { return int(job.layers.size()); }
    const LayerView& of(int i) const { return job.layers[std::size_t(i)]; }
    MediumLayer layer(int i) const {
        const LayerView& own = of(i);
        if (own.style == RayStyle::Iso) return {MediumKind::Surface, 1, double(own.isoValue)};
        if (own.style != RayStyle::Composite) return {};
        return {MediumKind::Volume, double(own.density), 0};
    }
    Mask kept(const Vec& world) const { return vis::kept<Floats>(job.clips, world); }
    static Mask all() { return maskOf((1u << kLanes) - 1); }

    struct Point {
        Floats value;
        Mask present;
        Floats part;
    };
    Point read(int i, const Vec& world) const {
        Packet packet = packetAt(job, world);
        SampleCaster<Bcc, Exact> caster{job, packet};
        const auto reader = caster.reader(of(i), true);
        const Found found = reader(packet.first, all());
        return {found.value, found.present, reader.part(packet.first, all())};
    }
    glm::vec<4, Floats> after(SampleCaster<Bcc, Exact>& caster, const LayerView& layer, Vec color, Floats opacity,
                              Mask lanes) const {
        const Vec& cells = caster.packet.first;
        color = caster.tinted(layer, color, cells, lanes);
        if (job.focus.any) {
            const Focus focus = caster.focusOf(layer, cells, Floats(0), true, lanes);
            color = focused(job.focus, layer, color, focus);
            opacity = opacity * focus.opacity;
        }
        return {color.x, color.y, color.z, opacity};
    }
    glm::vec<4, Floats> at(int i, const Point& found, const Vec& world) const {
        Packet packet = packetAt(job, world);
        SampleCaster<Bcc, Exact> caster{job, packet};
        const Floats place = caster.placeAt(of(i), true, {found.value, found.present}, Floats(0), found.present);
        if (of(i).byRegions) {
            const auto own = caster.onPlane(of(i), caster.reader(of(i), true), place, packet.first, found.present);
            return after(caster, of(i), own.color, own.opacity, found.present);
        }
        const TablePlace entry = tablePlace(place);
        return after(caster, of(i), colorAt(of(i).table, entry, found.present), opacityAt(of(i), entry, found.present),
                     found.present);
    }
    glm::vec<4, Floats> surface(int i, const Vec& world) const {
        Packet packet = packetAt(job, world);
        SampleCaster<Bcc, Exact> caster{job, packet};
        return after(caster, of(i), spreadOut<Floats>(of(i).isoColor), Floats(of(i).isoOpacity), all());
    }
};

template <bool Bcc, bool Exact> void fillRowOf(const CastJob& job, const LightGrid& grid, int row, glm::vec4* out) {
    const MediumScene<Bcc, Exact> scene{job};
    const glm::dvec3 first = grid.center({0, row % grid.size.y, row / grid.size.y});
    for (int x = 0; x < grid.size.x; x += kLanes) {
        float along[kLanes], parts[4][kLanes];
        for (int i = 0; i < kLanes; ++i) {
            const int cell = x + i < grid.size.x ? x + i : grid.size.x - 1;
            along[i] = float(first.x + grid.cell().x * cell);
        }
        const glm::vec<4, Floats> medium =
            mediumAt<Floats>(scene, grid, {Floats::load(along), Floats(first.y), Floats(first.z)});
        for (int c = 0; c < 4; ++c) medium[c].store(parts[c]);
        for (int i = 0; i < kLanes && x + i < grid.size.x; ++i)
            out[x + i] = {parts[0][i], parts[1][i], parts[2][i], parts[3][i]};
    }
}

/// Row `row`, y + z * size.y, of a light grid.
inline void fillRow(const CastJob& job, const LightGrid& grid, int row, glm::vec4* out) {
    (job.bcc ? (job.exact ? fillRowOf<true, true> : fillRowOf<true, false>)
             : (job.exact ? fillRowOf<false, true> : fillRowOf<false, false>))(job, grid, row, out);
}

} // namespace tessera::vis::packet::TESSERA_LANES
