#include "volume/analysis/statistics.h"
#include "volume/bricks/cell_lengths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace tessera::volume {

namespace {

/// A histogram with fractional counts.
class NotedBins {
public:
    NotedBins(Range range, int bins)
        : range_(range), width_(range.hi > range.lo ? range.hi - range.lo : 1), mass_(std::size_t(bins), 0.0) {}

    /// Adds the samples of a brick: in each of its bins spread over the values that can occur there.
    void add(const BrickDistribution& brick) {
        constexpr double kFewValues = 64; // in a bin; more values are treated as continuous
        const double lo = brick.range.lo, extent = brick.range.hi - lo, bins = double(brick.counts.size());
        if (extent <= 0) return put(lo, double(brick.samples));
        const double steps = brick.step > 0 ? std::round(extent / brick.step) : 0;
        const bool few = steps > 0 && steps / bins < kFewValues;
        for (std::size_t b = 0; b < brick.counts.size(); ++b) {
            const auto mass = double(brick.counts[b]);
            if (mass == 0) continue;
            if (!few) {
                spread(lo + extent * double(b) / bins, lo + extent * double(b + 1) / bins, mass);
                continue;
            }
            const bool last = b + 1 == brick.counts.size();
            const double first = std::ceil(double(b) * steps / bins),
                         end = last ? steps + 1 : std::ceil(double(b + 1) * steps / bins);
            for (double v = first; v < end; ++v) put(lo + extent * v / steps, mass / std::max(end - first, 1.0));
            if (first >= end) put(lo + extent * first / steps, mass); // rounding: a neighbour's value
        }
    }

    /// Rounds the bins; the remainder of each is carried to the next.
    Histogram histogram() const {
        Histogram out;
        out.range = range_;
        double sum = 0, rounded = 0;
        for (const double mass : mass_) {
            sum += mass;
            const double upTo = std::round(sum);
            out.count.push_back(std::uint64_t(upTo - rounded));
            out.focus.push_back(upTo - rounded);
            rounded = upTo;
        }
        return out;
    }

private:
    double placeOf(double value) const { return (value - range_.lo) * double(mass_.size()) / width_; }
    void put(double value, double mass) {
        if (!(value >= range_.lo && value <= range_.hi)) return;
        mass_[std::min(std::size_t(placeOf(value)), mass_.size() - 1)] += mass;
    }
    /// Adds a uniform distribution over an interval of values; values outside of the range are not counted.
    void spread(double from, double to, double mass) {
        const double a = placeOf(from), b = placeOf(to), bins = double(mass_.size());
        if (range_.hi <= range_.lo || b <= a) return put(0.5 * (from + to), mass);
        for (double bin = std::max(std::floor(a), 0.0); bin < std::min(b, bins); ++bin)
            mass_[std::size_t(bin)] += mass * std::max(std::min(b, bin + 1) - std::max(a, bin), 0.0) / (b - a);
    }

    Range range_;
    double width_;
    std::vector<double> mass_;
};

/// Sums over bricks by their volume, relative to a shift so that close values keep their digits.
struct NotedSums {
    double shift, samples = 0, volume = 0, sum = 0, squares = 0;
    double min = std::numeric_limits<double>::infinity(), max = -std::numeric_limits<double>::infinity();

    void add(const BrickDistribution& brick, double cells) {
        if (brick.samples == 0) return;
        const auto n = double(brick.samples);
        samples += n;
        volume += cells;
        sum += cells * (brick.mean - shift);
        min = std::min(min, brick.range.lo);
        max = std::max(max, brick.range.hi);
        // About the brick's mean, assuming a uniform distribution within each of its bins.
        const double width = (brick.range.hi - brick.range.lo) / double(brick.counts.size());
        double moment = 0, second = 0;
        for (std::size_t b = 0; b < brick.counts.size(); ++b) {
            const double centre = brick.range.lo + (double(b) + 0.5) * width - brick.mean;
            moment += brick.counts[b] * centre;
            second += brick.counts[b] * (centre * centre + width * width / 12);
        }
        const double variance = std::max(second / n - (moment / n) * (moment / n), 0.0);
        squares += cells * (variance + (brick.mean - shift) * (brick.mean - shift));
    }
    Summary summary() const {
        constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
        if (samples == 0) return {0, 0, kNothing, kNothing, kNothing, kNothing, kNothing};
        const double mean = sum / volume, variance = std::max(squares / volume - mean * mean, 0.0);
        return {samples, volume, shift + mean, std::sqrt(variance), min, max, kNothing};
    }
};

/// Volume of all cells of a brick.
class BrickVolumes {
public:
    explicit BrickVolumes(const BrickSource& source)
        : grid_(source.grid()), sublattices_(grid_.lattice.kind == LatticeKind::BCC ? 2 : 1) {
        for (int s = 0; s < sublattices_; ++s)
            for (int axis = 0; axis < 3; ++axis)
                lengths_[std::size_t(s)][std::size_t(axis)] = cellLengths(grid_, source.info().bounds, 0, s, axis);
    }
    double of(glm::ivec3 brick) const {
        double sum = 0;
        for (const auto& lengths : lengths_) {
            double product = 1.0 / sublattices_;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::size_t begin = std::size_t(brick[int(axis)]) * std::size_t(grid_.brickSize),
                                  end = std::min(begin + std::size_t(grid_.brickSize), lengths[axis].size());
                product *= begin < end ? std::accumulate(lengths[axis].begin() + std::ptrdiff_t(begin),
                                                         lengths[axis].begin() + std::ptrdiff_t(end), 0.0)
                                       : 0.0;
            }
            sum += product;
        }
        return sum;
    }

private:
    BrickGrid grid_;
    int sublattices_;
    std::array<std::array<std::vector<double>, 3>, 2> lengths_; ///< [sublattice][axis]
};

} // namespace

std::optional<Statistics> notedStatistics(const BrickSource& source, const StatisticsQuery& query) {
    // What is noted counts samples alike: where their cells are not, the mean would be far off.
    if (query.doi || !query.pairs.empty() || query.binsByVolume || !source.grid().lattice.isEven()) return std::nullopt;
    const glm::ivec3 count = source.grid().count();
    const std::vector<Channel> channels = source.info().channels();
    const BrickVolumes volumes(source);
    Statistics out;
    out.level = source.grid().levels;
    for (std::size_t c = 0; c < query.channels.size(); ++c) {
        const Range range = query.ranges.empty()
                                ? source.info().channelRange(channels.at(std::size_t(query.channels[c])))
                                : query.ranges.at(c);
        NotedBins bins(range, query.bins);
        NotedSums sums{.shift = 0.5 * (range.lo + range.hi)};
        for (glm::ivec3 at(0); at.z < count.z; ++at.z)
            for (at.y = 0; at.y < count.y; ++at.y)
                for (at.x = 0; at.x < count.x; ++at.x) {
                    const std::optional<BrickDistribution> brick =
                        source.distribution({query.channels[c], query.time, 0, at});
                    if (!brick) return std::nullopt;
                    if (brick->samples == 0) continue;
                    const glm::ivec3 size = source.grid().brickSamples(at, 0);
                    const double all = double(size.x) * size.y * size.z;
                    bins.add(*brick);
                    sums.add(*brick, volumes.of(at) * double(brick->samples) / all);
                }
        ChannelStatistics channel;
        channel.histogram = bins.histogram();
        channel.all = channel.inside = sums.summary();
        channel.outside = NotedSums{.shift = 0}.summary();
        out.channels.push_back(std::move(channel));
    }
    return out;
}

} // namespace tessera::volume
