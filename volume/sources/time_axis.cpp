#include "volume/sources/time_axis.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/reconstruct/probe.h"
#include "volume/resample/series.h"

#include <cmath>
#include <glm/common.hpp>

namespace tessera::volume {

namespace {

constexpr const char *kClock = "time", *kSecondClock = "time along";

/// The resulting grid: two axes of the source, with time along the third.
Lattice gridWithTime(const DatasetInfo& from, int axis) {
    const double finer = from.lattice.kind == LatticeKind::BCC ? 1 / kBccSpacing : 1;
    Lattice grid;
    grid.origin = from.bounds.lo;
    for (int a = 0; a < 3; ++a) {
        if (const AxisMap* map = from.lattice.axes[a]; map && a != axis) {
            grid.size[a] = map->samples();
            grid.spacing[a] = map->spacing();
            grid.origin[a] = map->origin();
            grid.axes.of[std::size_t(a)] = from.lattice.axes.of[std::size_t(a)];
            continue;
        }
        const double extent = from.bounds.size()[a];
        grid.size[a] =
            a == axis ? int(from.times.size()) : int(std::lround(extent / (from.lattice.spacing[a] * finer))) + 1;
        grid.spacing[a] = grid.size[a] > 1 ? extent / (grid.size[a] - 1) : from.lattice.spacing[a];
    }
    grid.origin[axis] = from.times.front() * from.bounds.size()[axis] / (from.times.back() - from.times.front());
    return grid;
}

/// One channel of the source in the plane, at every time step.
Field planeOverTime(const BrickSource& source, int channel, const Lattice& grid, int axis, double place) {
    const DatasetInfo& info = source.info();
    const int right = axis == 0 ? 1 : 0, up = axis == 2 ? 1 : 2, steps = grid.size[axis];
    std::vector<glm::dvec3> positions;
    for (int j = 0; j < grid.size[up]; ++j)
        for (int i = 0; i < grid.size[right]; ++i) {
            glm::dvec3& at = positions.emplace_back(place);
            at[right] = grid.axes.toSpace(right, grid.origin[right] + grid.spacing[right] * i);
            at[up] = grid.axes.toSpace(up, grid.origin[up] + grid.spacing[up] * j);
            at = glm::clamp(at, info.bounds.lo, info.bounds.hi);
        }
    Field field = makeField(grid, ScalarType::F32);
    const auto values = field.as<float>();
    auto mask = std::make_shared<Mask>(grid.count(), std::uint8_t(1));
    parallelFor(std::size_t(steps), [&](std::size_t step) {
        const double share = double(step) / (steps - 1);
        const double time = (1 - share) * info.times.front() + share * info.times.back();
        const std::vector<ProbeValue> plane = probeAlong(source, channel, positions, timesAround(info.times, time));
        for (int j = 0, n = 0; j < grid.size[up]; ++j)
            for (int i = 0; i < grid.size[right]; ++i, ++n) {
                glm::ivec3 at{static_cast<int>(step)};
                at[right] = i;
                at[up] = j;
                const std::optional<double>& value = plane[std::size_t(n)].interpolated;
                values[grid.index(at)] = value ? float(*value) : 0;
                (*mask)[grid.index(at)] = value ? 1 : 0;
            }
    });
    if (std::ranges::find(*mask, std::uint8_t(0)) != mask->end()) field.mask = std::move(mask);
    return field;
}

} // namespace

Dataset withTimeAlong(std::shared_ptr<const BrickSource> source, const TimeAxis& time) {
    const DatasetInfo& from = source->info();
    const int axis = int(time.axis);
    if (from.times.size() < 2) throw Error("time along an axis needs data of several times", {}, "/data/timeAxis");
    if (!(from.bounds.size()[axis] > 0))
        throw Error("the data have no extent along the axis that time would replace", {}, "/data/timeAxis/axis");
    const Lattice grid = gridWithTime(from, axis);
    const double place = from.bounds.lo[axis] + time.place * from.bounds.size()[axis];

    Dataset made;
    made.info = from;
    made.info.lattice = grid;
    made.info.bounds.lo[axis] = grid.origin[axis];
    made.info.bounds.hi[axis] = grid.origin[axis] + from.bounds.size()[axis];
    made.info.times = {from.times.front()};
    made.info.quantities.clear();
    for (Parameter& parameter : made.info.parameters)
        if (!parameter.categorical) parameter.type = ScalarType::F32;
    Parameter& clock = made.info.parameters.emplace_back();
    clock.name = from.findChannel(kClock) ? kSecondClock : kClock;
    clock.unit = from.timeUnit;
    clock.ranges = {{from.times.front(), from.times.back()}};
    const int clockIndex = int(made.info.parameters.size()) - 1;

    made.read = [source, grid, axis, place, clockIndex](int parameter, int component, int) {
        const DatasetInfo& info = source->info();
        if (parameter != clockIndex) {
            int channel = 0;
            for (const Channel& each : info.channels()) {
                if (each.parameter == parameter && each.component == component) break;
                ++channel;
            }
            return converted(planeOverTime(*source, channel, grid, axis, place),
                             info.parameters[std::size_t(parameter)].categorical
                                 ? info.parameters[std::size_t(parameter)].type
                                 : ScalarType::F32);
        }
        Field field = makeField(grid, ScalarType::F32);
        const auto values = field.as<float>();
        for (int z = 0; z < grid.size.z; ++z)
            for (int y = 0; y < grid.size.y; ++y)
                for (int x = 0; x < grid.size.x; ++x) {
                    const glm::ivec3 at(x, y, z);
                    const double share = double(at[axis]) / (grid.size[axis] - 1);
                    values[grid.index(at)] = float((1 - share) * info.times.front() + share * info.times.back());
                }
        return field;
    };
    return made;
}

double timePerLength(const DatasetInfo& info, const TimeAxis& axis) {
    const std::vector<Channel> channels = info.channels();
    std::optional<int> clock = info.findChannel(kSecondClock);
    if (!clock) clock = info.findChannel(kClock);
    const Range range = clock ? info.channelRange(channels[std::size_t(*clock)]) : Range{};
    return (range.hi - range.lo) / info.bounds.size()[int(axis.axis)];
}

} // namespace tessera::volume
