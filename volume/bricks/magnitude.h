#pragma once

#include "volume/bricks/brick_source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

/// Magnitudes of vectors, for sources that store components but serve DatasetInfo::channels().
namespace tessera::volume {

/// Magnitude of a vector in one brick, the root of the sum of squares of its components, present where all of them are.
/// The bricks have the same size, and there is at least one.
inline BrickSamples magnitude(std::span<const BrickSamples> components) {
    BrickSamples out;
    out.size = components.front().size;
    out.values.resize(components.front().values.size());
    for (std::size_t i = 0; i < out.values.size(); ++i) {
        double square = 0;
        for (const BrickSamples& component : components) square += component.exact(i) * component.exact(i);
        out.values[i] = float(std::sqrt(square));
    }
    for (const BrickSamples& component : components) {
        if (component.present.empty()) continue;
        if (out.present.empty()) out.present.assign(out.values.size(), 1);
        for (std::size_t i = 0; i < out.values.size(); ++i)
            if (component.present[i] == 0) out.present[i] = 0;
    }
    return out;
}
inline BrickSamples magnitude(const BrickSamples& x, const BrickSamples& y, const BrickSamples& z) {
    const BrickSamples components[] = {x, y, z};
    return magnitude(std::span<const BrickSamples>(components));
}

/// Bounds of that magnitude from those of the components, rounded outwards; the real extremes may lie further inside.
/// The least `presentFraction` of the components.
inline BrickStats magnitudeStats(std::span<const BrickStats> components) {
    double low = 0, high = 0;
    BrickStats out;
    for (const BrickStats& component : components) {
        out.presentFraction = std::min(out.presentFraction, component.presentFraction);
        const double a = component.min, b = component.max;
        const double nearest = a <= 0 && b >= 0 ? 0 : std::min(std::abs(a), std::abs(b));
        low += nearest * nearest;
        high += std::max(a * a, b * b);
    }
    if (out.presentFraction == 0) return {std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest(), 0};
    out.min = std::nextafter(float(std::sqrt(low)), 0.0f);
    out.max = std::nextafter(float(std::sqrt(high)), std::numeric_limits<float>::max());
    return out;
}
inline BrickStats magnitudeStats(const BrickStats& x, const BrickStats& y, const BrickStats& z) {
    const BrickStats components[] = {x, y, z};
    return magnitudeStats(std::span<const BrickStats>(components));
}

} // namespace tessera::volume
