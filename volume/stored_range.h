#pragma once

#include "volume/field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace tessera::volume {

/// Range of the present samples of a frame as stored numbers, gathered part by part, and whether any part has a mask.
struct StoredExtent {
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    bool masked = false;

    void add(const Field& part) {
        masked = masked || part.mask;
        dispatch(part.type, [&]<class T>(T) {
            const auto stored = part.as<T>();
            T least = std::numeric_limits<T>::max(), most = std::numeric_limits<T>::lowest();
            for (std::size_t i = 0; i < stored.size(); ++i) {
                if (!part.present(i)) continue;
                least = std::min(least, stored[i]);
                most = std::max(most, stored[i]);
            }
            lo = std::min(lo, double(least));
            hi = std::max(hi, double(most));
        });
    }
};

/// Range that results are held to: kernels with negative weights overshoot at steps, and a concentration below 0 or a
/// value outside the known range helps nobody.
template <class T> struct StoredRange {
    double lo = 0, hi = 0;

    explicit StoredRange(const StoredExtent& extent)
        : lo(extent.lo), hi(std::max(extent.lo, extent.hi)) {} // nothing present: never used
    explicit StoredRange(const Field& source) : StoredRange(extentOf(source)) {}

    T store(double value) const {
        if constexpr (std::is_floating_point_v<T>)
            return static_cast<T>(std::clamp(value, lo, hi));
        else
            return static_cast<T>(std::nearbyint(std::clamp(value, lo, hi)));
    }

private:
    static StoredExtent extentOf(const Field& source) {
        StoredExtent extent;
        extent.add(source);
        return extent;
    }
};

} // namespace tessera::volume
