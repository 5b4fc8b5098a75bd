#pragma once

#include "vis/packed/skip_map.h"
#include "vis/packet/cast_packet.h"

#include <algorithm>

/// Leaps of packets of rays over blocks of a volume. Only for cast_*.cpp.
namespace tessera::vis::packet::TESSERA_LANES {

inline Ints byteAt(const std::uint8_t* bytes, Ints index, Mask lanes) {
    return gather<1>(bytes, index, lanes) & Ints(255);
}

/// Of blocks whose numbers along each axis are given; these are exact in single precision.
inline Ints blockIndex(const Vec& block, Floats wide, Floats high) {
    return toInts(multiplyAdd(multiplyAdd(block.z, high, block.y), wide, block.x));
}

/// The blocks along the rays of a packet, with all that a leap needs.
class Blocks {
public:
    Blocks(const Packet& packet, const glm::ivec3& count) : wide_(count.x), high_(count.y) {
        const Floats perEdge(1.0f / kFine);
        for (int axis = 0; axis < 3; ++axis) {
            first_[axis] = packet.first[axis] * perEdge;
            advance_[axis] = packet.advance[axis] * perEdge;
            const Floats samples = Floats(1) / larger(magnitude(advance_[axis]), Floats(1e-9));
            samples_[axis] = samples;
            signed_[axis] = choose(advance_[axis] > Floats(0), samples, -samples);
        }
    }

    struct Place {
        Ints index;
        Vec passed; ///< samples since the middle of the block along each axis
    };
    Place at(Floats k) const {
        Vec at, block;
        Place out;
        for (int axis = 0; axis < 3; ++axis) {
            at[axis] = multiplyAdd(k, advance_[axis], first_[axis]);
            block[axis] = roundDown(at[axis]);
        }
        out.index = blockIndex(block, wide_, high_);
        for (int axis = 0; axis < 3; ++axis) out.passed[axis] = (at[axis] - block[axis] - Floats(0.5)) * signed_[axis];
        return out;
    }
    /// Number of samples until the first beyond the cube of n^3 blocks from this one on.
    Floats leap(const Place& place, Floats n) const {
        const Floats beyond = n - Floats(0.5);
        const auto along = [&](int axis) { return multiplyAdd(beyond, samples_[axis], -place.passed[axis]); };
        const Floats inside = smaller(smaller(along(0), along(1)), along(2));
        return larger(Floats(1), roundDown(inside + Floats(1 - 1e-3)));
    }
    Ints octant(int blocks) const {
        const auto bit = [&](int axis, int value) {
            return choose(advance_[axis] > Floats(0), Ints(value * blocks), Ints(0));
        };
        return bit(0, 1) + bit(1, 2) + bit(2, 4);
    }

private:
    Vec first_, advance_;  ///< of samples, in blocks
    Vec samples_, signed_; ///< per block; 1 / advance, not infinite
    Floats wide_, high_;
};

inline constexpr int kRun = 8;      ///< samples between two looks at the map of empty blocks, at least
inline constexpr int kLongRun = 64; ///< and at most
/// Leaps that a packet takes until rays in full space no longer wait for the others: then more of them march together
/// (0.85 to 0.95 of the time for translucent layers, 0.75 for surfaces).
inline constexpr int kLeaps = 8;

/// Leaps over what is empty.
class Skip {
public:
    Skip(const CastJob& job, const Packet& packet)
        : job_(job), packet_(packet), blocks_(packet, job.skip.count),
          octant_(blocks_.octant(job.skip.count.x * job.skip.count.y * job.skip.count.z)) {}

    struct Look {
        Mask full; ///< rays where something may be to draw
        int run;   ///< samples that they take until blocks are looked at again
    };
    /// Moves rays in empty blocks on, until all are in full ones or left behind; `lanes` loses those that leave the
    /// volume.
    Look operator()(Floats& k, Mask& lanes) const {
        Look look{lanes, kRun};
        for (int i = 0; i < kLeaps; ++i) {
            look = leap(k, lanes);
            lanes &= k < packet_.count;
            look.full &= lanes;
            if (!anyOf(lanes & !look.full)) break;
        }
        return look;
    }

private:
    /// One leap of those rays that are in empty blocks.
    Look leap(Floats& k, Mask lanes) const {
        const Blocks::Place place = blocks_.at(k);
        const Ints alike = byteAt(job_.skip.alike, place.index + octant_, lanes);
        const Mask empty = lanes & (alike < Ints(SkipMap::kFull));
        const Floats far = blocks_.leap(place, toFloats(alike & Ints(SkipMap::kMost)));
        k = choose(empty, k + far, k);
        if (anyOf(empty) || job_.skip.absent != nullptr || job_.stepVoxels > 1) return {lanes & !empty, shortRun()};
        return {lanes, std::max(kRun, int(least(choose(lanes, smaller(far, Floats(kLongRun)), Floats(kLongRun)))))};
    }
    /// Short where steps are long, because blocks next to one with absent samples count as such only up to kFine * 2
    /// cells away.
    int shortRun() const {
        return job_.stepVoxels > 1 ? (job_.stepVoxels > 4 ? 1 : int(float(kRun) / job_.stepVoxels)) : kRun;
    }

    const CastJob& job_;
    const Packet& packet_;
    Blocks blocks_;
    Ints octant_;
};

/// Whether a packet's samples may be absent around k.
inline bool someAbsent(const CastJob& job, const Packet& packet, Floats k, Mask live) {
    if (job.skip.absent == nullptr) return false;
    const Vec at = packet.cells(k) * Floats(1.0f / kFine), block(roundDown(at.x), roundDown(at.y), roundDown(at.z));
    const Ints index = blockIndex(block, Floats(job.skip.count.x), Floats(job.skip.count.y));
    return anyOf(live & (Ints(0) < byteAt(job.skip.absent, index, live)));
}

} // namespace tessera::vis::packet::TESSERA_LANES
