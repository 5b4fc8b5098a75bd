#include "vis/model/selection.h"

#include <algorithm>
#include <cmath>

namespace tessera::vis {

bool Selection::active() const {
    return std::any_of(brushes.begin(), brushes.end(), [](const Brush& brush) { return brush.enabled; });
}

double intervalDoi(const BrushInterval& interval, double value) {
    if (std::isnan(value)) return 0;
    const double outside = std::max({interval.lo - value, value - interval.hi, 0.0});
    if (outside == 0) return 1;
    return interval.soft > 0 ? std::max(0.0, 1 - outside / interval.soft) : 0;
}

double degreeOfInterest(const Selection& selection, const std::function<double(const std::string& channel)>& valueOf) {
    if (!selection.active()) return 1;
    const bool all = selection.combine == Combine::All;
    double doi = all ? 1 : 0;
    for (const Brush& brush : selection.brushes) {
        if (!brush.enabled) continue;
        double own = 1;
        for (const BrushInterval& interval : brush.intervals)
            own = std::min(own, intervalDoi(interval, valueOf(interval.channel)));
        if (brush.inverted) own = 1 - own;
        doi = all ? std::min(doi, own) : std::max(doi, own);
    }
    return doi;
}

} // namespace tessera::vis
