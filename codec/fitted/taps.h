#pragma once

#include <array>
#include <cstdint>

/// The samples that others are predicted from. A level has twice as many samples along each axis as the next coarser
/// one; the new ones are predicted in three passes, each from all samples known by then, on both sides, and from those
/// of its own pass in rows and slices before. So the samples of a row do not depend on each other. (FORMAT.md "Fitted
/// predictions".)
namespace tessera::codec {

/// AlongZ: slices between those known; AlongY: rows between those known, in all slices; AlongX: columns between those
/// known; Odd: the odd sublattice of BCC at full resolution, from the even one.
enum class Pass : std::uint8_t { AlongZ, AlongY, AlongX, Odd };
inline constexpr int kPasses = 4;
inline constexpr int kMostTaps = 40;

/// A sample relative to the one predicted. z and y in slices and rows of the level; x in columns: of the even ones for
/// AlongZ and AlongY, else column x of the known samples is the last one before the predicted sample.
struct Tap {
    std::int8_t z = 0, y = 0, x = 0;
    bool own = false; ///< of the same pass, in an earlier row
};

/// The first two taps are opposite neighbours, whose mean is a first guess; the differences of the first `near` ones
/// from it are the activity.
struct TapSet {
    std::array<Tap, kMostTaps> taps{};
    int count = 0, near = 0;

    constexpr void add(int z, int y, int x, bool own = false) {
        taps[static_cast<std::size_t>(count++)] = {static_cast<std::int8_t>(z), static_cast<std::int8_t>(y),
                                                   static_cast<std::int8_t>(x), own};
    }
};

constexpr TapSet tapsAlongZ() {
    TapSet set;
    for (const int z : {-1, 1}) set.add(z, 0, 0);
    set.add(0, -2, 0, true), set.add(-2, 0, 0, true);
    for (const int z : {-1, 1})
        for (const int x : {-1, 1}) set.add(z, 0, x);
    for (const int z : {-1, 1})
        for (const int y : {-2, 2}) set.add(z, y, 0);
    set.near = set.count;
    for (const int z : {-1, 1})
        for (const int y : {-2, 2})
            for (const int x : {-1, 1}) set.add(z, y, x);
    for (const int z : {-3, 3}) set.add(z, 0, 0);
    for (const int x : {-1, 1}) set.add(0, -2, x, true);
    for (const int y : {-2, 2}) set.add(-2, y, 0, true);
    return set;
}

constexpr TapSet tapsAlongY() {
    TapSet set;
    for (const int y : {-1, 1}) set.add(0, y, 0);
    set.add(-1, 0, 0, true), set.add(0, -2, 0, true);
    for (const int z : {-1, 1})
        for (const int y : {-1, 1}) set.add(z, y, 0);
    set.near = set.count;
    for (const int z : {-1, 0, 1})
        for (const int y : {-1, 1})
            for (const int x : {-1, 1}) set.add(z, y, x);
    for (const int y : {-3, 3}) set.add(0, y, 0);
    for (const int x : {-1, 1}) set.add(-1, 0, x, true), set.add(0, -2, x, true);
    for (const int y : {-2, 2}) set.add(-1, y, 0, true);
    return set;
}

constexpr TapSet tapsAlongX() {
    TapSet set;
    for (const int x : {0, 1}) set.add(0, 0, x);
    set.add(-1, 0, 0, true), set.add(0, -1, 0, true);
    for (const int x : {0, 1}) set.add(-1, 0, x), set.add(0, -1, x);
    set.near = set.count;
    for (const int x : {0, 1}) set.add(1, 0, x), set.add(0, 1, x);
    for (const int z : {-1, 1})
        for (const int y : {-1, 1})
            for (const int x : {0, 1}) set.add(z, y, x);
    for (const int x : {-1, 2}) set.add(0, 0, x);
    for (const int y : {-1, 0, 1})
        for (const int x : {-1, 1}) set.add(-1, y, x, true);
    for (const int y : {-1, 1}) set.add(-1, y, 0, true);
    for (const int x : {-1, 1}) set.add(0, -1, x, true);
    set.add(0, -2, 0, true), set.add(-2, 0, 0, true);
    return set;
}

constexpr TapSet tapsOdd() {
    TapSet set;
    set.add(0, 0, 0), set.add(1, 1, 1);
    for (const int z : {0, 1})
        for (const int y : {0, 1})
            for (const int x : {0, 1})
                if (z + y + x != 0 && z + y + x != 3) set.add(z, y, x);
    set.add(-1, 0, 0, true), set.add(0, -1, 0, true);
    set.near = set.count;
    for (const int far : {-1, 2})
        for (const int one : {0, 1})
            for (const int other : {0, 1}) {
                set.add(far, one, other);
                set.add(one, far, other);
                set.add(one, other, far);
            }
    for (const int x : {-1, 1}) set.add(-1, 0, x, true), set.add(0, -1, x, true);
    for (const int y : {-1, 1}) set.add(-1, y, 0, true);
    return set;
}

inline constexpr std::array<TapSet, kPasses> kTaps{tapsAlongZ(), tapsAlongY(), tapsAlongX(), tapsOdd()};
static_assert(kTaps[0].count % 2 + kTaps[1].count % 2 + kTaps[2].count % 2 + kTaps[3].count % 2 == 0); // for pairs
constexpr const TapSet& tapsOf(Pass pass) {
    return kTaps[static_cast<std::size_t>(pass)];
}

} // namespace tessera::codec
