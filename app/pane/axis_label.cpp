#include "app/pane/axis_label.h"

#include "app/ui/time_text.h"

#include <algorithm>

namespace tessera::app {

AxisLabels axisLabels(const Session& session, const volume::DatasetInfo& info) {
    static constexpr const char* kNames[] = {"x", "y", "z"};
    AxisLabels labels;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double extent = info.bounds.size()[int(axis)];
        labels[axis] = {.name = kNames[axis],
                        .unit = suitableLength(info.lengthUnit, extent > 0 ? extent : 1),
                        .map = info.lattice.axes.of[axis]};
    }
    if (const auto time = info.timeAxis()) {
        AxisLabel& label = labels[std::size_t(*time)];
        label.name = timeWord(info);
        label.unit = {info.timeUnit, info.plane->timePerLength};
    }
    for (AxisLabel& label : labels) {
        label.caption = captionOf(session.figure, label.name);
        label.ticks = session.figure.ticks;
    }
    return labels;
}

double tellingLength(const volume::DatasetInfo& info, int axis, glm::dvec3 place, double share) {
    const double ofBox = info.bounds.size()[axis] * share;
    return info.lattice.axes[axis] ? std::min(ofBox, info.lattice.lengthsAt(place)[axis] / 4) : ofBox;
}

} // namespace tessera::app
