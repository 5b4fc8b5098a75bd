#pragma once

/// Chooses the part of a parameter (volume/field/parts.h) at a position between samples; twin of
/// lib/between_times.glsl.
namespace tessera::volume {

/// Margin by which the coverage of a part must exceed that of a lower one: positions half-way between samples of two
/// parts, which rays often hit, belong to the lower one regardless of rounding.
inline constexpr double kPartMargin = 1.0 / 512;

/// The part whose samples have the largest weight at a position. Presence is decided by all parts together
/// (kPresentCoverage), so parts do not change where a parameter ends.
struct PartChoice {
    int part = 0;
    double coverage = 0; ///< of that part
    double total = 0;    ///< of all parts

    /// Call with the coverage of each part in turn, from part 0 on; true if it is the choice so far.
    bool add(int next, double covered) {
        total += covered;
        if (next > 0 && !(covered > coverage + kPartMargin)) return false;
        part = next;
        coverage = covered;
        return true;
    }
};

} // namespace tessera::volume
