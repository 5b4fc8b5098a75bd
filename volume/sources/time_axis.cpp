#include "volume/sources/time_axis.h"

#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/reconstruct/probe.h"
#include "volume/resample/series.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::volume {

namespace {

constexpr const char *kClock = "time", *kSecondClock = "time along";
constexpr const char* kSetting = "/data/timeAxis";

/// Normal and e of a plane that is said by an angle: -sin (x - place) / length + cos (t - time) / duration = 0.
void turnPlane(SpaceTimePlane& plane, const TimeAxis& wanted) {
    const int axis = int(wanted.axis);
    const glm::dvec4 size = plane.hi - plane.lo;
    const double angle = wanted.degrees * 0.017453292519943295;
    const bool whole = std::abs(wanted.degrees) == 90;
    const double sine = wanted.degrees == 0 ? 0 : std::sin(angle), cosine = whole ? 0 : std::cos(angle);
    if (sine != 0 && !(size[axis] > 0))
        throw Error("the data have no extent along the axis that time would replace", {},
                    std::string(kSetting) + "/axis");
    plane.normal = glm::dvec4(0, 0, 0, cosine / size.w);
    if (sine != 0) plane.normal[axis] = -sine / size[axis];
    glm::dvec4 middle(0);
    middle[axis] = plane.lo[axis] + wanted.place * size[axis];
    middle.w = plane.lo.w + wanted.time * size.w;
    plane.e = -glm::dot(plane.normal, middle);
}

/// Whether times lie at even distances, within a millionth of one.
bool atEvenDistances(const std::vector<double>& times) {
    const double step = (times.back() - times.front()) / double(times.size() - 1);
    for (std::size_t i = 0; i < times.size(); ++i)
        if (std::abs(times[i] - (times.front() + double(i) * step)) > 1e-6 * step) return false;
    return true;
}

/// The resulting grid: the axes of the source, of which time may replace one.
Lattice gridOfPlane(const DatasetInfo& from, const SpaceTimePlane& plane) {
    const double finer = from.lattice.kind == LatticeKind::BCC ? 1 / kBccSpacing : 1;
    Lattice grid;
    grid.origin = from.bounds.lo;
    AxisMaps maps;
    for (int a = 0; a < 3; ++a) {
        const double extent = from.bounds.size()[a];
        if (a == plane.solved) {
            grid.size[a] = int(from.times.size());
            grid.spacing[a] = extent / double(from.times.size() - 1);
            grid.origin[a] = from.times.front() / plane.timePerLength;
            if (atEvenDistances(from.times)) continue;
            std::vector<double> places;
            for (const double time : from.times) places.push_back(time / plane.timePerLength);
            maps.of[std::size_t(a)] = std::make_shared<AxisMap>(AxisMap::Of::Points, std::move(places));
        } else if (from.lattice.axes[a]) {
            maps.of[std::size_t(a)] = from.lattice.axes.of[std::size_t(a)];
        } else {
            grid.size[a] = int(std::lround(extent / (from.lattice.spacing[a] * finer))) + 1;
            grid.spacing[a] = grid.size[a] > 1 ? extent / (grid.size[a] - 1) : from.lattice.spacing[a];
        }
    }
    for (int a = 0; a < 3; ++a)
        if (maps[a]) grid.size[a] = maps[a]->samples();
    return withAxes(grid, maps);
}

constexpr int kPlaneBlock = 32; ///< samples a side that are read together: few bricks at each time

/// Calls visit(begin, end) for the blocks of a grid, on all cores.
template <class Visit> void forBlocks(const Lattice& grid, const Visit& visit) {
    const glm::ivec3 blocks = (grid.size + kPlaneBlock - 1) / kPlaneBlock;
    parallelFor(std::size_t(blocks.x) * std::size_t(blocks.y) * std::size_t(blocks.z), [&](std::size_t n) {
        const int i = int(n);
        const glm::ivec3 begin =
            kPlaneBlock * glm::ivec3(i % blocks.x, i / blocks.x % blocks.y, i / (blocks.x * blocks.y));
        visit(begin, glm::min(begin + kPlaneBlock, grid.size));
    });
}

/// Calls visit(index of the sample, its point) for the samples of a block whose points the source has.
template <class Visit>
void forPoints(const Lattice& grid, const SpaceTimePlane& plane, glm::ivec3 begin, glm::ivec3 end, const Visit& visit) {
    for (int z = begin.z; z < end.z; ++z)
        for (int y = begin.y; y < end.y; ++y)
            for (int x = begin.x; x < end.x; ++x) {
                glm::dvec4 point = plane.pointAt(grid.position({x, y, z}));
                if (plane.reaches(point)) visit(grid.index({x, y, z}), point);
            }
}

/// A field of samples that are absent until they are set.
struct Filled {
    Field field;
    std::shared_ptr<Mask> mask;

