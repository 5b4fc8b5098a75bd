#pragma once

#include "volume/base/describe.h"
#include "volume/field/field.h"
#include "volume/field/part_masks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace tessera::volume {

/// Range of the present samples of a frame as stored numbers, gathered part by part, and whether any part has a mask.
struct StoredExtent {
    static constexpr std::size_t kNumbers = kMostParts + 1;
    static constexpr double kNone = std::numeric_limits<double>::infinity();
    double lo = kNone, hi = -kNone;
    bool masked = false;
    std::array<Range, kNumbers> byPart; ///< of the samples of each number that masks have (volume/field/part_masks.h)

    StoredExtent() { byPart.fill({kNone, -kNone}); }

    void add(const Field& part) {
        masked = masked || part.mask;
        dispatch(part.type, [&]<class T>(T) {
            const auto stored = part.as<T>();
            std::array<T, kNumbers> least, most;
            least.fill(std::numeric_limits<T>::max());
            most.fill(std::numeric_limits<T>::lowest());
            const auto take = [&](T value, std::size_t number) {
                least[number] = std::min(least[number], value);
                most[number] = std::max(most[number], value);
            };
            if (part.mask)
                for (std::size_t i = 0; i < stored.size(); ++i) take(stored[i], (*part.mask)[i] % kNumbers);
            else
                for (const T value : stored) take(value, 1);
            for (std::size_t n = 1; n < kNumbers; ++n) {
                if (!(least[n] <= most[n])) continue;
                lo = std::min(lo, double(least[n]));
                hi = std::max(hi, double(most[n]));
                byPart[n] = {std::min(byPart[n].lo, double(least[n])), std::max(byPart[n].hi, double(most[n]))};
            }
        });
    }

    void add(const StoredExtent& more) {
        lo = std::min(lo, more.lo), hi = std::max(hi, more.hi);
        masked = masked || more.masked;
        for (std::size_t n = 0; n < kNumbers; ++n)
            byPart[n] = {std::min(byPart[n].lo, more.byPart[n].lo), std::max(byPart[n].hi, more.byPart[n].hi)};
    }

    /// Of what is present where masks have this number.
    Range of(std::size_t number) const {
        const Range& own = byPart[number % kNumbers];
        return own.lo <= own.hi ? own : Range{lo, std::max(lo, hi)};
    }
};

/// Range that results are held to: kernels with negative weights overshoot at steps, and a concentration below 0 or a
/// value outside the known range of its part helps nobody.
template <class T> struct StoredRange {
    explicit StoredRange(const StoredExtent& extent) {
        for (std::size_t n = 0; n < ranges_.size(); ++n) ranges_[n] = extent.of(n); // nothing present: never used
    }

    /// `number`: that of the mask where the result lies.
    T store(double value, std::size_t number = 1) const {
        const Range& range = ranges_[number % ranges_.size()];
        if constexpr (std::is_floating_point_v<T>)
            return static_cast<T>(std::clamp(value, range.lo, range.hi));
        else
            return static_cast<T>(std::nearbyint(std::clamp(value, range.lo, range.hi)));
    }

private:
    std::array<Range, StoredExtent::kNumbers> ranges_;
};

} // namespace tessera::volume
