#pragma once

/// Which part of a parameter (volume/field/parts.h) a place between samples belongs to: twin of lib/between_times.glsl.
namespace tessera::volume {

/// By how much the coverage of a part must exceed that of a lower one: places half-way between samples of two parts,
/// which rays meet often, belong to the lower one whatever the rounding.
inline constexpr double kPartMargin = 1.0 / 512;

/// The part whose samples carry the most weight at a place. The place is present where those of all parts together
/// carry enough (kPresentCoverage), so parts do not change where a parameter ends.
struct PartChoice {
    int part = 0;
    double coverage = 0; ///< of that part
    double total = 0;    ///< of all parts

    /// The coverage of each part in turn, from part 0 on; true where it is the one chosen so far.
    bool add(int next, double covered) {
        total += covered;
        if (next > 0 && !(covered > coverage + kPartMargin)) return false;
        part = next;
        coverage = covered;
        return true;
    }
};

} // namespace tessera::volume
