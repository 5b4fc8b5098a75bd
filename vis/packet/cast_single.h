#pragma once

#include "vis/packet/cast_events.h"

#include <algorithm>

/// Packets of rays through a single layer, by loops that take no more than it needs. Only for cast_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

template <bool Bcc, bool Exact> struct SingleCaster : Caster<Bcc, Exact> {
    using Base = Caster<Bcc, Exact>;
    using Base::job, Base::packet, Base::count, Base::skip, Base::reader;
    using typename Base::Read;

    static constexpr int kAhead = 4; ///< samples taken together, because each waits long for its reads
    static constexpr int kPair = 2;  ///< the same where rays end soon
    const LayerView& layer = job.layers[0];
    const Fixed advance = fixedOf(packet.advance);

    explicit SingleCaster(const CastJob& j, Packet& p) : Base{{j, p}} {}

    Floats placeOf(Floats value) const {
        return multiplyAdd(value, Floats(layer.placeScale), Floats(layer.placeOffset));
    }

    /// Reads samples of rays from k on; `at`, the position of the first, moves beyond the last.
    template <int Count>
    [[gnu::always_inline]] void readAhead(const Read& read, Fixed& at, Floats k, Mask rays, Found* found) {
        Mask lanes[Count];
        for (int i = 0; i < Count; ++i) {
            lanes[i] = rays & (k + Floats(i) < packet.count);
            count(lanes[i]);
        }
        read.template row<Count>(at, advance, lanes, found);
    }

    /// A composite layer without light, brushes, lenses and holes. `Over`: its segments are classified over
    /// interpolation, all of its samples are present.
    template <bool Over> void castUnshaded() {
        Floats k(0);
        for (int i = 0; i < packet.eventCount; ++i) {
            const Floats at = smaller(packet.events[i].at, Floats(kFar / 2));
            k = marchUnshaded<Over>(k, clamped(roundUp(at), Floats(0), packet.count));
            packet.showEvents(at, packet.meets & packet.seeThrough());
        }
        marchUnshaded<Over>(k, packet.count);
    }
    /// Takes its samples from k on, those before `samples`, and returns the next. The sum of colours is in kQuantum
    /// until the end.
    template <bool Over> Floats marchUnshaded(Floats k, Floats samples) {
        constexpr float kLast = kPackedEntries - 1;
        const Floats length = packet.step * Floats(layer.density), perEntry(layer.placeScale * kLast),
                     firstEntry(layer.placeOffset * kLast + 0.5f);
        Vec color = packet.color * Floats(float(kQuantum));
        Floats opacity = packet.opacity, pick = packet.pick;
        Floats last(-2); // the sample whose segment ends at `front`
        SegmentEnd front{Ints(0), {Ints(0), Ints(0), Ints(0), Ints(0)}};
        const WithinFixed within(*layer.volume);
        Mask live = packet.meets & (k < samples) & (opacity < Floats(kOpaque));
        while (anyOf(live)) {
            const Skip::Look look = skip(k, live);
            Mask full = look.full;
            if (!anyOf(full)) continue;
            const Read read = reader(layer, !Over && someAbsent(job, packet, k, full));
            if constexpr (Over) {
                const Mask leapt = full & (k > last + Floats(1));
                if (anyOf(leapt)) front = choose(leapt, endAt(read, k - Floats(0.5), leapt).at, front);
            }
            Fixed at = fixedOf(packet.cells(Over ? k + Floats(0.5) : k));
            for (int n = 0; n < look.run; n += kAhead) {
                Mask lanes[kAhead];
                Found found[kAhead];
                for (int i = 0; i < kAhead; ++i) {
                    lanes[i] = full & (k + Floats(i) < samples);
                    count(lanes[i]);
                }
                if constexpr (Over) {
                    Fixed ends[kAhead];
                    for (Fixed& end : ends) {
                        end = within(at);
                        at += advance;
                    }
                    read.template row<kAhead>(ends, lanes, found);
                } else {
                    read.template row<kAhead>(at, advance, lanes, found);
                }
                for (int i = 0; i < kAhead; ++i) {
                    Medium medium;
                    if constexpr (Over) {
                        const SegmentEnd back = segmentEnd(layer, found[i].value, lanes[i]);
                        medium = mediumBetween(layer, front, back, lanes[i]);
                        front = back;
                    } else {
                        const Floats entry = multiplyAdd(found[i].value, perEntry, firstEntry);
                        medium = mediumAt(layer, entry, found[i].present);
                    }
                    const Floats alpha = correctedOpacityOf(medium.extinction, length, Floats(1));
                    const Floats weight = choose(opacity < Floats(kOpaque), (Floats(1) - opacity) * alpha, Floats(0));
                    for (int c = 0; c < 3; ++c) color[c] = multiplyAdd(medium.color[c], weight, color[c]);
                    opacity += weight;
                    pick = choose((pick <= Floats(kNoPick)) & (opacity > Floats(kPickOpacity)), k + Floats(i), pick);
                }
                last = choose(full, k + Floats(kAhead - 1), last);
                k = choose(full, k + Floats(kAhead), k);
                full &= (k < samples) & (opacity < Floats(kOpaque));
                if (!anyOf(full)) break;
            }
            live &= (k < samples) & (opacity < Floats(kOpaque));
        }
        packet.color = color * Floats(1.0 / kQuantum);
        packet.opacity = opacity;
        packet.pick = pick;
        return smaller(k, samples); // samples are taken several at a time
    }

    /// A composite layer: rays march to their next sample with opacity and wait there until half of them have met one;
    /// then these are shaded together. (If all waited for the last ones, those would march with most lanes empty.)
    void castComposite() {
        Floats k(0), place(0), opacity(0);
        Mask live = packet.meets, met = maskOf(0);
        while (anyOf(live)) {
            if (!enough(met, live)) {
                Mask open = live & !met;
                const Skip::Look look = skip(k, open);
                if (anyOf(look.full)) march<kPair>(look.full, live, k, met, place, opacity, look.run);
                live &= met | (k < packet.count);
                continue;
            }
            this->drawSample(layer, someAbsent(job, packet, k, met), place, opacity, k, met);
            k = choose(met, k + Floats(1), k);
            live &= (k < packet.count) & packet.seeThrough();
            met = maskOf(0);
            if (anyOf(live)) march<1>(live, live, k, met, place, opacity, 1); // the next sample often has opacity, too
            live &= met | (k < packet.count);
        }
    }
    static bool enough(Mask met, Mask live) { return 2 * countOf(met) >= countOf(live); }

    /// Takes samples of open rays until enough of the live ones have met opacity or `most` are over.
    template <int Ahead>
    void march(Mask open, Mask live, Floats& k, Mask& met, Floats& place, Floats& opacity, int most) {
        const Read read = reader(layer, someAbsent(job, packet, k, open));
        Fixed at = fixedOf(packet.cells(k));
        for (int n = 0; n < most; n += Ahead) {
            Found found[Ahead];
            readAhead<Ahead>(read, at, k, open, found);
            for (const Found& each : found) {
                const Floats along = placeOf(each.value);
                Mask hit = open & each.present & mayShow(layer, along);
                if (anyOf(hit)) {
                    const Floats alpha = opacityAt(layer, tablePlace(along), hit);
                    hit &= alpha > Floats(0);
                    place = choose(hit, along, place);
                    opacity = choose(hit, alpha, opacity);
                    met |= hit;
                    open &= !hit;
                }
                k = choose(open, k + Floats(1), k);
                open &= k < packet.count;
            }
            if (!anyOf(open) || enough(met, live)) return;
        }
    }

    /// The end of segments, which is where the next ones begin.
    struct End {
        Found found{Floats(0), maskOf(0)};
        SegmentEnd at = {};
    };
    End endAt(const Read& read, Floats k, Mask lanes) {
        count(lanes);
        const Found found = read(this->endOf(layer, k), lanes);
        return {found, segmentEnd(layer, found.value, lanes)};
    }
    static void replace(End& end, const End& by, Mask lanes) {
        end = {
            {choose(lanes, by.found.value, end.found.value), (end.found.present & !lanes) | (by.found.present & lanes)},
            choose(lanes, by.at, end.at)};
    }

    /// A composite layer classified over interpolation.
    void castSegments() {
        Floats k(0), last(-2); // `last`: the sample whose segment ends at `front`
        End front;
        Mask live = packet.meets;
        while (anyOf(live)) {
            const Skip::Look look = skip(k, live);
            Mask open = look.full;
            if (!anyOf(open)) continue;
            const bool masked = someAbsent(job, packet, k, open);
            const Read read = reader(layer, true); // ends may lie in other blocks
            const Mask leapt = open & (k > last + Floats(1));
            if (anyOf(leapt)) replace(front, endAt(read, k - Floats(0.5), leapt), leapt);
            for (int n = 0; n < look.run && anyOf(open); ++n) {
                const End back = endAt(read, k + Floats(0.5), open);
                const Classified own = preintegrated(layer, front.found, front.at, back.found, back.at, open, open);
                const Mask hit = open & (own.opacity > Floats(0)) & (own.share > Floats(0));
                if (anyOf(hit)) this->drawClassified(layer, masked, own.color, own.opacity, own.share, k, hit);
                replace(front, back, open);
                last = choose(open, k, last);
                k = choose(open, k + Floats(1), k);
                open &= (k < packet.count) & packet.seeThrough();
            }
            live &= (k < packet.count) & packet.seeThrough();
        }
    }

    /// A maximum or minimum without brushes and lenses: blocks that cannot exceed what a ray has found are passed over.
    void castExtremum() {
        constexpr int kSeed = 16; // samples apart that are taken first, so that more blocks can be passed over
        constexpr int kTogether = 2 * kAhead; // samples between two looks at the bounds of blocks
        const bool least = (layer.style == RayStyle::Minimum) != (layer.placeScale < 0);
        const Floats sign(least ? -1 : 1);
        Floats best(-1e30), bestAt(0);
        if (job.skip.bound != nullptr)
            for (Floats k(kSeed / 2); anyOf(packet.meets & (k < packet.count)); k += Floats(kSeed * kAhead))
                takeExtremum<kAhead, kSeed>(sign, k, packet.meets, best, bestAt);
        Floats k(0);
        Mask live = packet.meets;
        const int most = job.stepVoxels > 1 ? 1 : kTogether;
        const Blocks blocks(packet, job.skip.count);
        while (anyOf(live)) {
            Mask useful = live;
            if (job.skip.bound != nullptr) {
                const Floats score = choose(best > Floats(-1e30), scoreOf(best * sign), Floats(-1));
                for (int i = 0; i < kLeaps; ++i) {
                    const Blocks::Place block = blocks.at(k);
                    const Floats bound = toFloats(byteAt(job.skip.bound, block.index, live)) * Floats(1.0f / 255);
                    const Mask useless = live & (bound <= score);
                    k = choose(useless, k + blocks.leap(block, Floats(1)), k);
                    live &= k < packet.count;
                    useful = live & !useless;
                    if (!anyOf(live & useless)) break;
                }
                if (!anyOf(useful)) continue;
            }
            if (most == 1)
                takeExtremum<1>(sign, k, useful, best, bestAt);
            else
                takeExtremum<kTogether>(sign, k, useful, best, bestAt);
            k = choose(useful, k + Floats(most), k);
            live &= k < packet.count;
        }
        typename Base::Projected sums;
        const Mask some = best > Floats(-1e30);
        sums.add(layer.style, Floats(layer.threshold), some, placeOf(best * sign), Floats(1), Floats(0));
        sums.bestAt = bestAt;
        this->showProjection(layer, sums);
    }

    Floats scoreOf(Floats value) const {
        const Floats x = clamped(placeOf(value), Floats(0), Floats(1));
        return layer.style == RayStyle::Minimum ? Floats(1) - x : x;
    }

    /// Takes samples from k on, every `Apart`.
    template <int Count, int Apart = 1>
    void takeExtremum(Floats sign, Floats k, Mask rays, Floats& best, Floats& bestAt) {
        const auto sample = [&](int i) { return k + Floats(i * Apart); };
        Mask lanes[Count];
        for (int i = 0; i < Count; ++i) {
            lanes[i] = rays & (sample(i) < packet.count);
            count(lanes[i]);
        }
        bool masked = false;
        for (int i = 0; i<Count; i += Apart> 1 ? 1 : Count) masked |= someAbsent(job, packet, sample(i), lanes[i]);
        const Read read = reader(layer, masked);
        Fixed at = fixedOf(packet.cells(k));
        Found found[Count];
        read.template row<Count>(at, Apart == 1 ? advance : fixedOf(packet.advance * Floats(Apart)), lanes, found);
        for (int i = 0; i < Count; ++i) {
            const Floats value = found[i].value * sign;
            Mask better = found[i].present & (value > best);
            if (packet.holeCount > 0) better &= packet.shows(sample(i));
            best = choose(better, value, best);
            bestAt = choose(better, sample(i), bestAt);
        }
    }

    /// An iso-surface: rays march to their next intersection and wait there.
    void castSurface() {
        Floats k(0), last(-2); // `last`: the sample that `before` holds
        Found before{Floats(0), maskOf(0)}, now = before;
        Mask live = packet.meets, met = maskOf(0);
        for (;;) {
            Mask open = live & !met;
            if (anyOf(open)) {
                const Skip::Look look = skip(k, open);
                open = look.full;
                if (anyOf(open)) cross(open, k, last, met, before, now, look.run);
                live &= met | (k < packet.count);
                continue;
            }
            if (!anyOf(met)) return;
            const bool masked = someAbsent(job, packet, k, met);
            const RayHit surface = this->meetSurface(layer, masked, before, now, k, met);
            packet.blend(surface.color, surface.opacity, surface.at, met);
            before.value = choose(met, now.value, before.value);
            before.present = (before.present & !met) | (now.present & met);
            last = choose(met, k, last);
            k = choose(met, k + Floats(1), k);
            live &= (k < packet.count) & packet.seeThrough();
            met = maskOf(0);
        }
    }

    /// Takes samples until every open ray has crossed the surface or the run is over.
    void cross(Mask open, Floats& k, Floats& last, Mask& met, Found& before, Found& now, int most) {
        const Read read = reader(layer, someAbsent(job, packet, k, open));
        const Mask leapt = open & (k > last + Floats(1)) & (k > Floats(0));
        if (anyOf(leapt)) { // what these would have read at the sample before
            const Found own = read(packet.cells(k - Floats(1)), leapt);
            before.value = choose(leapt, own.value, before.value);
            before.present = (before.present & !leapt) | own.present;
        }
        const Floats value(layer.isoValue);
        Fixed at = fixedOf(packet.cells(k));
        for (int n = 0; n < most; n += kPair) {
            Found found[kPair];
            readAhead<kPair>(read, at, k, open, found);
            for (const Found& each : found) {
                const Mask above = before.value >= value, over = each.value >= value;
                const Mask hit = open & before.present & each.present & ((above & !over) | (over & !above));
                now.value = choose(open, each.value, now.value);
                now.present = (now.present & !open) | (each.present & open);
                met |= hit;
                open &= !hit;
                before.value = choose(open, each.value, before.value);
                before.present = (before.present & !open) | (each.present & open);
                last = choose(open, k, last);
                k = choose(open, k + Floats(1), k);
                open &= k < packet.count;
            }
            if (!anyOf(open)) return;
        }
    }
};

