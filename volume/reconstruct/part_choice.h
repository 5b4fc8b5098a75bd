#pragma once

#include "volume/base/numbers.h"

/// Chooses the part of a parameter (volume/field/parts.h) at a position between samples; twin of
/// lib/sampling/between_times.glsl.
namespace tessera::volume {

/// Margin by which the coverage of a part must exceed that of a lower one: positions half-way between samples of two
/// parts, which rays often hit, belong to the lower one regardless of rounding.
inline constexpr double kPartMargin = 1.0 / 512;

/// The part whose samples have the largest weight at a position, or at a packet of them (volume/base/numbers.h).
/// Presence is decided by all parts together (kPresentCoverage), so parts do not change where a parameter ends.
template <class N, class Yes> struct PartChoiceOf {
    N part{0};     ///< a whole number
    N coverage{0}; ///< of that part
    N total{0};    ///< of all parts

    /// Call with the coverage of each part in turn, from part 0 on; true if it is the choice so far.
    Yes add(int next, N covered) {
        total += covered;
        const Yes better = (covered > coverage + N(kPartMargin)) | (N(next) <= N(0));
        part = choose(better, N(next), part);
        coverage = choose(better, covered, coverage);
        return better;
    }
};
using PartChoice = PartChoiceOf<double, bool>;

} // namespace tessera::volume
