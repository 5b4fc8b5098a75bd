#pragma once

#include "vis/packet/cast_sample.h"

/// Packets of rays through the layers of a scene, sample by sample as vis/optics/ray_setup.h says. Only for cast_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

template <bool Bcc, bool Exact> struct Caster : SampleCaster<Bcc, Exact> {
    using Base = SampleCaster<Bcc, Exact>;
    using Base::count, Base::drawOtherwise, Base::drawSample, Base::focusOf, Base::gradient, Base::inPart, Base::job,
        Base::looked, Base::packet, Base::placeAt, Base::reader, Base::skip, Base::tint, Base::tinted;
    using typename Base::Drawn, typename Base::Read;

    /// A projection, and the sample that it shows.
    struct Projected : ProjectionSums<Floats, Mask> {
        Floats bestAt{0};
        Focus bestFocus;
        Floats tint{0}, tintWeight{0}; ///< of sums: weighted sum of the colouring channel, and its weight
        Projected() : ProjectionSums<Floats, Mask>{.found = maskOf(0)} {}
    };

    void project(const LayerView& layer, bool masked, const Found& found, Projected& sums, Floats k, Mask lanes) {
        const Mask present = found.present & packet.shows(k);
        const Floats along = placeAt(layer, masked, found, k, present & lanes);
        Focus focus;
        if (job.focus.any) focus = focusOf(layer, packet.cells(k), k, masked, present);
        Floats opacity(0);
        if (layer.style == RayStyle::XRay)
            opacity = correctedOpacity(opacityAt(layer, tablePlace(along), present) * focus.opacity, packet.step,
                                       Floats(layer.density));
        if (layer.colors.volume != nullptr) addTint(layer, sums, focus.opacity, opacity, k, present);
        const Mask foundBefore = sums.found;
        const Mask better = sums.add(layer.style, Floats(layer.threshold), present, along, focus.opacity, opacity);
        sums.bestAt = choose(better, k, sums.bestAt);
        if (job.focus.any) keepBest(sums.bestFocus, focus, better);
        // Rays that have ended do not see a local maximum end.
        sums.found = (sums.found & lanes) | (foundBefore & !lanes);
    }

    /// Before the sample is added to the sums.
    void addTint(const LayerView& layer, Projected& sums, Floats factor, Floats opacity, Floats k, Mask present) const {
        const bool rays = layer.style == RayStyle::XRay;
        if (!rays && layer.style != RayStyle::Average) return;
        const Found found = reader(*layer.colors.volume, true)(packet.cells(k), present);
        const Floats weight =
            choose(found.present & present, rays ? (Floats(1) - sums.absorbed) * opacity : factor, Floats(0));
        sums.tint = multiplyAdd(weight, found.value, sums.tint);
        sums.tintWeight += weight;
    }

    static void keepBest(Focus& best, const Focus& focus, Mask better) {
        best.opacity = choose(better, focus.opacity, best.opacity);
        best.saturation = choose(better, focus.saturation, best.saturation);
        best.interest.doi = choose(better, focus.interest.doi, best.interest.doi);
        best.interest.held = choose(better, focus.interest.held, best.interest.held);
        best.interest.color = choose(better, focus.interest.color, best.interest.color);
    }

    /// Puts a projection behind what is there.
    void showProjection(const LayerView& layer, const Projected& sums) {
        packet.showEvents();
        const Mask some = (sums.count > Floats(0)) & (sums.factors > Floats(0));
        Floats place = sums.bestPlace, shownAt = sums.bestAt;
        if (layer.style == RayStyle::XRay || layer.style == RayStyle::Average) shownAt = packet.count * Floats(0.5);
        if (layer.style == RayStyle::XRay) place = sums.absorbed;
        if (layer.style == RayStyle::Average) place = sums.weighted / larger(sums.factors, Floats(1e-6));
        const TablePlace at = tablePlace(place);
        Floats alpha = smaller(Floats(1), Floats(layer.density) * opacityAt(layer, at, some));
        if (layer.style == RayStyle::XRay) alpha = sums.absorbed;
        Vec color = colorAt(layer.table, at, some);
        if (layer.colors.volume != nullptr) {
            const bool mean = layer.style == RayStyle::XRay || layer.style == RayStyle::Average;
            const Found whole{sums.tint / larger(sums.tintWeight, Floats(1e-20)), sums.tintWeight > Floats(0)};
            color = mean ? tint(layer.colors, whole) : tinted(layer, color, packet.cells(sums.bestAt), some);
        }
        if (job.focus.any && layer.style == RayStyle::Average)
            alpha = smaller(Floats(1), alpha * sums.factors / larger(sums.count, Floats(1)));
        if (job.focus.any && layer.style != RayStyle::Average && layer.style != RayStyle::XRay) {
            alpha = smaller(Floats(1), alpha * sums.bestFocus.opacity);
            color = focused(job.focus, layer, color, sums.bestFocus);
        }
        packet.blend(color, alpha, shownAt, some);
    }

    /// The same as far as these have any weight.
    [[gnu::noinline]] Found continuedInPart(const Read& read, Floats part, const Vec& cells, Mask lanes) const {
        Found out{Floats(0), maskOf(0)};
        for (int i = 0; i < read.volume.partCount; ++i) {
            const Mask of = lanes & (part >= Floats(i)) & (part <= Floats(i));
            if (!anyOf(of)) continue;
            const Found own = read.ofPart(i).continued(cells, of);
            out = {choose(of, own.value, out.value), out.present | (own.present & of)};
        }
        return out;
    }

    /// The intersections with an iso-surface between samples k - 1 and k.
    RayHit meetSurface(const LayerView& layer, bool masked, const Found& before, const Found& now, Floats k,
                       Mask lanes) {
        const Read read = reader(layer, masked);
        const Floats value(layer.isoValue), far(kFar);
        const Mask above = before.value >= value, below = !above, over = now.value >= value;
        Mask crossed = lanes & before.present & now.present & ((above & !over) | (below & over));
        const bool parts = read.volume.partCount > 0;
        Floats part(0);
        const auto same = [&](Floats other) { return (other >= part) & (other <= part); };
        if (parts && anyOf(crossed)) { // a surface lies within one part
            part = read.part(packet.cells(k), crossed);
            crossed &= same(read.part(packet.cells(k - Floats(1)), crossed));
        }
        RayHit out{far, {Floats(0), Floats(0), Floats(0)}, Floats(0)};
        if (!anyOf(crossed)) return out;
        Floats lo = k - Floats(1), hi = k;
        for (int i = 0; i < kBisections; ++i) {
            const Floats middle = (lo + hi) * Floats(0.5);
            count(crossed);
            const Vec place = packet.cells(middle);
            const Found there = parts ? continuedInPart(read, part, place, crossed) : read.continued(place, crossed);
            const Mask high = there.present & (there.value >= value), alike = (high & above) | (!high & below);
            lo = choose(alike, middle, lo);
            hi = choose(alike, hi, middle);
        }
        const Floats at = (lo + hi) * Floats(0.5);
        const Vec cells = packet.cells(at);
        Mask shown = crossed & packet.shows(at);
        if (parts) shown &= same(read.part(cells, crossed));
        if (!anyOf(shown)) return out;
        out.at = choose(shown, at, far);
        Vec albedo = tinted(layer, spreadOut<Floats>(layer.isoColor), cells, shown);
        Floats opacity(layer.isoOpacity);
        Focus focus;
        if (job.focus.any) {
            focus = focusOf(layer, cells, at, masked, shown);
            albedo = focused(job.focus, layer, albedo, focus);
            opacity = smaller(Floats(1), opacity * focus.opacity);
        }
        if (layer.look != nullptr) {
            const Drawn own = looked(layer, read, albedo, opacity, focus.interest.doi, cells, at, shown);
            out.color = own.color;
            out.opacity = own.opacity;
            return out;
        }
        Vec slope(Floats(0), Floats(0), Floats(0)); // labels have none
        if (!layer.volume->labels) slope = gradient(read, cells, shown);
        out.color = litColor(job, albedo, slope, Floats(1), packet.world(at), -packet.ray.direction);
        out.opacity = choose(shown, opacity, Floats(0));
        return out;
    }

    /// All layers, in order.
    void castLayers() {
        Projected sums[kMostPacketLayers];
        Found before[kMostPacketLayers], now[kMostPacketLayers];
        const int layers = int(job.layers.size());
        for (int i = 0; i < layers; ++i) before[i] = now[i] = {Floats(0), maskOf(0)};
        Floats k(0), last(-2); // `last`: the sample that `before` holds
        Mask live = packet.meets;
        while (anyOf(live)) {
            // Blocks are known where the data are, not where lenses show them.
            const Skip::Look look = packet.bends ? Skip::Look{live, kRun} : skip(k, live);
            if (!anyOf(look.full)) continue;
            const bool masked = someAbsent(job, packet, k, live);
            // What rays that leapt would have read at the sample before.
            const Mask leapt = live & (k > last + Floats(1)) & (k > Floats(0));
            if (anyOf(leapt))
                for (int i = 0; i < layers; ++i) {
                    if (job.layers[i].style != RayStyle::Iso) continue;
                    const Found own = reader(job.layers[i], masked)(packet.cells(k - Floats(1)), leapt);
                    before[i].value = choose(leapt, own.value, before[i].value);
                    before[i].present = (before[i].present & !leapt) | own.present;
                }
            for (int n = 0; n < look.run && anyOf(live); ++n) {
                for (int i = 0; i < layers; ++i) {
                    if (job.layers[i].classification != Classification::Post) continue;
                    count(live);
                    now[i] = reader(job.layers[i], masked)(packet.cells(k), live);
                }
                drawSurfaces(before, now, masked, k, live);
                if (packet.eventCount > 0) packet.showEvents(k, live); // so that rays end at opaque ones
                for (int i = 0; i < layers; ++i) drawVolume(job.layers[i], now[i], sums[i], masked, k, live);
                for (int i = 0; i < layers; ++i) {
                    before[i].value = choose(live, now[i].value, before[i].value);
                    before[i].present = (before[i].present & !live) | now[i].present;
                }
                last = choose(live, k, last);
                k = choose(live, k + Floats(1), k);
                live &= (k < packet.count) & packet.seeThrough();
            }
        }
        for (int i = 0; i < layers; ++i)
            if (isProjection(job.layers[i].style)) showProjection(job.layers[i], sums[i]);
    }

    static bool isProjection(RayStyle style) { return style != RayStyle::Composite && style != RayStyle::Iso; }

    void drawSurfaces(const Found* before, const Found* now, bool masked, Floats k, Mask lanes) {
        RayHit met[kMostPacketSurfaces];
        int crossed = 0;
        for (std::size_t i = 0; i < job.layers.size(); ++i) {
            const LayerView& layer = job.layers[i];
            if (layer.style == RayStyle::Iso && crossed < kMostPacketSurfaces)
                met[crossed++] = meetSurface(layer, masked, before[i], now[i], k, lanes);
        }
        sortByDistance(met, crossed);
        for (int i = 0; i < crossed; ++i) packet.blend(met[i].color, met[i].opacity, met[i].at, lanes);
    }

    void drawVolume(const LayerView& layer, const Found& now, Projected& sums, bool masked, Floats k, Mask lanes) {
        if (layer.style == RayStyle::Iso) return;
        if (layer.style != RayStyle::Composite) return project(layer, masked, now, sums, k, lanes);
        if (layer.classification != Classification::Post) return drawOtherwise(layer, masked, k, lanes);
        const Floats place = placeAt(layer, masked, now, k, lanes & now.present);
        const Floats alpha = opacityAt(layer, tablePlace(place), now.present);
        const Mask hit = lanes & now.present & (alpha > Floats(0));
        if (anyOf(hit)) drawSample(layer, masked, place, alpha, k, hit);
    }
};

} // namespace tessera::vis::packet::TESSERA_LANES
