#include "app/ui/time_text.h"

#include "app/ui/ticks.h"
#include "volume/field/quantities.h"
#include "volume/field/time_pair.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <set>
#include <vector>

namespace tessera::app {

namespace {

constexpr std::string_view kTime = "time";

/// The largest power of ten, at most 1, of which all times are multiples ("operating point 11", not "11.0"); else a
/// resolution that distinguishes neighbours. 0 for a single time.
double resolutionOf(const std::vector<double>& times) {
    if (times.size() < 2) return 0;
    double step = 1;
    for (int digits = 0; digits < 7; ++digits, step /= 10) {
        const auto fits = [step](double time) {
            const double parts = time / step;
            return std::abs(parts - std::round(parts)) <= 1e-6 && std::abs(parts) < 1e9;
        };
        if (std::ranges::all_of(times, fits)) return step;
    }
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < times.size(); ++i) least = std::min(least, times[i] - times[i - 1]);
    return least / 10;
}

/// Times as texts with their unit, whose resolution is that of all times of the data.
class TimeValues {
public:
    explicit TimeValues(const volume::DatasetInfo& info) : info_(info), resolution_(resolutionOf(info.times)) {}
    std::string text(double time) const {
        const bool between = volume::timesAround(info_.times, time).between();
        return formatQuantity(time, info_.timeUnit, resolution_ / (between ? 10 : 1));
    }
    /// With the word for the axis of times.
    std::string withWord(double time) const {
        const std::string word = timeWord(info_);
        return word + (word == "t" ? " = " : " ") + text(time);
    }

private:
    const volume::DatasetInfo& info_;
    double resolution_;
};

/// The value of a quantity at or between stored times, with its unit; "" where it is not known.
std::string quantityText(const volume::Quantity& quantity, const volume::TimePair& at) {
    const double earlier = quantity.values[std::size_t(at.earlier)];
    const double value =
        at.between() ? (1 - at.weight) * earlier + at.weight * quantity.values[std::size_t(at.later)] : earlier;
    if (!std::isfinite(value)) return {};
    return quantity.unit.empty() ? quantity.name + " " + groupedNumber(value)
                                 : groupedNumber(value) + " " + prettyUnit(quantity.unit);
}

} // namespace

std::string timeValueText(const volume::DatasetInfo& info, double time) {
    return TimeValues(info).text(time);
}

std::string timeWord(const volume::DatasetInfo& info) {
    return info.timeName == kTime || info.timeName.empty() ? "t" : info.timeName;
}

std::string timeText(const volume::DatasetInfo& info, double time) {
    return TimeValues(info).withWord(time);
}

std::string timeTitle(const volume::DatasetInfo& info) {
    return titleWithUnit(timeWord(info), info.timeUnit);
}

std::string groupedNumber(double value) {
    const double magnitude = std::abs(value);
    if (!(magnitude >= 1e4 && magnitude < 1e9)) {
        char text[32];
        std::snprintf(text, sizeof text, "%.5g", value);
        return formatNumber(std::strtod(text, nullptr)); // without trailing zeros
    }
    return (value < 0 ? "-" : "") + formatCount(std::round(magnitude));
}

std::string quantitiesText(const volume::DatasetInfo& info, double time, std::string_view first, std::size_t most) {
    std::vector<const volume::Quantity*> order;
    for (const volume::Quantity& quantity : info.quantities) order.push_back(&quantity);
    std::ranges::stable_partition(order, [first](const volume::Quantity* each) { return each->name == first; });
    const volume::TimePair at = volume::timesAround(info.times, time);
    std::string text;
    std::size_t shown = 0;
    for (const volume::Quantity* quantity : order) {
        const std::string own = quantityText(*quantity, at);
        if (own.empty()) continue;
        if (shown++ == most) return text + ", ...";
        text += (text.empty() ? "" : ", ") + own;
    }
    return text;
}

std::vector<std::string> stateNames(const volume::DatasetInfo& info, const std::vector<double>& times) {
    const bool clock = timeWord(info) == "t";
    std::vector<std::string> own, chosen;
    const TimeValues values(info);
    for (const double time : times) own.push_back(info.timeUnit.empty() ? values.withWord(time) : values.text(time));
    if (!clock && !info.timeUnit.empty()) return own;
    bool distinct = false;
    for (const volume::Quantity& quantity : info.quantities) {
        if (quantity.unit.empty() || !chosen.empty()) continue;
        std::vector<std::string> names;
        for (const double time : times) names.push_back(quantityText(quantity, volume::timesAround(info.times, time)));
        const std::set<std::string> different(names.begin(), names.end());
        const bool all = different.size() == names.size();
        if (different.contains("") || !(all || clock)) continue;
        chosen = names;
        distinct = all;
    }
    for (std::size_t i = 0; i < chosen.size(); ++i)
        own[i] = distinct && info.timeUnit.empty() ? chosen[i] : own[i] + ", " + chosen[i];
    return own;
}

std::string stateText(const volume::DatasetInfo& info, double time, std::string_view first) {
    const std::string quantities = quantitiesText(info, time, first);
    return timeText(info, time) + (quantities.empty() ? "" : "   " + quantities);
}

} // namespace tessera::app
