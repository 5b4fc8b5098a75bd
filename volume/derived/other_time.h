#pragma once

#include "volume/field/dataset.h"
#include "volume/field/time_pair.h"

#include <optional>
#include <string>
#include <string_view>

/// Which values of a parameter are meant beside those of the time shown: at(T, first), at(T, 0.3), at(T, other).
namespace tessera::volume {

/// Other: those of the data set shown beside (volume/derived/other_source.h), at the same time.
enum class OtherTime { First, Last, Previous, Next, Time, Other };
inline constexpr std::string_view kOtherTimeNames[] = {"first", "last", "previous", "next", "time", "other"};

struct TimeReference {
    OtherTime which = OtherTime::First;
    double time = 0; ///< of OtherTime::Time, in the unit of the data's times
    bool operator==(const TimeReference&) const = default;
};

/// Whether it is the same time whichever is shown.
inline bool isFixed(const TimeReference& reference) {
    return reference.which <= OtherTime::Last || reference.which == OtherTime::Time;
}

/// The stored times that make up the one meant, seen from the stored time of index `now`; nothing where there is none:
/// before the first and after the last one.
std::optional<TimePair> timesOf(const TimeReference& reference, const std::vector<double>& times, int now);

/// What is wrong with a reference to a channel (< 0: a coordinate) of a data set; "" if nothing is.
std::string timeProblem(const TimeReference& reference, const DatasetInfo& info, int channel);

/// "first", "0.3 s": as a reader sees it.
std::string timeText(const TimeReference& reference, const DatasetInfo& info);

} // namespace tessera::volume
