#include "volume/derived/other_time.h"

#include "volume/derived/other_source.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace tessera::volume {

namespace {

std::string text(double value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, 9);
    return {digits.data(), end.ptr};
}

std::string withUnit(const std::string& number, const std::string& unit) {
    return unit.empty() ? number : number + " " + unit;
}

} // namespace

std::optional<TimePair> timesOf(const TimeReference& reference, const std::vector<double>& times, int now) {
    const int last = int(times.size()) - 1;
    const auto stored = [&](int index) -> std::optional<TimePair> {
        if (index < 0 || index > last) return std::nullopt;
        return TimePair{index, index, 0};
    };
    switch (reference.which) {
    case OtherTime::First:
        return stored(0);
    case OtherTime::Last:
        return stored(last);
    case OtherTime::Previous:
        return stored(now - 1);
    case OtherTime::Next:
        return stored(now + 1);
    case OtherTime::Other:
        return stored(now);
    case OtherTime::Time:
        break;
    }
    return timesAround(times, reference.time);
}

namespace {

std::string otherProblem(const DatasetInfo& info, int channel) {
    if (channel < 0) return "only parameters can be taken from the other data set";
    if (otherChannel(info, channel)) return {};
    const bool any = std::any_of(info.parameters.begin(), info.parameters.end(),
                                 [](const Parameter& own) { return own.name.ends_with(kOtherSuffix); });
    const std::string name = info.channel(channel).name;
    return any ? "the other data have no parameter \"" + name + "\"" : "no other data set is open";
}

} // namespace

std::string timeProblem(const TimeReference& reference, const DatasetInfo& info, int channel) {
    if (reference.which == OtherTime::Other) return otherProblem(info, channel);
    const std::string name = info.timeName.empty() ? "time" : info.timeName;
    if (!isFixed(reference) && info.times.size() < 2)
        return "there is no " + std::string(kOtherTimeNames[std::size_t(reference.which)]) + " " + name +
               ": the data have one";
    if (reference.which != OtherTime::Time) return {};
    const double lo = info.times.front(), hi = info.times.back();
    const double tolerance = 1e-9 * std::max(std::abs(lo), std::abs(hi));
    if (reference.time >= lo - tolerance && reference.time <= hi + tolerance) return {};
    const std::string there = lo < hi ? "those of the data, " + text(lo) + " to " + withUnit(text(hi), info.timeUnit)
                                      : "the only one of the data, " + withUnit(text(lo), info.timeUnit);
    return name + " " + withUnit(text(reference.time), info.timeUnit) + " lies outside " + there;
}

std::string timeText(const TimeReference& reference, const DatasetInfo& info) {
    if (reference.which != OtherTime::Time) return std::string(kOtherTimeNames[std::size_t(reference.which)]);
    return withUnit(text(reference.time), info.timeUnit);
}

} // namespace tessera::volume