template <bool Bcc, bool Exact> void castLayersOf(SingleCaster<Bcc, Exact>& caster) {
    const CastJob& job = caster.job;
    const LayerView& layer = job.layers[0];
    const bool one = job.layers.size() == 1 && !layer.gradient && !layer.volume->labels &&
                     layer.volume->partCount == 0 && !caster.packet.bends;
    const bool post = layer.classification == Classification::Post;
    const bool plain = !job.focus.any;
    const bool unshaded = layer.style == RayStyle::Composite && plain && !layer.shaded && !layer.look &&
                          !layer.byRegions && !job.light.volume && caster.packet.holeCount == 0 &&
                          layer.colors.volume == nullptr;
    const bool over = layer.classification == Classification::PreIntegrated;
    if (one && unshaded && over && layer.volume->present == nullptr)
        caster.template castUnshaded<true>();
    else if (one && layer.style == RayStyle::Composite && over)
        caster.castSegments();
    else if (!one || !post)
        caster.castLayers();
    else if (unshaded)
        caster.template castUnshaded<false>();
    else if (layer.style == RayStyle::Composite)
        caster.castComposite();
    else if (layer.style == RayStyle::Iso)
        caster.castSurface();
    else if (plain && (layer.style == RayStyle::Maximum || layer.style == RayStyle::Minimum))
        caster.castExtremum();
    else
        caster.castLayers();
}