    explicit Filled(const Lattice& grid)
        : field(makeField(grid, ScalarType::F32)), mask(std::make_shared<Mask>(grid.count(), std::uint8_t(0))) {}
    void set(std::size_t index, double value) {
        field.as<float>()[index] = float(value);
        (*mask)[index] = 1;
    }
    Field take() {
        if (std::ranges::find(*mask, std::uint8_t(0)) != mask->end()) field.mask = std::move(mask);
        return std::move(field);
    }
};

/// One channel of the source in the plane.
Field channelInPlane(const BrickSource& source, int channel, const Lattice& grid, const SpaceTimePlane& plane) {
    const std::vector<double>& times = source.info().times;
    Filled out(grid);
    forBlocks(grid, [&](glm::ivec3 begin, glm::ivec3 end) {
        std::vector<std::size_t> indices;
        std::vector<glm::dvec3> places;
        std::vector<TimePair> when;
        forPoints(grid, plane, begin, end, [&](std::size_t index, const glm::dvec4& point) {
            indices.push_back(index);
            places.emplace_back(point);
            when.push_back(timesAround(times, point.w));
        });
        const std::vector<ProbeValue> values = probeAlong(source, channel, places, when);
        for (std::size_t i = 0; i < values.size(); ++i)
            if (values[i].interpolated) out.set(indices[i], *values[i].interpolated);
    });
    return out.take();
}

Field timeInPlane(const Lattice& grid, const SpaceTimePlane& plane) {
    Filled out(grid);
    forBlocks(grid, [&](glm::ivec3 begin, glm::ivec3 end) {
        forPoints(grid, plane, begin, end,
                  [&](std::size_t index, const glm::dvec4& point) { out.set(index, point.w); });
    });
    return out.take();
}

} // namespace

SpaceTimePlane planeOf(const DatasetInfo& info, const TimeAxis& wanted) {
    if (info.times.size() < 2)
        throw Error("a plane in space and time needs data of several times, and these have one", {}, kSetting);
    SpaceTimePlane plane;
    plane.lo = glm::dvec4(info.bounds.lo, info.times.front());
    plane.hi = glm::dvec4(info.bounds.hi, info.times.back());
    const std::string place = std::string(kSetting) + (wanted.equation ? "/equation" : "");
    if (wanted.equation) {
        const PlaneEquation& own = *wanted.equation;
        plane.normal = {own.a, own.b, own.c, own.d};
        plane.e = own.e;
    } else {
        turnPlane(plane, wanted);
    }
    const glm::dvec4 size = plane.hi - plane.lo, steep = glm::abs(plane.normal * size);
    plane.solved = 0;
    for (int axis = 1; axis < 4; ++axis)
        if (steep[axis] >= steep[plane.solved]) plane.solved = axis;
    if (!(steep[plane.solved] > 0)) throw Error("a plane in space and time needs a normal that is not 0", {}, place);
    const double reach = 0.5 * glm::dot(glm::abs(plane.normal), size);
    if (std::abs(glm::dot(plane.normal, 0.5 * (plane.lo + plane.hi)) + plane.e) > (1 + 1e-9) * reach)
        throw Error("the plane in space and time does not meet the data", {}, place);
    if (plane.hasTimeAxis()) plane.timePerLength = size.w / size[plane.solved];
    return plane;
}

TimeAxis movedTo(const SpaceTimePlane& now, TimeAxis setting, glm::dvec4 point) {
    const glm::dvec4 size = now.hi - now.lo;
    point = glm::clamp(point, now.lo, now.hi);
    if (setting.equation) {
        setting.equation->e = -glm::dot(now.normal, point);
        return setting;
    }
    const int axis = int(setting.axis);
    if (size[axis] > 0) setting.place = (point[axis] - now.lo[axis]) / size[axis];
    if (std::abs(setting.degrees) != 90) setting.time = (point.w - now.lo.w) / size.w;
    return setting;
}

Dataset withTimeAlong(std::shared_ptr<const BrickSource> source, const TimeAxis& wanted) {
    const DatasetInfo& from = source->info();
    const SpaceTimePlane plane = planeOf(from, wanted);
    const Lattice grid = gridOfPlane(from, plane);

    Dataset made;
    made.info = from;
    made.info.lattice = grid;
    made.info.plane = plane;
    if (plane.hasTimeAxis()) {
        made.info.bounds.lo[plane.solved] = from.times.front() / plane.timePerLength;
        made.info.bounds.hi[plane.solved] = from.times.back() / plane.timePerLength;
    }
    made.info.times = {from.times.front()};
    made.info.quantities.clear();
    for (Parameter& parameter : made.info.parameters)
        if (!parameter.categorical) parameter.type = ScalarType::F32;
    Parameter& clock = made.info.parameters.emplace_back();
    clock.name = from.findChannel(kClock) ? kSecondClock : kClock;
    clock.unit = from.timeUnit;
    clock.ranges = {{from.times.front(), from.times.back()}};
    const int clockIndex = int(made.info.parameters.size()) - 1;

    made.read = [source = std::move(source), grid, plane, clockIndex](int parameter, int component, int) {
        if (parameter == clockIndex) return timeInPlane(grid, plane);
        const DatasetInfo& info = source->info();
        const Parameter& own = info.parameters[std::size_t(parameter)];
        return converted(channelInPlane(*source, info.channelIndex(parameter, component), grid, plane),
                         own.categorical ? own.type : ScalarType::F32);
    };
    return made;
}

} // namespace tessera::volume
