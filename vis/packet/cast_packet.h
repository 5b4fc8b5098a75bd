#pragma once

#include "vis/optics/jitter.h"
#include "vis/optics/projection_sums.h"
#include "vis/optics/ray_setup.h"
#include "vis/packet/cast_read.h"

/// Packets of rays: neighbouring pixels in the lanes. Only for cast_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

inline constexpr float kNoPick = -2, kPickOpacity = 0.1f; // as in vis/shaders/lib/layers/shown.glsl
inline constexpr float kFar = 1e9f;                       ///< beyond all samples

/// A contribution at or between samples.
struct RayHit {
    Floats at; ///< in samples; kFar: none
    Vec color;
    Floats opacity;
};
inline RayHit choose(Mask which, const RayHit& a, const RayHit& b) {
    return {
        choose(which, a.at, b.at),
        {choose(which, a.color.x, b.color.x), choose(which, a.color.y, b.color.y), choose(which, a.color.z, b.color.z)},
        choose(which, a.opacity, b.opacity)};
}
/// Nearest first; equal ones in order.
inline void sortByDistance(RayHit* met, int count) {
    for (int end = count; end > 1; --end)
        for (int i = 0; i + 1 < end; ++i) {
            const Mask later = met[i].at > met[i + 1].at;
            if (!anyOf(later)) continue;
            const RayHit a = met[i], b = met[i + 1];
            met[i] = choose(later, b, a);
            met[i + 1] = choose(later, a, b);
        }
}

/// Rays and what they have accumulated. Sample k of a ray lies at enter + (k + phase) step.
struct Packet {
    RayOf<Floats> ray;
    Mask meets;
    Floats count, step, enter, phase;
    Vec first, advance;                 ///< of sample 0, and from one to the next, in cells of the volumes
    SegmentOf<Floats> holes[kMaxClips]; ///< in samples
    int holeCount = 0;

    bool bends = false; ///< a magnifying lens may bend what they show

    Vec color{Floats(0), Floats(0), Floats(0)};
    Floats opacity{0};
    Floats pick{kNoPick}; ///< sample at which opacity exceeds kPickOpacity

    /// Slices and rasterised surfaces that rays meet, nearest first; those up to `passed` are put behind what is there.
    /// Whatever is put behind others comes after them: they need not be looked for at every sample.
    RayHit events[kMostPacketSlices + kPeels];
    int eventCount = 0;
    Floats passed{-kFar};

    Vec cells(Floats k) const {
        return {multiplyAdd(k, advance.x, first.x), multiplyAdd(k, advance.y, first.y),
                multiplyAdd(k, advance.z, first.z)};
    }
    Vec world(Floats k) const { return ray.origin + ray.direction * (enter + (k + phase) * step); }
    /// Part of sample k's segment outside of the holes, and whether k itself is.
    Floats coverage(Floats k) const {
        Floats left(1);
        for (int i = 0; i < holeCount; ++i) left -= coveredBy(holes[i], k);
        return larger(left, Floats(0));
    }
    Mask shows(Floats k) const {
        Mask out = k <= k;
        for (int i = 0; i < holeCount; ++i) out &= !((k > holes[i].enter) & (k < holes[i].exit));
        return out;
    }
    Mask seeThrough() const { return opacity < Floats(kOpaque); }
    /// Puts a colour behind what is there, met at a position in samples, and the events before it.
    void blend(const Vec& over, Floats alpha, Floats at, Mask lanes) {
        if (eventCount > 0) showEvents(at, lanes & (at < Floats(kFar / 2)));
        add(over, alpha, at, lanes);
    }
    /// The events up to a position in samples.
    void showEvents(Floats until, Mask lanes) {
        for (int i = 0; i < eventCount; ++i) {
            const Mask due = lanes & (events[i].at > passed) & (events[i].at <= until);
            if (anyOf(due)) add(events[i].color, events[i].opacity, events[i].at, due);
        }
        passed = choose(lanes, larger(passed, until), passed);
    }
    /// Those that are left, of rays that are not opaque.
    void showEvents() {
        if (eventCount > 0) showEvents(Floats(kFar / 2), meets & seeThrough());
    }

private:
    void add(const Vec& over, Floats alpha, Floats at, Mask lanes) {
        const Floats weight = choose(lanes, (Floats(1) - opacity) * alpha, Floats(0));
        color = color + over * weight;
        opacity += weight;
        pick = choose((pick <= Floats(kNoPick)) & (opacity > Floats(kPickOpacity)), at, pick);
    }
};

inline Vec point(const glm::dvec3& a, const glm::dvec3& x, Floats byX, const glm::dvec3& y, Floats byY) {
    return spreadOut<Floats>(a) + spreadOut<Floats>(x) * byX + spreadOut<Floats>(y) * byY;
}

/// Moves rays into the box where rounding took them further out of it than there are samples around: seen from afar,
/// long data have many cells in the last digit of a distance.
inline void keepWithin(const CastJob& job, Packet& packet) {
    const Floats slack(0.05f);
    for (int axis = 0; axis < 3; ++axis) {
        const Floats least = Floats(job.box.least[axis]) - slack, most = Floats(job.box.most[axis]) + slack;
        Floats &first = packet.first[axis], &advance = packet.advance[axis];
        const Floats enter = multiplyAdd(-packet.phase, advance, first),
                     exit = multiplyAdd(packet.count, advance, enter);
        const Mask inside = (enter >= least) & (enter <= most) & (exit >= least) & (exit <= most);
        if (!anyOf(packet.meets & !inside)) continue;
        const Floats from = clamped(enter, least, most), to = clamped(exit, least, most);
        advance = choose(inside, advance, (to - from) / larger(packet.count, Floats(1)));
        first = choose(inside, first, multiplyAdd(packet.phase, advance, from));
    }
}

