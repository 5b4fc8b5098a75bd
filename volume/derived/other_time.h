#pragma once

#include "volume/field/dataset.h"
#include "volume/field/time_pair.h"

#include <optional>
#include <string>
#include <string_view>

/// References to another time or data set in formulas: at(T, first), at(T, 0.3), at(T, other).
namespace tessera::volume {

/// Other: the values of the other data set (volume/derived/other_source.h) at the same time.
enum class OtherTime { First, Last, Previous, Next, Time, Other };
inline constexpr std::string_view kOtherTimeNames[] = {"first", "last", "previous", "next", "time", "other"};

struct TimeReference {
    OtherTime which = OtherTime::First;
    double time = 0; ///< of OtherTime::Time, in the unit of the data's times
    bool operator==(const TimeReference&) const = default;
};

/// Whether the reference does not depend on the time shown.
inline bool isFixed(const TimeReference& reference) {
    return reference.which <= OtherTime::Last || reference.which == OtherTime::Time;
}

/// The stored times (and weight) that a reference means, seen from the stored time of index `now`; empty if there is
/// none: before the first or after the last one.
std::optional<TimePair> timesOf(const TimeReference& reference, const std::vector<double>& times, int now);

/// Error message for a reference to a channel (< 0: a coordinate) of a data set; "" if it is valid.
std::string timeProblem(const TimeReference& reference, const DatasetInfo& info, int channel);

/// The reference as displayed: "first", "0.3 s".
std::string timeText(const TimeReference& reference, const DatasetInfo& info);

} // namespace tessera::volume
