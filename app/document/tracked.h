#pragma once

#include <utility>

namespace tessera::app {

/// A part of the description of the data: as it is shown, and as it is being made in the background.
template <class T> struct Tracked {
    T shown{}, making{};

    /// Shown as it is.
    void settle(const T& now) { shown = making = now; }
    /// The job failed or was cancelled: it may be tried again.
    void giveUp() { making = shown; }

    enum class Step {
        None,   ///< already shown, being made, or tried before
        Cancel, ///< what was being made is no longer wanted
        Make,   ///< make it now
    };
    /// What to do for the state `wanted`. `later`: it is still being edited, so do not start yet.
    Step next(const T& wanted, bool later = false) {
        if (wanted == shown) return std::exchange(making, shown) == shown ? Step::None : Step::Cancel;
        if (wanted == making || later) return Step::None;
        making = wanted;
        return Step::Make;
    }
};

} // namespace tessera::app
