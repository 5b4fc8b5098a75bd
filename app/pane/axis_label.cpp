#include "app/pane/axis_label.h"

#include "app/ui/time_text.h"

namespace tessera::app {

const volume::TimeAxis* timeAxisOf(const Session& session, const volume::DatasetInfo& info) {
    return session.data.timeAxis && info.times.size() == 1 ? &*session.data.timeAxis : nullptr;
}

AxisLabels axisLabels(const Session& session, const volume::DatasetInfo& info) {
    static constexpr const char* kNames[] = {"x", "y", "z"};
    AxisLabels labels;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double extent = info.bounds.size()[int(axis)];
        labels[axis] = {kNames[axis], suitableLength(info.lengthUnit, extent > 0 ? extent : 1)};
    }
    if (const volume::TimeAxis* time = timeAxisOf(session, info))
        labels[std::size_t(time->axis)] = {timeWord(info), {info.timeUnit, volume::timePerLength(info, *time)}};
    return labels;
}

} // namespace tessera::app
