#include "vis/scene/selection_bounds.h"

#include <algorithm>

namespace tessera::vis {

namespace {

constexpr Range kAnything{0, 1};

/// Absent values do not match, so the minimum is 0.
Range boundsOf(const BrushInterval& interval, const std::map<std::string, Range>& ranges) {
    const auto found = ranges.find(interval.channel);
    if (found == ranges.end()) return kAnything;
    const auto [lo, hi] = found->second;
    if (!(lo <= hi)) return {0, 0};
    const bool meets = lo <= interval.hi && hi >= interval.lo;
    return {0, meets ? 1.0 : std::max(intervalDoi(interval, lo), intervalDoi(interval, hi))};
}

Range boundsOf(const Region& region, const std::map<std::string, Range>& ranges) {
    const auto* range = std::get_if<RangeRegion>(&region);
    if (!range) return kAnything;
    Range all{1, 1};
    for (const BrushInterval& interval : range->intervals) {
        const Range one = boundsOf(interval, ranges);
        all = {std::min(all.lo, one.lo), std::min(all.hi, one.hi)};
    }
    return all;
}

/// Whether a value that a region asks for is known to be absent everywhere.
bool isAbsent(const Region& region, const std::map<std::string, Range>& ranges) {
    const auto* range = std::get_if<RangeRegion>(&region);
    return range && std::ranges::any_of(range->intervals, [&](const BrushInterval& interval) {
               const auto found = ranges.find(interval.channel);
               return found != ranges.end() && !(found->second.lo <= found->second.hi);
           });
}

} // namespace

Range interestBounds(const Selection& selection, const std::map<std::string, Range>& ranges) {
    Range all{1, 1};
    bool first = true;
    for (const Brush& brush : selection.brushes) {
        if (!brush.enabled) continue;
        if (first && brush.combine == BrushCombine::Or) all = {0, 0};
        first = false;
        Range one = boundsOf(brush.region, ranges);
        const bool minus = brush.combine == BrushCombine::Minus;
        if (brush.inverted && !minus)
            one = {0, isAbsent(brush.region, ranges) ? 0.0 : 1 - one.lo}; // absent values match neither
        else if (brush.inverted != minus)
            one = {1 - one.hi, 1 - one.lo};
        all = brush.combine == BrushCombine::Or ? Range{std::max(all.lo, one.lo), std::max(all.hi, one.hi)}
                                                : Range{std::min(all.lo, one.lo), std::min(all.hi, one.hi)};
    }
    return all;
}

} // namespace tessera::vis
