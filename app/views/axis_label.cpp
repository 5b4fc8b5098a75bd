#include "app/views/axis_label.h"

#include "app/views/time_text.h"

namespace tessera::app {

AxisLabels axisLabels(const Session& session, const volume::DatasetInfo& info) {
    static constexpr const char* kNames[] = {"x", "y", "z"};
    AxisLabels labels;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double extent = info.bounds.size()[int(axis)];
        labels[axis] = {kNames[axis], suitableLength(info.lengthUnit, extent > 0 ? extent : 1)};
    }
    if (const auto& time = session.data.timeAxis)
        labels[std::size_t(time->axis)] = {timeWord(info), {info.timeUnit, volume::timePerLength(info, *time)}};
    return labels;
}

} // namespace tessera::app