template <bool Bcc, bool Exact>
std::uint64_t castPacket(const CastJob& job, Packet& packet, glm::ivec2 begin, glm::ivec2 end) {
    const auto cast = [&](auto caster, const auto& castAll) {
        if (!job.slices.empty() || job.peels > 0) findEvents<Bcc, Exact>(caster, begin, end);
        castAll(caster);
        packet.showEvents();
        return caster.taken;
    };
    if (job.layers.empty()) return cast(Caster<Bcc, Exact>{{job, packet}}, [](const auto&) {});
    return cast(SingleCaster<Bcc, Exact>(job, packet), [](auto& caster) { castLayersOf(caster); });
}

template <bool Bcc, bool Exact> void castPixels(const CastJob& job, glm::ivec2 begin, glm::ivec2 end) {
    std::uint64_t taken = 0;
    for (int y = begin.y; y < end.y; y += kRows)
        for (int x = begin.x; x < end.x; x += kColumns) {
            Packet packet = beginPacket(job, {x, y}, end);
            if (!anyOf(packet.meets)) continue;
            packet.bends = meetsMagnifier(job, packet);
            taken += castPacket<Bcc, Exact>(job, packet, {x, y}, end);
            storePacket(job, packet, {x, y}, end);
        }
    if (job.samples != nullptr) __atomic_fetch_add(job.samples, taken, __ATOMIC_RELAXED);
}

inline void castTile(const CastJob& job, glm::ivec2 begin, glm::ivec2 end) {
    (job.bcc ? (job.exact ? castPixels<true, true> : castPixels<true, false>)
             : (job.exact ? castPixels<false, true> : castPixels<false, false>))(job, begin, end);
}

} // namespace tessera::vis::packet::TESSERA_LANES
