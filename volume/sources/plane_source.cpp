#include "volume/sources/plane_source.h"

#include "volume/base/error.h"
#include "volume/base/load_once.h"
#include "volume/bricks/brick_cache.h"
#include "volume/bricks/magnitude.h"
#include "volume/bricks/source_at_level.h"
#include "volume/field/part_masks.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace tessera::volume {

namespace {

constexpr const char *kClock = "time", *kSecondClock = "time along";
constexpr std::size_t kBytesRead = std::size_t(256) << 20, kBytesMade = std::size_t(512) << 20;

/// Whether times lie at even distances, within a millionth of one.
bool atEvenDistances(const std::vector<double>& times) {
    const double step = (times.back() - times.front()) / double(times.size() - 1);
    for (std::size_t i = 0; i < times.size(); ++i)
        if (std::abs(times[i] - (times.front() + double(i) * step)) > 1e-6 * step) return false;
    return true;
}

/// The axes of the source, of which time may replace one.
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

BrickGrid bricksOfPlane(const Lattice& lattice, int brickSize) {
    constexpr int kCoarsestEdge = 4;
    BrickGrid grid;
    grid.lattice = lattice;
    grid.brickSize = brickSize;
    const int longest = std::min(std::max({lattice.size.x, lattice.size.y, lattice.size.z}), brickSize);
    grid.levels = 1;
    while ((longest >> grid.levels) >= kCoarsestEdge) ++grid.levels;
    return grid;
}

DatasetInfo infoOfPlane(const DatasetInfo& from, const SpaceTimePlane& plane) {
    DatasetInfo info = from;
    info.lattice = gridOfPlane(from, plane);
    info.plane = plane;
    if (plane.hasTimeAxis()) {
        info.bounds.lo[plane.solved] = from.times.front() / plane.timePerLength;
        info.bounds.hi[plane.solved] = from.times.back() / plane.timePerLength;
    }
    info.times = {from.times.front()};
    info.quantities.clear();
    for (Parameter& parameter : info.parameters)
        if (!parameter.categorical) parameter.type = ScalarType::F32;
    Parameter& clock = info.parameters.emplace_back();
    clock.name = from.findChannel(kClock) ? kSecondClock : kClock;
    clock.unit = from.timeUnit;
    clock.ranges = {{from.times.front(), from.times.back()}};
    return info;
}

/// Bounds of points of the plane.
struct PointBox {
    glm::dvec4 lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()};
    bool whole = true; ///< all of them lie in the source
};

class PlaneSource final : public BrickSource {
public:
    PlaneSource(std::shared_ptr<const BrickSource> source, const TimeAxis& wanted)
        : plane_(planeOf(source->info(), wanted)), from_(std::make_shared<BrickCache>(std::move(source), kBytesRead)),
          info_(infoOfPlane(from_->info(), plane_)), grid_(bricksOfPlane(info_.lattice, from_->grid().brickSize)),
          channels_(info_.channels()), clock_(int(channels_.size()) - 1),
          made_(
              kBytesMade, [this](const BrickKey& key) { return std::make_shared<const BrickSamples>(make(key)); },
              [](const BrickSamples& brick) { return brick.values.size() * sizeof(float) + brick.present.size(); }) {
        for (int level = 0; level < grid_.levels; ++level) {
            const int own = std::min(level, from_->grid().levels - 1);
            levels_.push_back(own == 0 ? from_ : sourceAtLevel(from_, own));
        }
    }

    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return grid_; }

    BrickStats stats(const BrickKey& key) const override {
        const Channel& channel = channelOf(key);
        const PointBox box = pointsOf(key);
        if (key.channel == clock_) {
            const float part = box.whole ? 1 : meets(box) ? 0.5f : 0;
            return part > 0 ? BrickStats{below(box.lo.w), above(box.hi.w), part} : kNothing;
        }
        if (!channel.magnitude) return boundsOf(key.channel, box);
        std::vector<BrickStats> components;
        for (int c = 0; c < channel.component; ++c)
            components.push_back(boundsOf(info_.channelIndex(channel.parameter, c), box));
        return magnitudeStats(components);
    }

    BrickSamples read(const BrickKey& key) const override {
        channelOf(key);
        return *made_.get(key);
    }

