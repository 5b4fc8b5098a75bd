#include "volume/analysis/axis_densities.h"

#include "volume/base/parallel.h"
#include "volume/bricks/sample_position.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <limits>
#include <mutex>
#include <tbb/enumerable_thread_specific.h>

namespace tessera::volume {

namespace {

constexpr double kDegreeUnits = 1 << 10; ///< units of a degree of interest: integers add up the same in any order

/// Numbers of one thread, by place.
struct PlaceSums {
    std::vector<std::uint64_t> all;
    std::vector<std::vector<std::uint64_t>> selected;

    PlaceSums(std::size_t places, int groups)
        : all(places), selected(std::size_t(groups), std::vector<std::uint64_t>(places)) {}
    void add(const PlaceSums& other) {
        for (std::size_t i = 0; i < all.size(); ++i) all[i] += other.all[i];
        for (std::size_t g = 0; g < selected.size(); ++g)
            for (std::size_t i = 0; i < all.size(); ++i) selected[g][i] += other.selected[g][i];
    }
    PlaceCounts counts() const {
        PlaceCounts out{all, {}};
        for (const std::vector<std::uint64_t>& group : selected) {
            std::vector<double>& degrees = out.selected.emplace_back();
            for (const std::uint64_t sum : group) degrees.push_back(double(sum) / kDegreeUnits);
        }
        return out;
    }
};

struct DensitySums {
    std::vector<PlaceSums> axes, gaps;
    PlaceSums cube;
};

/// What is summed of a sample's group.
struct SampleWeights {
    std::vector<std::uint8_t> group;
    std::vector<std::uint16_t> degree; ///< in units of 2^-10; empty: nothing is selected
};

class DensityCounter {
public:
    DensityCounter(const BrickSource& source, const AxisDensitiesQuery& query)
        : source_(source), query_(query), grid_(source.grid()) {}

    AxisDensities run(const Progress& progress) const {
        tbb::enumerable_thread_specific<DensitySums> sums([this] { return empty(); });
        std::atomic<std::size_t> done = 0;
        std::mutex reporting;
        progress.advance(0, "densities");
        const std::size_t bricks = grid_.brickCount();
        parallelFor(bricks, [&](std::size_t i) {
            if (progress.stop.stop_requested()) throw Cancelled();
            brick(grid_.indexOf(i), sums.local());
            const std::size_t finished = ++done;
            if (const std::unique_lock lock(reporting, std::try_to_lock); lock)
                progress.advance(double(finished) / double(bricks), "densities");
        });
        DensitySums all = empty();
        for (const DensitySums& each : sums) {
            for (std::size_t a = 0; a < all.axes.size(); ++a) all.axes[a].add(each.axes[a]);
            for (std::size_t g = 0; g < all.gaps.size(); ++g) all.gaps[g].add(each.gaps[g]);
            all.cube.add(each.cube);
        }
        AxisDensities out{.bins = query_.bins, .level = query_.level, .axes = {}, .gaps = {}, .cube = {}};
        for (const PlaceSums& each : all.axes) out.axes.push_back(each.counts());
        for (const PlaceSums& each : all.gaps) out.gaps.push_back(each.counts());
        if (query_.together) out.cube = all.cube.counts();
        return out;
    }

private:
    DensitySums empty() const {
        const std::size_t places = placesOf(query_.bins), axes = query_.axes.size();
        return {std::vector<PlaceSums>(axes, PlaceSums(places, query_.groups)),
                std::vector<PlaceSums>(axes > 0 ? axes - 1 : 0, PlaceSums(places * places, query_.groups)),
                PlaceSums(query_.together ? cells() : 0, query_.groups)};
    }

    std::size_t cells() const {
        const auto bins = std::size_t(query_.bins);
        return bins * bins * bins;
    }

    /// Values of a channel in a brick, NaN where absent.
    BrickSamples column(int channel, glm::ivec3 index) const {
        BrickSamples samples = source_.read({channel, query_.time, query_.level, index});
        for (std::size_t i = 0; i < samples.present.size(); ++i)
            if (samples.present[i] == 0) samples.values[i] = std::numeric_limits<float>::quiet_NaN();
        return samples;
    }

