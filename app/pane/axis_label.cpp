#include "app/pane/axis_label.h"

#include "app/ui/time_text.h"

#include <algorithm>

namespace tessera::app {

const volume::TimeAxis* timeAxisOf(const Session& session, const volume::DatasetInfo& info) {
    return session.data.timeAxis && info.times.size() == 1 ? &*session.data.timeAxis : nullptr;
}

AxisLabels axisLabels(const Session& session, const volume::DatasetInfo& info) {
    static constexpr const char* kNames[] = {"x", "y", "z"};
    AxisLabels labels;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double extent = info.bounds.size()[int(axis)];
        labels[axis] = {.name = kNames[axis],
                        .unit = suitableLength(info.lengthUnit, extent > 0 ? extent : 1),
                        .map = info.lattice.axes.of[axis]};
    }
    if (const volume::TimeAxis* time = timeAxisOf(session, info))
        labels[std::size_t(time->axis)] = {.name = timeWord(info),
                                           .unit = {info.timeUnit, volume::timePerLength(info, *time)}};
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
