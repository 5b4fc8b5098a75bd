#pragma once

#include "vis/lanes/lanes.h"
#include "vis/packed/packet_volume.h"
#include "vis/packet/cast_cubic.h"
#include "vis/packet/cast_job.h"
#include "vis/scene/lens_bend.h"
#include "volume/base/vectors.h"
#include "volume/reconstruct/part_choice.h"
#include "volume/reconstruct/present_coverage.h"

/// Packets of samples read from a PacketVolume: reconstruction, classification. Only for cast_*.cpp, and
/// for measuring.
namespace tessera::vis::packet::TESSERA_LANES {

using Vec = glm::vec<3, Floats>;
using Found = volume::FoundValue<Floats, Mask>;

using tessera::choose;

inline Floats mix(Floats a, Floats b, Floats share) {
    return multiplyAdd(share, b - a, a);
}

/// Positions in cells, times 2^16.
struct Fixed {
    Ints x, y, z;
    Fixed& operator+=(const Fixed& way) {
        x += way.x;
        y += way.y;
        z += way.z;
        return *this;
    }
};
inline Fixed fixedOf(const Vec& cells) {
    const Floats one(1 << 16);
    return {toInts(cells.x * one), toInts(cells.y * one), toInts(cells.z * one)};
}
/// On BCC, in cells of the odd sublattice.
inline Fixed oddOf(const Fixed& at) {
    const Ints half(1 << 15);
    return {at.x - half, at.y - half, at.z - half};
}

/// Where the samples around a position of one sublattice lie (pairs), and the fractions times 2^15, those of x and z
/// in both halves of a lane, of y with one minus it.
template <bool Many> struct Corner {
    Spread<Many> place;
    Ints x, y, z;
};
/// Weights of two neighbours in 15 bits, in one lane.
inline Ints pairWeights(Floats f) {
    const Ints high = toInts(multiplyAdd(f, Floats(kQuantum), Floats(0.5)));
    return (high << 16) - high + Ints(kQuantum);
}

/// Index of the pair of a cell of the volume.
[[gnu::always_inline]] inline Ints pairAt(const VolumeView& volume, const Fixed& at) {
    const auto times = [](Ints p, int factor) { return dotPairs(p, Ints(factor << 16)); }; // of cells
    return (at.x >> 16) + times(at.y, kRow) + times(at.z, kSlice) + (at.x >> 20) * Ints(volume.perBrick.x) +
           (at.y >> 20) * Ints(volume.perBrick.y) + (at.z >> 20) * Ints(volume.perBrick.z);
}

template <bool Many = false>
[[gnu::always_inline]] inline Corner<Many> cornerAt(const VolumeView& volume, const Fixed& at, Mask lanes) {
    return {spread<Many>(pairAt(volume, at), lanes), lowHalves(at.x), lowHalves(at.y) ^ Ints(kQuantum),
            lowHalves(at.z)};
}

/// The interpolated 15-bit samples, times kQuantum.
template <bool Many>
[[gnu::always_inline]] inline Floats trilinear(const std::int16_t* samples, const Corner<Many>& corner, Mask lanes) {
    const auto slice = [&](int more) __attribute__((always_inline)) {
        const IntPair pairs = loadPairs<4>(samples + 2 * more, corner.place, lanes);
        return mixPairs(pairs.low, pairs.high, corner.x);
    };
    return toFloats(dotPairs(mixPairs(slice(0), slice(kSlice), corner.z), corner.y));
}

template <bool Many>
[[gnu::always_inline]] inline Floats trilinear(const float* samples, const Corner<Many>& corner, Mask lanes) {
    const auto share = [](Ints fraction) { return toFloats(fraction >> 16) * Floats(1.0 / (1 << 15)); };
    const Floats x = share(corner.x), y = share(corner.y), z = share(corner.z);
    const auto column = [&](int more) __attribute__((always_inline)) {
        const IntPair pair = loadPairs<8>(samples + 2 * more, corner.place, lanes);
        return mix(sameBits(pair.low), sameBits(pair.high), y);
    };
    const Floats low = mix(column(0), column(1), x), high = mix(column(kSlice), column(kSlice + 1), x);
    return mix(low, high, z);
}

/// Where the data are that a position shows, behind magnifying lenses; both in cells.
inline Vec bent(const CastJob& job, const Vec& cells) {
    const Vec offset = spreadOut<Floats>(job.box.cellsOffset), scale = spreadOut<Floats>(job.box.cellsPerWorld);
    return bentBy<Floats>(job.focus.lenses, (cells - offset) / scale, job.box.halfSize) * scale + offset;
}

/// Reconstructs samples; Bcc and Exact as in PacketVolume. Twin: volume/reconstruct/reconstruct.h.
template <bool Bcc, bool Exact> struct Reader {
    static constexpr float kUnit = (Exact ? 1.0f : 1.0f / kQuantum) * (Bcc ? 0.5f : 1.0f);
    const VolumeView& volume;
    bool masked;                    ///< some samples may be absent here
    const CastJob* bends = nullptr; ///< whose lenses bend what is read, except in next() and row()

    [[gnu::noinline]] Found operator()(const Vec& cells, Mask lanes) const {
        const Vec at = bends != nullptr ? bent(*bends, cells) : cells;
        if (volume.partCount > 0) return ofParts(fixedOf(at), lanes).found;
        return volume.labels ? nearest(at, lanes) : next(fixedOf(at), lanes);
    }
    /// The parts that places belong to, whether present or absent.
    [[gnu::noinline]] Floats part(const Vec& cells, Mask lanes) const {
        if (volume.partCount == 0) return Floats(0);
        return ofParts(fixedOf(bends != nullptr ? bent(*bends, cells) : cells), lanes).part;
    }
    /// Of a single part.
    Reader ofPart(int part) const {
        const VolumeView& own = volume.parts[part];
        return {own, own.present != nullptr, bends};
    }
    /// The same within loops over samples.
    [[gnu::always_inline]] Found next(const Fixed& at, Mask lanes) const {
        return volume.cubic ? cubic(at, lanes) : valueOf(around(at, lanes), lanes);
    }
    /// The same of `Count` samples, `way` apart; `at` moves beyond them. First come the places of all, then their
    /// values: so the reads of several samples overlap (1.3 times as fast as one sample after another).
    template <int Count>
    [[gnu::always_inline]] void row(Fixed& at, const Fixed& way, const Mask* lanes, Found* found) const {
        if (volume.cubic) {
            for (int i = 0; i < Count; ++i, at += way) found[i] = cubic(at, lanes[i]);
            return;
        }
        constexpr bool kMany = Count > 2;
        Around<kMany> places[Count];
        for (int i = 0; i < Count; ++i) {
            places[i] = around<kMany>(at, lanes[i]);
            at += way;
        }
        for (int i = 0; i < Count; ++i) found[i] = valueOf(places[i], lanes[i]);
    }
    /// The same at any places.
    template <int Count> [[gnu::always_inline]] void row(const Fixed* at, const Mask* lanes, Found* found) const {
        if (volume.cubic) {
            for (int i = 0; i < Count; ++i) found[i] = cubic(at[i], lanes[i]);
            return;
        }
        constexpr bool kMany = Count > 2;
        Around<kMany> places[Count];
        for (int i = 0; i < Count; ++i) places[i] = around<kMany>(at[i], lanes[i]);
        for (int i = 0; i < Count; ++i) found[i] = valueOf(places[i], lanes[i]);
    }
    /// The value as far as samples have any weight, see reference::Samples::continued; present where they have.
    [[gnu::noinline]] Found continued(const Vec& cells, Mask lanes) const {
        if (!masked || volume.labels) return (*this)(cells, lanes);
        Floats sum(0), coverage(0);
        addAt(fixedOf(bends != nullptr ? bent(*bends, cells) : cells), lanes, sum, coverage);
        const Floats weight = coverage * Floats(1.0f / kQuantum / kQuantum);
        return {sum * Floats(Exact ? 1.0f : 1.0f / kQuantum) / larger(weight, Floats(1e-9)),
                lanes & (weight > Floats(0))};
    }

    /// The mean of what samples around a position are classified as, `of(value)`, four numbers. Twin:
    /// reference::Samples::blended.
    struct Mean {
        glm::vec<4, Floats> mean;
        Mask present;
    };
    template <class Of> [[gnu::noinline]] Mean meanOf(const Vec& cells, Mask lanes, const Of& of) const {
        const Fixed at = fixedOf(bends != nullptr ? bent(*bends, cells) : cells);
        volume::PartChoiceOf<Floats, Mask> choice;
        glm::vec<4, Floats> best(Floats(0), Floats(0), Floats(0), Floats(0));
        for (int i = 0; i < (volume.partCount > 0 ? volume.partCount : 1); ++i) {
            glm::vec<4, Floats> sum(Floats(0), Floats(0), Floats(0), Floats(0));
            Floats coverage(0);
            const Reader own = volume.partCount > 0 ? ofPart(i) : *this;
            own.addCorners(at, 0, lanes, of, sum, coverage);
            if constexpr (Bcc) own.addCorners(oddOf(at), volume.oddOffset, lanes, of, sum, coverage);
            const Mask better = choice.add(i, coverage);
            for (int c = 0; c < 4; ++c) best[c] = choose(better, sum[c], best[c]);
        }
        return {best * (Floats(1) / larger(choice.coverage, Floats(1e-9))),
                lanes & (choice.total >= Floats(volume::kPresentCoverage))};
    }

private:
    /// The eight samples around a position of one sublattice, of a volume with samples of its own.
    template <class Of>
    void addCorners(const Fixed& at, int offset, Mask lanes, const Of& of, glm::vec<4, Floats>& sum,
                    Floats& coverage) const {
        const Spread<false> place = spread(pairAt(volume, at), lanes);
        const auto share = [](Ints along) { return toFloats(along & Ints(0xffff)) * Floats(1.0 / (1 << 16)); };
        const Floats x = share(at.x), y = share(at.y), z = share(at.z);
        const auto halves = [&](const std::int16_t* samples, int slice, Floats* out) { // of x, then of y
            const IntPair pairs = loadPairs<4>(samples + 2 * (offset + slice * kSlice), place, lanes);
            const Ints low(0xffff);
            out[0] = toFloats(pairs.low & low);
            out[1] = toFloats(pairs.low >> 16);
            out[2] = toFloats(pairs.high & low);
            out[3] = toFloats(pairs.high >> 16);
        };
        for (int slice = 0; slice < 2; ++slice) {
            Floats value[4], weight[4];
            if constexpr (Exact) {
                for (int column = 0; column < 2; ++column) {
                    const IntPair pair =
                        loadPairs<8>(volume.floats + 2 * (offset + slice * kSlice + column), place, lanes);
                    value[2 * column] = sameBits(pair.low);
                    value[2 * column + 1] = sameBits(pair.high);
                }
            } else {
                halves(volume.shorts, slice, value);
            }
            if (masked) halves(volume.present, slice, weight);
            for (int i = 0; i < 4; ++i) {
                Floats part = (slice == 0 ? Floats(1) - z : z) * (i < 2 ? Floats(1) - x : x) *
                              ((i & 1) == 0 ? Floats(1) - y : y) * Floats(Bcc ? 0.5f : 1.0f);
                Floats own = value[i];
                if (masked) { // between two times samples have the weight of those at which they are present
                    const Floats there = weight[i] * Floats(1.0f / kQuantum);
                    own = own / larger(there, Floats(1e-9));
                    part = choose(there >= Floats(volume::kPresentCoverage), part, Floats(0));
                }
                sum = sum + of(own, lanes) * part;
                coverage += part;
            }
        }
    }
    /// Twin: reference::Samples::read.
    struct OfParts {
        Found found;
        Floats part;
    };
    OfParts ofParts(const Fixed& at, Mask lanes) const {
        volume::PartChoiceOf<Floats, Mask> choice;
        Floats best(0);
        for (int i = 0; i < volume.partCount; ++i) {
            const Reader own = ofPart(i);
            Floats sum(0), coverage(0);
            own.addAt(at, lanes, sum, coverage);
            const Floats covered =
                own.masked ? coverage * Floats((Bcc ? 0.5f : 1.0f) / kQuantum / kQuantum) : Floats(1);
            best = choose(choice.add(i, covered), sum, best);
        }
        return {{best * Floats(kUnit) / larger(choice.coverage, Floats(1e-9)),
                 lanes & (choice.total >= Floats(volume::kPresentCoverage))},
                choice.part};
    }

    /// Twin: volume::nearest.
    Found nearest(const Vec& cells, Mask lanes) const {
        Ints best(0);
        Floats distance(0);
        for (int grid = 0; grid < (Bcc ? 2 : 1); ++grid) {
            const Vec in = grid == 1 ? cells - Floats(0.5) : cells;
            Vec at;
            for (int axis = 0; axis < 3; ++axis) at[axis] = roundDown(in[axis] + Floats(0.5));
            const Floats own = inner(at - in, at - in);
            const Fixed place{toInts(at.x) << 16, toInts(at.y) << 16, toInts(at.z) << 16};
            const Ints index = pairAt(volume, place) + Ints(grid * volume.oddOffset);
            const Mask nearer = grid == 0 ? maskOf(~0u) : own < distance;
            best = choose(nearer, index, best);
            distance = choose(nearer, own, distance);
        }
        const Ints low(0xffff);
        Found found{Floats(0), lanes};
        if constexpr (Exact)
            found.value = sameBits(gather<8>(volume.floats, best, lanes));
        else
            found.value = toFloats(gather<4>(volume.shorts, best, lanes) & low);
        if (masked) found.present = lanes & (Ints(0) < (gather<4>(volume.present, best, lanes) & low));
        return found;
    }

    /// A position in each sublattice.
    template <bool Many> struct Around { Corner<Many> grids[Bcc ? 2 : 1]; };
    template <bool Many = false> [[gnu::always_inline]] Around<Many> around(const Fixed& at, Mask lanes) const {
        Around<Many> out;
        out.grids[0] = cornerAt<Many>(volume, at, lanes);
        if constexpr (Bcc) out.grids[1] = cornerAt<Many>(volume, oddOf(at), lanes);
        return out;
    }
    template <bool Many> [[gnu::always_inline]] Found valueOf(const Around<Many>& at, Mask lanes) const {
        Floats sum(0), coverage(0);
        add(at, lanes, sum, coverage);
        return valueOf(sum, coverage, lanes);
    }
    [[gnu::always_inline]] Found valueOf(Floats sum, Floats coverage, Mask lanes) const {
        if (!masked) return {sum * Floats(kUnit), lanes};
        const Floats covered = coverage * Floats((Bcc ? 0.5f : 1.0f) / kQuantum / kQuantum);
        const Mask present = lanes & (covered >= Floats(volume::kPresentCoverage));
        return {sum * Floats(kUnit) / larger(covered, Floats(1e-9)), present};
    }
    /// By cubic B-splines: cast_cubic.h.
    [[gnu::noinline]] Found cubic(const Fixed& at, Mask lanes) const {
        Floats sum(0), coverage(0);
        addCubic(at, lanes, sum, coverage);
        return valueOf(sum, coverage, lanes);
    }
    void addCubic(const Fixed& at, Mask lanes, Floats& sum, Floats& coverage) const {
        addCubic(at, 0, lanes, sum, coverage);
        if constexpr (Bcc) addCubic(oddOf(at), volume.oddOffset, lanes, sum, coverage);
    }
    void addCubic(const Fixed& at, int offset, Mask lanes, Floats& sum, Floats& coverage) const {
        const CubicReads x = cubicReads(at.x, volume.cells.x), y = cubicReads(at.y, volume.cells.y),
                         z = cubicReads(at.z, volume.cells.z);
        for (int n = 0; n < 8; ++n) {
            const auto place = [&](const CubicReads& of, int bit) { return (n & bit) != 0 ? of.high : of.low; };
            const auto share = [&](const CubicReads& of, int bit) {
                return (n & bit) != 0 ? of.share : Floats(1) - of.share;
            };
            const Fixed read{place(x, 1), place(y, 2), place(z, 4)};
            const Floats weight = share(x, 1) * share(y, 2) * share(z, 4);
            Floats own(0), covered(0);
            add(cornerAt(volume, read, lanes), offset, lanes, own, covered);
            sum = multiplyAdd(weight, own, sum);
            coverage = multiplyAdd(weight, covered, coverage);
        }
    }
    void addAt(const Fixed& at, Mask lanes, Floats& sum, Floats& coverage) const {
        if (volume.cubic)
            addCubic(at, lanes, sum, coverage);
        else
            add(around(at, lanes), lanes, sum, coverage);
    }
    template <bool Many>
    [[gnu::always_inline]] void add(const Around<Many>& at, Mask lanes, Floats& sum, Floats& coverage) const {
        add(at.grids[0], 0, lanes, sum, coverage);
        if constexpr (Bcc) add(at.grids[1], volume.oddOffset, lanes, sum, coverage);
    }
    template <bool Many>
    [[gnu::always_inline]] void add(const Corner<Many>& corner, int offset, Mask lanes, Floats& sum,
                                    Floats& coverage) const {
        if constexpr (Exact)
            sum += trilinear(volume.floats + 2 * offset, corner, lanes);
        else
            sum += trilinear(volume.shorts + 2 * offset, corner, lanes);
        if (masked) coverage += trilinear(volume.present + 2 * offset, corner, lanes);
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
inline Floats tableValue(const std::int32_t* table, const TablePlace& at, int component, Mask lanes) {
    return toFloats(dotPairs(gather<4>(table + component, at.entry, lanes), at.weights)) *
           Floats(1.0f / kQuantum / kQuantum);
}
/// Whether entries around places may have opacity.
inline Mask mayShow(const LayerView& layer, Floats place) {
    return bitAt(layer.shows, toInts(clamped(place, Floats(0), Floats(1)) * Floats(kShowBins - 1)));
}
/// Colour, times kQuantum, and extinction; `entry` of the packed table, not rounded.
struct Medium {
    Vec color;
    Floats extinction;
};
[[gnu::always_inline]] inline Medium mediumAt(const LayerView& layer, Floats entry, Mask lanes) {
    const Floats within = clamped(entry, Floats(0), Floats(kPackedEntries - 1));
    const IntPair packed = gatherPairs<8>(layer.packed, toInts(within), lanes);
    const Ints low(0xffff), bits = (packed.high >> (16 - kExtinctionShift)) & Ints(kQuantum << kExtinctionShift);
    const Floats extinction = sameBits(bits + Ints(kExtinctionLeast << 23));
    return {{toFloats(packed.low & low), toFloats(packed.low >> 16), toFloats(packed.high & low)},
            choose(Ints(0) < bits, extinction, Floats(0))};
}
inline Floats opacityAt(const LayerView& layer, const TablePlace& at, Mask lanes) {
    return tableValue(layer.table, at, 3, lanes) * Floats(layer.opacityScale);
}
inline Vec colorAt(const std::int32_t* table, const TablePlace& at, Mask lanes) {
    return {tableValue(table, at, 0, lanes), tableValue(table, at, 1, lanes), tableValue(table, at, 2, lanes)};
}

} // namespace tessera::vis::packet::TESSERA_LANES