/// The rays of the pixels from `begin` on, those below `end`.
inline Packet beginPacket(const CastJob& job, glm::ivec2 begin, glm::ivec2 end) {
    float x[kLanes], y[kLanes], phase[kLanes];
    unsigned within = 0;
    for (int i = 0; i < kLanes; ++i) {
        const int column = begin.x + i % kColumns, row = begin.y + i / kColumns;
        within |= unsigned(column < end.x && row < end.y) << i;
        x[i] = (float(column) + 0.5f + job.jitter.x) / float(job.size.x) * 2 - 1;
        y[i] = (float(row) + 0.5f + job.jitter.y) / float(job.size.y) * 2 - 1;
        phase[i] = 0.5f;
        if (job.jitterStarts) phase[i] += float(startJitter(std::uint32_t(column), std::uint32_t(row), job.pass));
    }
    Packet packet;
    const Floats across = Floats::load(x), up = Floats::load(y);
    packet.ray.origin = point(job.origin, job.originX, across, job.originY, up);
    packet.ray.direction = unit(point(job.direction, job.directionX, across, job.directionY, up));
    SegmentOf<Floats> segment = segmentInBox<Floats>(packet.ray, job.box.halfSize, Floats(job.begin));
    for (const PlacedClip& clip : job.clips)
        if (!clip.hole) segment = commonPart(segment, insideClip(clip, packet.ray));
    packet.meets = maskOf(within) & (segment.enter < segment.exit);
    const Floats length = choose(packet.meets, segment.exit - segment.enter, Floats(0));
    const Vec perCell = packet.ray.direction / spreadOut<Floats>(job.cell);
    packet.count = choose(packet.meets, sampleCount(length, Floats(job.stepVoxels) / lengthOf(perCell)), Floats(0));
    packet.step = length / larger(packet.count, Floats(1));
    packet.enter = choose(packet.meets, segment.enter, Floats(0));
    packet.phase = Floats::load(phase);
    const Vec scale = spreadOut<Floats>(job.box.cellsPerWorld);
    packet.advance = packet.ray.direction * packet.step * scale;
    packet.first = packet.world(Floats(0)) * scale + spreadOut<Floats>(job.box.cellsOffset);
    keepWithin(job, packet);
    for (const PlacedClip& clip : job.clips) {
        if (!clip.hole) continue;
        const SegmentOf<Floats> own = insideClip(clip, packet.ray);
        const auto samples = [&](Floats t) {
            return (t - packet.enter) / larger(packet.step, Floats(1e-20)) - packet.phase;
        };
        const Mask some = own.enter < own.exit;
        packet.holes[packet.holeCount++] = {choose(some, samples(own.enter), Floats(-2e6)),
                                            choose(some, samples(own.exit), Floats(-2e6))};
    }
    return packet;
}

/// Whether rays come near a lens that magnifies.
inline bool meetsMagnifier(const CastJob& job, const Packet& packet) {
    for (std::size_t i = 0; i < job.focus.lenses.size(); ++i) {
        const Floats reach(job.focus.magnifies[i]);
        const Vec away = spreadOut<Floats>(job.focus.lenses[i].center) - packet.ray.origin;
        const Floats along = inner(away, packet.ray.direction);
        if (anyOf(packet.meets & (inner(away, away) - along * along < reach * reach))) return true;
    }
    return false;
}

inline std::size_t placeOf(const CastJob& job, const glm::ivec2& pixel) {
    return std::size_t(pixel.y - job.first.y) * std::size_t(job.rowLength) + std::size_t(pixel.x - job.first.x);
}

inline void storePacket(const CastJob& job, const Packet& packet, glm::ivec2 begin, glm::ivec2 end) {
    float out[4][kLanes];
    packet.color.x.store(out[0]);
    packet.color.y.store(out[1]);
    packet.color.z.store(out[2]);
    packet.opacity.store(out[3]);
    for (int i = 0; i < kLanes; ++i) {
        const int column = begin.x + i % kColumns, row = begin.y + i / kColumns;
        if (column >= end.x || row >= end.y) continue;
        float* pixel = job.picture + placeOf(job, {column, row}) * 4;
        for (int c = 0; c < 4; ++c) pixel[c] += out[c][i] * job.share;
    }
    if (job.pick == nullptr) return;
    const Floats distance = packet.enter + (packet.pick + packet.phase) * packet.step;
    choose(packet.pick <= Floats(kNoPick), Floats(kNowhere), distance).store(out[0]);
    for (int i = 0; i < kLanes; ++i) {
        const int column = begin.x + i % kColumns, row = begin.y + i / kColumns;
        if (column >= end.x || row >= end.y) continue;
        job.pick[placeOf(job, {column, row})] = out[0][i];
    }
}

} // namespace tessera::vis::packet::TESSERA_LANES
