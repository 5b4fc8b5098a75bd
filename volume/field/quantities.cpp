#include "volume/field/quantities.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::volume {

namespace {
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
}

double valueAt(std::span<const double> times, std::span<const double> values, double time) {
    if (times.empty() || !(time >= times.front() && time <= times.back())) return kUnknown;
    const auto after = std::ranges::lower_bound(times, time);
    const auto at = static_cast<std::size_t>(after - times.begin());
    if (*after == time) return values[at];
    const double share = (time - times[at - 1]) / (times[at] - times[at - 1]);
    return (1 - share) * values[at - 1] + share * values[at];
}

std::optional<int> findQuantity(const DatasetInfo& info, std::string_view name) {
    const auto found = std::ranges::find(info.quantities, name, &Quantity::name);
    if (found == info.quantities.end()) return std::nullopt;
    return static_cast<int>(found - info.quantities.begin());
}

std::vector<Quantity> atTimes(const std::vector<Quantity>& quantities, std::span<const double> times,
                              std::span<const double> wanted) {
    std::vector<Quantity> out;
    for (const Quantity& quantity : quantities) {
        Quantity& at = out.emplace_back(Quantity{quantity.name, quantity.unit, {}});
        for (const double time : wanted) at.values.push_back(valueAt(times, quantity.values, time));
    }
    return out;
}

std::vector<Quantity> joined(const std::vector<Quantity>& old, std::size_t oldTimes, const std::vector<Quantity>& added,
                             std::size_t addedTimes) {
    std::vector<Quantity> out = old;
    for (Quantity& quantity : out) quantity.values.resize(oldTimes + addedTimes, kUnknown);
    for (const Quantity& quantity : added) {
        auto known = std::ranges::find(out, quantity.name, &Quantity::name);
        if (known == out.end())
            known =
                out.insert(known, {quantity.name, quantity.unit, std::vector<double>(oldTimes + addedTimes, kUnknown)});
        std::ranges::copy(quantity.values, known->values.begin() + std::ptrdiff_t(oldTimes));
    }
    return out;
}

void setQuantity(DatasetInfo& info, Quantity quantity) {
    if (quantity.values.size() != info.times.size())
        throw Error("the quantity " + quantity.name + " has " + std::to_string(quantity.values.size()) +
                    " values for " + std::to_string(info.times.size()) + " times");
    if (const auto known = findQuantity(info, quantity.name))
        info.quantities[std::size_t(*known)] = std::move(quantity);
    else
        info.quantities.push_back(std::move(quantity));
}

} // namespace tessera::volume
