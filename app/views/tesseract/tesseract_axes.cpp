#include "app/views/tesseract/tesseract_axes.h"

#include "app/ui/time_text.h"
#include "app/values/place_text.h"
#include "vis/scene/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::app {

std::vector<TesseractAxis> tesseractAxes(const volume::DatasetInfo& info, const TesseractView& view) {
    const auto units = axisUnits(info, glm::length(info.bounds.size()));
    std::vector<TesseractAxis> axes;
    for (int axis = 0; axis < 3; ++axis)
        axes.push_back({.name = info.timeAxis() == axis ? timeWord(info) : std::string(1, "xyz"[axis]),
                        .channel = {},
                        .range = {info.bounds.lo[axis], info.bounds.hi[axis]},
                        .perUnit = units[std::size_t(axis)].perUnit,
                        .unit = units[std::size_t(axis)].name,
                        .even = !info.lattice.axes[axis]});
    const auto parameter = [&](int channel) {
        const volume::Channel known = info.channel(channel);
        axes.push_back({.name = known.name, .channel = channel, .range = info.channelRange(known), .unit = known.unit});
    };
    const auto fourth = view.fourth.empty() ? std::nullopt : info.findChannel(view.fourth);
    if (fourth)
        parameter(*fourth);
    else
        axes.push_back(
            {.name = "t", .channel = {}, .range = {info.times.front(), info.times.back()}, .unit = info.timeUnit});
    for (const std::string& name : view.more)
        if (const auto found = info.findChannel(name); found && axes.size() < std::size_t(vis::kMostAxes))
            parameter(*found);
    return axes;
}

double stretchOf(const TesseractView& view, std::size_t axis) {
    return axis < view.stretch.size() ? std::max(0.01, double(view.stretch[axis])) : 1;
}

vis::PointN halfEdges(const TesseractView& view, const volume::Box& bounds, glm::dvec3 stretch, std::size_t axes) {
    vis::PointN half{};
    std::fill_n(half.begin(), axes, view.cube ? 0.5 : 1.0);
    if (!view.cube) {
        const glm::dvec3 world = vis::worldFrame(bounds, stretch).halfSize;
        const double longest = std::max({world.x, world.y, world.z, 1e-12});
        for (int axis = 0; axis < 3; ++axis) half[std::size_t(axis)] = world[axis] / longest;
    }
    double square = 0;
    for (std::size_t axis = 0; axis < axes; ++axis) {
        half[axis] *= stretchOf(view, axis);
        square += half[axis] * half[axis];
    }
    for (double& each : half) each /= std::max(std::sqrt(square), 1e-12);
    return half;
}

} // namespace tessera::app
