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

} // namespace

std::string timeValueText(const volume::DatasetInfo& info, double time) {
    const bool between = volume::timesAround(info.times, time).between();
    return formatQuantity(time, info.timeUnit, resolutionOf(info.times) / (between ? 10 : 1));
}

std::string timeWord(const volume::DatasetInfo& info) {
    return info.timeName == kTime || info.timeName.empty() ? "t" : info.timeName;
}

std::string timeText(const volume::DatasetInfo& info, double time) {
    const std::string word = timeWord(info);
    return word + (word == "t" ? " = " : " ") + timeValueText(info, time);
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
        const double earlier = quantity->values[std::size_t(at.earlier)];
        const double value =
            at.between() ? (1 - at.weight) * earlier + at.weight * quantity->values[std::size_t(at.later)] : earlier;
        if (!std::isfinite(value)) continue;
        if (shown++ == most) return text + ", ...";
        if (!text.empty()) text += ", ";
        text += quantity->unit.empty() ? quantity->name + " " + groupedNumber(value)
                                       : groupedNumber(value) + " " + prettyUnit(quantity->unit);
    }
    return text;
}

std::vector<std::string> stateNames(const volume::DatasetInfo& info, const std::vector<double>& times) {
    const bool clock = timeWord(info) == "t";
    std::vector<std::string> own, chosen;
    for (const double time : times)
        own.push_back(info.timeUnit.empty() ? timeText(info, time) : timeValueText(info, time));
    if (!clock && !info.timeUnit.empty()) return own;
    bool distinct = false;
    for (const volume::Quantity& quantity : info.quantities) {
        if (quantity.unit.empty()) continue;
        volume::DatasetInfo alone;
        alone.times = info.times;
        alone.quantities = {quantity};
        std::vector<std::string> names;
        for (const double time : times) names.push_back(quantitiesText(alone, time));
        const std::set<std::string> different(names.begin(), names.end());
        const bool all = different.size() == names.size();
        if (!chosen.empty() || different.contains("") || !(all || clock)) continue;
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