    std::vector<std::uint16_t> places(const DensityAxis& axis, const BrickSamples& column) const {
        std::vector<std::uint16_t> out(column.values.size());
        const double lo = axis.range.lo, hi = axis.range.hi, bins = query_.bins, last = bins - 1;
        const double width = hi > lo ? hi - lo : 1;
        for (std::size_t i = 0; i < out.size(); ++i) {
            const double value = column.exact(i);
            int place = absentPlace(query_.bins);
            if (value < lo || (axis.logarithmic && value <= 0))
                place = belowPlace(query_.bins);
            else if (value > hi)
                place = abovePlace(query_.bins);
            else if (value == value) // multiply first, so that integer borders between bins stay integers
                place = int(std::clamp(axis.logarithmic ? axisShare(axis, value) * bins : (value - lo) * bins / width,
                                       0.0, last));
            out[i] = std::uint16_t(place);
        }
        return out;
    }

    SampleWeights weights(const std::vector<BrickSamples>& columns, glm::ivec3 index, std::size_t count) const {
        SampleWeights out;
        if (query_.groups == 0 || !query_.interest) return out;
        out.group.resize(count);
        out.degree.resize(count);
        std::vector<float> values(columns.size());
        SamplePositions position(grid_, index, query_.level);
        for (std::size_t i = 0; i < count; ++i, position.next()) {
            for (std::size_t c = 0; c < columns.size(); ++c) values[c] = columns[c].values[i];
            const DensityInterest found = query_.interest(values, position.at());
            out.group[i] = std::uint8_t(std::clamp(found.group, 0, query_.groups - 1));
            out.degree[i] = std::uint16_t(std::lround(std::clamp(found.degree, 0.0, 1.0) * kDegreeUnits));
        }
        return out;
    }

    static void count(PlaceSums& sums, std::size_t place, const SampleWeights& weights, std::size_t sample) {
        ++sums.all[place];
        if (!weights.degree.empty() && weights.degree[sample] > 0)
            sums.selected[weights.group[sample]][place] += weights.degree[sample];
    }

    void brick(glm::ivec3 index, DensitySums& sums) const {
        std::vector<BrickSamples> columns;
        for (const DensityAxis& axis : query_.axes) columns.push_back(column(axis.channel, index));
        for (const int channel : query_.further) columns.push_back(column(channel, index));
        if (query_.axes.empty()) return;
        const std::size_t samples = columns.front().values.size(), axes = query_.axes.size();
        const SampleWeights own = weights(columns, index, samples);
        std::vector<std::vector<std::uint16_t>> place;
        for (std::size_t a = 0; a < axes; ++a) place.push_back(places(query_.axes[a], columns[a]));
        const auto absent = std::uint16_t(absentPlace(query_.bins));
        std::vector<std::uint8_t> there(samples);
        for (const std::vector<std::uint16_t>& each : place)
            for (std::size_t i = 0; i < samples; ++i)
                if (each[i] != absent) there[i] = 1;
        for (std::size_t a = 0; a < axes; ++a)
            for (std::size_t i = 0; i < samples; ++i)
                if (there[i] != 0) count(sums.axes[a], place[a][i], own, i);
        const std::size_t stride = placesOf(query_.bins);
        for (std::size_t g = 0; g + 1 < axes; ++g)
            for (std::size_t i = 0; i < samples; ++i)
                if (there[i] != 0) count(sums.gaps[g], place[g][i] * stride + place[g + 1][i], own, i);
        const auto bins = std::size_t(query_.bins);
        for (std::size_t i = 0; query_.together && i < samples; ++i)
            if (place[0][i] < bins && place[1][i] < bins && place[2][i] < bins)
                count(sums.cube, (place[0][i] * bins + place[1][i]) * bins + place[2][i], own, i);
    }

    const BrickSource& source_;
    const AxisDensitiesQuery& query_;
    const BrickGrid grid_;
};

} // namespace

double axisShare(const DensityAxis& axis, double value) {
    const Range range = axis.range;
    if (!axis.logarithmic) return (value - range.lo) / (range.hi > range.lo ? range.hi - range.lo : 1);
    if (value <= 0) return -std::numeric_limits<double>::infinity();
    const double all = std::log(range.hi / range.lo);
    return std::log(value / range.lo) / (all > 0 ? all : 1);
}

double axisValue(const DensityAxis& axis, double share) {
    const Range range = axis.range;
    if (!axis.logarithmic) return range.lo + share * (range.hi - range.lo);
    return range.lo * std::pow(range.hi / range.lo, share);
}

double PlaceCounts::selectedAt(std::size_t place) const {
    double sum = 0;
    for (const std::vector<double>& group : selected) sum += group[place];
    return sum;
}

AxisDensities axisDensities(const BrickSource& source, const AxisDensitiesQuery& query, const Progress& progress) {
    assert(!query.together || query.axes.size() == 3);
    assert(query.bins > 0 && query.bins < 65000 && query.level >= 0 && query.level < source.grid().levels);
    return DensityCounter(source, query).run(progress);
}

} // namespace tessera::volume