private:
    static constexpr BrickStats kNothing{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest(), 0};
    static float below(double value) { return std::nextafter(float(value), std::numeric_limits<float>::lowest()); }
    static float above(double value) { return std::nextafter(float(value), std::numeric_limits<float>::max()); }

    const Channel& channelOf(const BrickKey& key) const {
        const glm::ivec3 count = grid_.count();
        if (key.channel < 0 || std::size_t(key.channel) >= channels_.size() || key.time != 0 || key.level < 0 ||
            key.level >= grid_.levels || key.index.x < 0 || key.index.y < 0 || key.index.z < 0 ||
            key.index.x >= count.x || key.index.y >= count.y || key.index.z >= count.z)
            throw Error("no such brick", info_.name);
        return channels_[std::size_t(key.channel)];
    }

    BrickSamples make(const BrickKey& key) const {
        const Channel& channel = channels_[std::size_t(key.channel)];
        if (!channel.magnitude) return samplesOf(key);
        std::vector<BrickSamples> components;
        for (int c = 0; c < channel.component; ++c) {
            BrickKey own = key;
            own.channel = info_.channelIndex(channel.parameter, c);
            components.push_back(*made_.get(own));
        }
        return magnitude(components);
    }

    BrickSamples samplesOf(const BrickKey& key) const {
        BrickSamples out;
        out.size = grid_.brickSamples(key.index, key.level);
        const auto count = std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z);
        out.values.resize(count);
        out.present.resize(count);
        const glm::ivec3 begin = grid_.levelBegin(key.index, key.level);
        std::vector<std::size_t> indices;
        std::vector<glm::dvec3> places;
        std::vector<TimePair> when;
        std::size_t index = 0;
        for (int z = 0; z < out.size.z; ++z)
            for (int y = 0; y < out.size.y; ++y)
                for (int x = 0; x < out.size.x; ++x, ++index) {
                    const glm::ivec3 fine = (begin + glm::ivec3(x, y, z)) * (1 << key.level);
                    glm::dvec4 point = plane_.pointAt(grid_.lattice.position(fine));
                    if (!plane_.reaches(point)) continue;
                    if (key.channel == clock_) {
                        out.values[index] = float(point.w);
                        out.present[index] = 1;
                        continue;
                    }
                    indices.push_back(index);
                    places.emplace_back(point);
                    when.push_back(timesAround(from_->info().times, point.w));
                }
        const BrickSource& source = *levels_[std::size_t(key.level)];
        const std::vector<ProbeValue> values =
            places.empty() ? std::vector<ProbeValue>() : probeAlong(source, key.channel, places, when);
        for (std::size_t i = 0; i < values.size(); ++i)
            if (values[i].interpolated) {
                out.values[indices[i]] = float(*values[i].interpolated);
                out.present[indices[i]] = 1;
            }
        if (std::ranges::find(out.present, std::uint8_t(0)) == out.present.end()) out.present.clear();
        return out;
    }

    /// The points of a brick. They are linear in the position, so its corners bound them.
    PointBox pointsOf(const BrickKey& key) const {
        const glm::ivec3 first = grid_.begin(key.index), last = grid_.end(key.index) - 1;
        PointBox box;
        for (int corner = 0; corner < 8; ++corner) {
            glm::ivec3 at;
            for (int a = 0; a < 3; ++a) at[a] = (corner >> a & 1) != 0 ? last[a] : first[a];
            glm::dvec4 point = plane_.pointAt(grid_.lattice.position(at));
            box.whole = plane_.reaches(point) && box.whole;
            box.lo = glm::min(box.lo, point);
            box.hi = glm::max(box.hi, point);
        }
        return box;
    }

    bool meets(PointBox& box) const {
        box.lo = glm::max(box.lo, plane_.lo);
        box.hi = glm::min(box.hi, plane_.hi);
        for (int axis = 0; axis < 4; ++axis)
            if (box.lo[axis] > box.hi[axis]) return false;
        return true;
    }
    bool meets(const PointBox& box) const {
        PointBox own = box;
        return meets(own);
    }

    /// From the bricks of the source whose samples the points lie among, at the times around theirs.
    BrickStats boundsOf(int channel, PointBox box) const {
        if (!meets(box)) return kNothing;
        const DatasetInfo& info = from_->info();
        const BrickGrid& grid = from_->grid();
        const glm::ivec3 lastBrick = grid.count() - 1;
        const auto brickAt = [&](glm::dvec3 place, double margin) {
            const glm::dvec3 cells = grid.lattice.toCells(place) + margin;
            return glm::clamp(glm::ivec3(glm::floor(cells / double(grid.brickSize))), glm::ivec3(0), lastBrick);
        };
        const glm::ivec3 from = brickAt(box.lo, -1), to = brickAt(box.hi, 1);
        const int first = timesAround(info.times, box.lo.w).earlier, last = timesAround(info.times, box.hi.w).later;
        BrickStats out = kNothing;
        bool whole = box.whole;
        for (int time = first; time <= last; ++time)
            for (int z = from.z; z <= to.z; ++z)
                for (int y = from.y; y <= to.y; ++y)
                    for (int x = from.x; x <= to.x; ++x) {
                        const BrickStats own = from_->stats({channel, time, 0, {x, y, z}});
                        whole = whole && own.presentFraction == 1;
                        if (!(own.presentFraction > 0)) continue;
                        out = {std::min(out.min, own.min), std::max(out.max, own.max), 1};
                    }
        if (out.presentFraction > 0 && !whole) out.presentFraction = 0.5f;
        // Beyond the border of a part its values go on, within the range of the parameter.
        const Parameter& parameter = info.parameters[std::size_t(channels_[std::size_t(channel)].parameter)];
        if (out.presentFraction > 0 && labelOf(info, parameter) >= 0) {
            const Range range = info_.channelRange(channels_[std::size_t(channel)]);
            out.min = std::min(out.min, below(range.lo));
            out.max = std::max(out.max, above(range.hi));
        }
        return out;
    }

    SpaceTimePlane plane_;
    std::shared_ptr<const BrickCache> from_;
    DatasetInfo info_;
    BrickGrid grid_;
    std::vector<Channel> channels_;
    int clock_;
    std::vector<std::shared_ptr<const BrickSource>> levels_; ///< of the data, by level of the plane
    mutable LoadOnce<BrickKey, BrickSamples, BrickKeyHash> made_;
};

} // namespace

std::shared_ptr<const BrickSource> makePlaneSource(std::shared_ptr<const BrickSource> source, const TimeAxis& wanted) {
    return std::make_shared<const PlaneSource>(std::move(source), wanted);
}

} // namespace tessera::volume
