#include "volume/bricks/brick_stats.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::volume {

BrickChange accumulated(const BrickChange& first, const BrickChange& second) {
    return {roundedUp(double(first.max) + double(second.max)), roundedUp(double(first.rms) + double(second.rms))};
}

float roundedUp(double value) {
    const auto rounded = static_cast<float>(value);
    return double(rounded) < value ? std::nextafter(rounded, std::numeric_limits<float>::infinity()) : rounded;
}

BrickChange magnitudeChange(std::span<const BrickChange> components) {
    double max = 0, rms = 0;
    for (const BrickChange& component : components) {
        max += double(component.max) * double(component.max);
        rms += double(component.rms) * double(component.rms);
    }
    // A magnitude is rounded to float separately, but only if a component changes.
    constexpr double kRounding = 1 + 1e-6;
    return {roundedUp(std::sqrt(max) * kRounding), roundedUp(std::sqrt(rms) * kRounding)};
}

BrickImportance magnitudeImportance(std::span<const BrickImportance> components) {
    BrickImportance most;
    for (const BrickImportance& component : components)
        most = {std::max(most.importance, component.importance), std::max(most.detail, component.detail)};
    return most;
}

} // namespace tessera::volume
