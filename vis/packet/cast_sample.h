#pragma once

#include "vis/packet/cast_classify.h"

/// Samples of the layers of a scene: their gradients, colours, light and looks. Only for cast_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

/// Between them there are samples around ends of segments.
inline constexpr float kFirstWithin = 0.5f;
inline float lastWithin(const VolumeView& volume, int axis) {
    return float(volume.cells[axis]) - 1.01f;
}
/// Moves positions there.
struct WithinFixed {
    Ints first, last[3];
    explicit WithinFixed(const VolumeView& volume) : first(toInts(Floats(kFirstWithin * (1 << 16)))) {
        for (int axis = 0; axis < 3; ++axis) last[axis] = toInts(Floats(lastWithin(volume, axis) * (1 << 16)));
    }
    [[gnu::always_inline]] Fixed operator()(const Fixed& at) const {
        const auto along = [&](Ints own, int axis) { return smaller(larger(own, first), last[axis]); };
        return {along(at.x, 0), along(at.y, 1), along(at.z, 2)};
    }
};

/// What all layers of a packet share, and their samples.
template <bool Bcc, bool Exact> struct SampleCaster {
    const CastJob& job;
    Packet& packet;
    const Skip skip{job, packet};
    std::uint64_t taken = 0; ///< samples

    using Read = Reader<Bcc, Exact>;

    /// `masked`: samples of some layer may be absent here.
    Read reader(const VolumeView& volume, bool masked) const {
        return {volume, (masked || packet.bends) && volume.present != nullptr, packet.bends ? &job : nullptr};
    }
    Read reader(const LayerView& layer, bool masked) const { return reader(*layer.volume, masked); }

    /// Where the data are that are shown at a position, which is what brushes in space know.
    Vec shown(const Vec& cells) const { return packet.bends ? bent(job, cells) : cells; }

    Focus focusOf(const LayerView& layer, const Vec& cells, Floats k, bool masked, Mask lanes) const {
        const auto read = [&](const VolumeView& field) { return reader(field, masked)(cells, lanes); };
        return focusAt(job.focus, layer, shown(cells), packet.world(k), lanes, read);
    }

    /// Degree of interest of places that are no samples of rays.
    Interest interestAt(const Vec& cells, const Vec& world, Mask lanes) const {
        Found values[kMostBrushFields];
        for (std::size_t i = 0; i < job.focus.fields.size(); ++i)
            values[i] = reader(*job.focus.fields[i], true)(cells, lanes);
        return interestOf(job.focus, values, shown(cells), world, lanes);
    }

    /// Counts reconstructions of a value.
    void count(Mask lanes, int reads = 1) {
        if (job.samples != nullptr) taken += std::uint64_t(__builtin_popcount(bitsOf(lanes)) * reads);
    }

    /// Gradient in world axes, of samples.
    Vec gradient(const Read& read, const Vec& cells, Mask lanes) {
        const auto value = [&](const Vec& at) __attribute__((always_inline)) {
            return read.next(fixedOf(at), lanes);
        };
        if (read.volume.partCount > 0) return gradientOfParts(read, cells, lanes);
        count(lanes, 2 * job.stencil.count);
        if (packet.bends) return gradientBehindLenses(read, cells, lanes);
        if (!Exact && !read.masked && !read.volume.cubic && sharesReads(job.stencil, Bcc))
            return sharedGradient<Bcc>(read.volume, cells, job.stencil.reach, lanes) / spreadOut<Floats>(job.box.edges);
        return volume::gradientOf<Floats>(value, cells, job.stencil) / spreadOut<Floats>(job.box.edges);
    }

    [[gnu::noinline]] Vec gradientBehindLenses(const Read& read, const Vec& cells, Mask lanes) {
        const auto value = [&](const Vec& at) { return read(at, lanes); };
        return volume::gradientOf<Floats>(value, cells, job.stencil) / spreadOut<Floats>(job.box.edges);
    }
    /// The same within the part that each place belongs to.
    [[gnu::noinline]] Vec gradientOfParts(const Read& read, const Vec& cells, Mask lanes) {
        const Floats part = read.part(cells, lanes);
        Vec out(Floats(0), Floats(0), Floats(0));
        for (int i = 0; i < read.volume.partCount; ++i) {
            const Mask own = lanes & (part >= Floats(i)) & (part <= Floats(i));
            if (anyOf(own)) out = choose(own, gradient(read.ofPart(i), cells, own), out);
        }
        return out;
    }

    /// Change over a cell, of a gradient of samples in world axes.
    Floats steepness(const Vec& slope) const { return lengthOf(slope * spreadOut<Floats>(job.cell)); }

    /// Places of samples in a layer's transfer function, not clamped.
    Floats placeAt(const LayerView& layer, bool masked, const Found& found, Floats k, Mask lanes) {
        if (!layer.gradient) return multiplyAdd(found.value, Floats(layer.placeScale), Floats(layer.placeOffset));
        if (!anyOf(lanes)) return Floats(0);
        return steepness(gradient(reader(layer, masked), packet.cells(k), lanes)) * Floats(layer.gradientScale);
    }

    /// Colours by a value of the channel that colours a layer.
    static Vec tint(const ColorView& colors, const Found& found) {
        const Floats place = multiplyAdd(found.value, Floats(colors.placeScale), Floats(colors.placeOffset));
        return choose(found.present, colorAt(colors.table, tablePlace(place), found.present),
                      spreadOut<Floats>(colors.absent));
    }
    /// Colours of a layer; `own` if no other channel gives them.
    Vec tinted(const LayerView& layer, const Vec& own, const Vec& cells, Mask lanes) const {
        return layer.colors.volume == nullptr ? own : colorsAt(layer.colors, cells, lanes);
    }
    [[gnu::noinline]] Vec colorsAt(const ColorView& colors, const Vec& cells, Mask lanes) const {
        return tint(colors, reader(*colors.volume, true)(cells, lanes));
    }

    /// Samples of a composite layer classified by regions of value and gradient.
    struct OnPlane {
        Vec color, slope; ///< slope: gradient in world axes
        Floats opacity;
    };
    [[gnu::noinline]] OnPlane onPlane(const LayerView& layer, const Read& read, Floats place, const Vec& cells,
                                      Mask lanes) {
        Vec slope(Floats(0), Floats(0), Floats(0)); // labels have none
        if (!layer.volume->labels) slope = gradient(read, cells, lanes);
        const auto within = [](Floats of) { return clamped(of, Floats(0), Floats(1)); };
        const Floats steep = within(steepness(slope) * Floats(layer.gradientScale));
        const Floats value = within(multiplyAdd(within(place), Floats(layer.toRange.x), Floats(layer.toRange.y)));
        const glm::vec<4, Floats> srgb =
            colorOfRegions<Floats>(layer.regions, colorAt(layer.table, tablePlace(place), lanes), value, steep);
        const auto linear = [](Floats encoded) { return linearFromSrgb<Floats>(encoded); };
        return {{linear(srgb.x), linear(srgb.y), linear(srgb.z)}, slope, choose(lanes, srgb.w, Floats(0))};
    }

    /// The colour of samples of a composite layer after light; `slope`: their gradient, where it is known.
    Vec lit(const LayerView& layer, const Read& read, const Vec& albedo, const Vec& cells, Floats k, Mask lanes,
            const Vec* known = nullptr) {
        const Vec slope = known != nullptr ? *known : gradient(read, cells, lanes);
        const Floats weight = smaller(Floats(1), steepness(slope) * Floats(layer.surfaceScale));
        return litColor(job, albedo, slope, weight, packet.world(k), -packet.ray.direction);
    }

    /// Colours and opacities after light and look, of samples of one part each.
    struct Drawn {
        Vec color;
        Floats opacity;
    };
    [[gnu::noinline]] Drawn looked(const LayerView& layer, const Read& read, const Vec& albedo, Floats opacity,
                                   Floats doi, const Vec& cells, Floats k, Mask lanes) {
        const bool iso = layer.style == RayStyle::Iso;
        const Vec none(Floats(0), Floats(0), Floats(0));
        const Look& look = *layer.look;
        Vec narrow = none; // labels have none
        if (!layer.volume->labels) narrow = choose(lanes, gradient(read, cells, lanes), none);
        const Floats steep = steepness(narrow), weight = smaller(Floats(1), steep * Floats(layer.surfaceScale));
        const LookInput at{
            layer, cells,  packet.world(k), packet.ray.direction,     packet.enter + (k + packet.phase) * packet.step,
            doi,   narrow, steep,           iso ? Floats(1) : weight, iso};
        const Floats part = read.part(cells, lanes);
        const auto value = [&](const Vec& place) {
            count(lanes);
            return inPart(read, part, withinBox(job, place), lanes);
        };
        const Vec slope = lookGradient(job, at, value);
        const LookSampleOf<Floats> sample = lookSample(job, at, value, slope);
        if (!iso) opacity = solidOpacity(look, opacity, sample.share);
        Vec color = lookAlbedo(look, albedo, sample.share);
        if (iso || layer.shaded)
            color = litColor(job, color, slope, at.weight, at.world, -packet.ray.direction);
        else if (job.light.volume)
            color = flatColor(job, color, at.world);
        color = lookColor(look, albedo, color, sample, job.look.ground);
        return {choose(lanes, color, none), choose(lanes, lookOpacity(look, opacity, sample), Floats(0))};
    }

    /// Shades samples of a composite layer and puts them behind what is there.
    void drawSample(const LayerView& layer, bool masked, Floats place, Floats opacity, Floats k, Mask lanes) {
        if (!layer.byRegions) {
            const Vec color = colorAt(layer.table, tablePlace(place), lanes);
            return drawClassified(layer, masked, color, opacity, Floats(1), k, lanes);
        }
        const OnPlane own = onPlane(layer, reader(layer, masked), place, packet.cells(k), lanes);
        lanes &= own.opacity > Floats(0);
        if (anyOf(lanes)) drawClassified(layer, masked, own.color, own.opacity, Floats(1), k, lanes, &own.slope);
    }
    /// `slope`: their gradient, where it is known. `share`: present fraction of their segments.
    [[gnu::always_inline]] void drawClassified(const LayerView& layer, bool masked, const Vec& own, Floats opacity,
                                               Floats share, Floats k, Mask lanes, const Vec* slope = nullptr) {
        const Read read = reader(layer, masked);
        const Vec cells = packet.cells(k);
        Vec color = tinted(layer, own, cells, lanes);
        Focus focus;
        if (job.focus.any) {
            focus = focusOf(layer, cells, k, masked, lanes);
            color = focused(job.focus, layer, color, focus);
            opacity = opacity * focus.opacity;
        }
        if (layer.look != nullptr) {
            const Drawn drawn = looked(layer, read, color, opacity, focus.interest.doi, cells, k, lanes);
            color = drawn.color;
            opacity = drawn.opacity;
        } else if (layer.shaded) {
            color = lit(layer, read, color, cells, k, lanes, slope);
        } else if (job.light.volume) {
            color = flatColor(job, color, packet.world(k));
        }
        const Floats thickness =
            share * Floats(layer.density) * (packet.holeCount > 0 ? packet.coverage(k) : Floats(1));
        packet.blend(color, correctedOpacity(opacity, packet.step, thickness), k, lanes);
    }

    /// Where the segments around samples begin and end.
    Vec endOf(const LayerView& layer, Floats k) const { return withinVolume(*layer.volume, packet.cells(k)); }

    /// Classifies samples of a layer before or over interpolation, and draws them.
    [[gnu::noinline]] void drawOtherwise(const LayerView& layer, bool masked, Floats k, Mask lanes) {
        Classified own;
        if (layer.classification == Classification::Pre) {
            count(lanes);
            own = preclassified(layer, reader(layer, masked), packet.cells(k), lanes);
        } else {
            const Read read = reader(layer, true); // they may lie in other blocks
            const Vec front = endOf(layer, k - Floats(0.5)), back = endOf(layer, k + Floats(0.5));
            count(lanes, 2);
            Mask same = lanes;
            if (layer.volume->partCount > 0) {
                const Floats a = read.part(front, lanes), b = read.part(back, lanes);
                same = (a >= b) & (a <= b);
            }
            const Found first = read(front, lanes), last = read(back, lanes);
            own = preintegrated(layer, first, segmentEnd(layer, first.value, lanes), last,
                                segmentEnd(layer, last.value, lanes), same, lanes);
        }
        const Mask hit = lanes & (own.opacity > Floats(0)) & (own.share > Floats(0));
        if (anyOf(hit)) drawClassified(layer, masked, own.color, own.opacity, own.share, k, hit);
    }
    /// Moved to where there are samples around.
    static Vec withinVolume(const VolumeView& volume, const Vec& cells) {
        Vec out;
        for (int axis = 0; axis < 3; ++axis)
            out[axis] = clamped(cells[axis], Floats(kFirstWithin), Floats(lastWithin(volume, axis)));
        return out;
    }

    /// The values from samples of one part each.
    Found inPart(const Read& read, Floats part, const Vec& cells, Mask lanes) const {
        if (read.volume.partCount == 0) return read(cells, lanes);
        Found out{Floats(0), maskOf(0)};
        for (int i = 0; i < read.volume.partCount; ++i) {
            const Mask of = lanes & (part >= Floats(i)) & (part <= Floats(i));
            if (!anyOf(of)) continue;
            const Found own = read.ofPart(i)(cells, of);
            out = {choose(of, own.value, out.value), out.present | (own.present & of)};
        }
        return out;
    }
};

} // namespace tessera::vis::packet::TESSERA_LANES
