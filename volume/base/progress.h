#pragma once

#include "volume/base/error.h"

#include <functional>
#include <stop_token>
#include <string>

namespace tessera {

/// Progress of a long job, and its cancellation. Copyable; both members may be empty.
struct Progress {
    std::function<void(double fraction, const std::string& what)> report;
    std::stop_token stop;

    /// Reports `fraction` in 0..1 and throws Cancelled if a stop was requested.
    void advance(double fraction, const std::string& what = {}) const {
        if (stop.stop_requested()) throw Cancelled();
        if (report) report(fraction, what);
    }

    /// Progress of the section of this job from `begin` to `end`, scaled to 0..1.
    Progress part(double begin, double end) const {
        Progress inner{{}, stop};
        if (report)
            inner.report = [outer = report, begin, end](double fraction, const std::string& what) {
                outer(begin + (end - begin) * fraction, what);
            };
        return inner;
    }
};

} // namespace tessera
