#include "volume/statistics.h"

#include "volume/parallel.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <mutex>
#include <tbb/enumerable_thread_specific.h>

namespace tessera::volume {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kFocusUnit = 1.0 / 65536; // of summed degrees of interest: integers add up the same in any order
constexpr double kFocusHalf = 0.5;         // at least this much interest is "inside"

/// Sums of one channel over a set of samples, relative to a shift so that close values keep their digits.
struct Sums {
    std::uint64_t n = 0;
    double volume = 0, sum = 0, squares = 0;
    float min = std::numeric_limits<float>::infinity(), max = -std::numeric_limits<float>::infinity();

    void add(float value, double shift, double cell) {
        const double v = double(value) - shift;
        ++n;
        volume += cell;
        sum += v;
        squares += v * v;
        min = std::min(min, value);
        max = std::max(max, value);
    }
    void add(const Sums& other) {
        n += other.n;
        volume += other.volume;
        sum += other.sum;
        squares += other.squares;
        min = std::min(min, other.min);
        max = std::max(max, other.max);
    }
    Summary summary(double shift) const {
        if (n == 0) return {0, 0, kNan, kNan, kNan, kNan};
        const double mean = sum / double(n);
        const double variance = std::max(0.0, squares / double(n) - mean * mean);
        return {n, volume, shift + mean, std::sqrt(variance), double(min), double(max)};
    }
};

/// Sums of a pair of channels over samples present in both.
struct PairSums {
    std::uint64_t n = 0;
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0;

    void add(double a, double b) {
        ++n;
        x += a;
        y += b;
        xx += a * a;
        yy += b * b;
        xy += a * b;
    }
    void add(const PairSums& other) {
        n += other.n;
        x += other.x;
        y += other.y;
        xx += other.xx;
        yy += other.yy;
        xy += other.xy;
    }
    double correlation() const {
        const double count = double(n);
        const double a = count * xx - x * x, b = count * yy - y * y;
        // What rounding leaves of a constant channel is no variance.
        constexpr double kEpsilon = 1e-12;
        if (n < 2 || a <= kEpsilon * count * xx || b <= kEpsilon * count * yy) return kNan;
        return std::clamp((count * xy - x * y) / std::sqrt(a * b), -1.0, 1.0);
    }
};

/// What one brick adds besides histograms; merged in the order of the bricks.
struct BrickSums {
    std::vector<Sums> inside, outside; ///< per channel
    std::vector<PairSums> pairs, focusPairs;
};

/// Histogram counts and focus sums; integers, so that the order of adding does not matter.
struct Bins {
    std::vector<std::uint32_t> count;
    std::vector<std::uint64_t> focus;
    explicit Bins(std::size_t size = 0) : count(size), focus(size) {}
    void add(std::size_t bin, std::uint32_t doi) {
        ++count[bin];
        focus[bin] += doi;
    }
};

struct BinSet {
    std::vector<Bins> channels, pairs;
};

/// Length of every sample's cell along one axis of a sublattice at a level, within the box: the cells tile the box.
std::vector<double> cellLengths(const BrickGrid& grid, const Box& box, int level, int sublattice, int axis) {
    const Lattice& lattice = grid.lattice;
    const int fine = lattice.sublatticeSize(sublattice)[axis];
    const int count = (fine + (1 << level) - 1) >> level;
    const double edge = lattice.spacing[axis];
    const auto border = [&](int i) { // between sample i - 1 and i
        if (i == 0) return box.lo[axis];
        if (i == count) return box.hi[axis];
        const double cells = (double(i) - 0.5) * (1 << level) + grid.levelPhase(level) + 0.5 * sublattice;
        return std::clamp(lattice.origin[axis] + edge * cells, box.lo[axis], box.hi[axis]);
    };
    std::vector<double> lengths;
    for (int i = 0; i < count; ++i) lengths.push_back(border(i + 1) - border(i));
    // A box without extent along this axis (one sample): what a cell would be.
    if (box.hi[axis] <= box.lo[axis]) lengths.assign(lengths.size(), edge / std::max(1, count));
    return lengths;
}

class Accumulator {
public:
    Accumulator(const BrickSource& source, const StatisticsQuery& query)
        : source_(source), query_(query), grid_(source.grid()),
          sublattices_(grid_.lattice.kind == LatticeKind::BCC ? 2 : 1) {
        const DatasetInfo& info = source.info();
        const std::vector<Channel> channels = info.channels();
        for (std::size_t c = 0; c < query.channels.size(); ++c) {
            assert(query.channels[c] >= 0 && std::size_t(query.channels[c]) < channels.size());
            ranges_.push_back(query.ranges.empty() ? info.channelRange(channels[std::size_t(query.channels[c])])
                                                   : query.ranges.at(c));
            shifts_.push_back((ranges_.back().lo + ranges_.back().hi) / 2);
        }
        for (int s = 0; s < sublattices_; ++s)
            for (int axis = 0; axis < 3; ++axis)
                lengths_[s][axis] = cellLengths(grid_, info.bounds, query.level, s, axis);
    }

    Statistics run(const Progress& progress) {
        const glm::ivec3 count = grid_.count();
        const auto bricks = std::size_t(count.x) * std::size_t(count.y) * std::size_t(count.z);
        std::vector<BrickSums> sums(bricks);
        tbb::enumerable_thread_specific<BinSet> bins([this] { return emptyBins(); });
        std::atomic<std::size_t> done = 0;
        std::mutex reporting;
        progress.advance(0, "statistics");
        parallelFor(bricks, [&](std::size_t i) {
            if (progress.stop.stop_requested()) throw Cancelled();
            const int n = int(i);
            sums[i] = brick({n % count.x, n / count.x % count.y, n / (count.x * count.y)}, bins.local());
            const std::size_t finished = ++done;
            if (const std::unique_lock lock(reporting, std::try_to_lock); lock)
                progress.advance(double(finished) / double(bricks), "statistics");
        });
        BinSet all = emptyBins();
        for (const BinSet& set : bins) {
            for (std::size_t c = 0; c < all.channels.size(); ++c) addBins(all.channels[c], set.channels[c]);
            for (std::size_t p = 0; p < all.pairs.size(); ++p) addBins(all.pairs[p], set.pairs[p]);
        }
        return result(sums, all);
    }

private:
    std::size_t bins() const { return std::size_t(query_.bins); }

    BinSet emptyBins() const {
        BinSet set;
        set.channels.assign(query_.channels.size(), Bins(bins()));
        set.pairs.assign(query_.pairs.size(), Bins(bins() * bins()));
        return set;
    }

    static void addBins(Bins& to, const Bins& from) {
        for (std::size_t i = 0; i < to.count.size(); ++i) {
            to.count[i] += from.count[i];
            to.focus[i] += from.focus[i];
        }
    }

    /// Bin of a value, -1 outside the range.
    int binOf(std::size_t channel, float value) const {
        const Range& range = ranges_[channel];
        if (!(double(value) >= range.lo && double(value) <= range.hi)) return -1;
        if (range.hi <= range.lo) return 0;
        const double bin = (double(value) - range.lo) / (range.hi - range.lo) * query_.bins;
        return std::min(int(bin), query_.bins - 1);
    }

    BrickSums brick(glm::ivec3 index, BinSet& bins) const {
        const std::size_t channels = query_.channels.size();
        BrickSums sums;
        sums.inside.resize(channels);
        sums.outside.resize(channels);
        sums.pairs.resize(query_.pairs.size());
        sums.focusPairs.resize(query_.pairs.size());
        std::vector<BrickSamples> samples;
        for (const int channel : query_.channels)
            samples.push_back(source_.read({channel, query_.time, query_.level, index}));
        const glm::ivec3 size = grid_.brickSamples(index, query_.level);
        const glm::ivec3 first = grid_.levelBegin(index, query_.level);
        std::vector<float> values(channels);
        std::vector<int> bin(channels);
        std::size_t n = 0;
        for (int z = 0; z < size.z; ++z) {
            const auto s = std::size_t((first.z + z) % sublattices_);
            const double depth = lengths_[s][2][std::size_t((first.z + z) / sublattices_)] / sublattices_;
            for (int y = 0; y < size.y; ++y) {
                const double area = depth * lengths_[s][1][std::size_t(first.y + y)];
                for (int x = 0; x < size.x; ++x, ++n) {
                    bool any = false;
                    for (std::size_t c = 0; c < channels; ++c) {
                        const bool present = samples[c].present.empty() || samples[c].present[n] != 0;
                        values[c] = present ? samples[c].values[n] : std::numeric_limits<float>::quiet_NaN();
                        any = any || present;
                    }
                    if (!any) continue;
                    addSample(values, bin, area * lengths_[s][0][std::size_t(first.x + x)], sums, bins);
                }
            }
        }
        return sums;
    }

    void addSample(const std::vector<float>& values, std::vector<int>& bin, double cell, BrickSums& sums,
                   BinSet& bins) const {
        const double doi = query_.doi ? std::clamp(query_.doi(values), 0.0, 1.0) : 1.0;
        const auto focus = std::uint32_t(std::lround(doi / kFocusUnit));
        const bool inside = doi >= kFocusHalf;
        for (std::size_t c = 0; c < values.size(); ++c) {
            if (std::isnan(values[c])) continue;
            bin[c] = binOf(c, values[c]);
            if (bin[c] >= 0) bins.channels[c].add(std::size_t(bin[c]), focus);
            (inside ? sums.inside : sums.outside)[c].add(values[c], shifts_[c], cell);
        }
        for (std::size_t p = 0; p < query_.pairs.size(); ++p) {
            const auto x = std::size_t(query_.pairs[p][0]), y = std::size_t(query_.pairs[p][1]);
            if (std::isnan(values[x]) || std::isnan(values[y])) continue;
            const double a = double(values[x]) - shifts_[x], b = double(values[y]) - shifts_[y];
            sums.pairs[p].add(a, b);
            if (inside) sums.focusPairs[p].add(a, b);
            if (bin[x] < 0 || bin[y] < 0) continue;
            bins.pairs[p].add(std::size_t(bin[y]) * this->bins() + std::size_t(bin[x]), focus);
        }
    }

    static void unpack(const Bins& bins, std::vector<std::uint64_t>& count, std::vector<double>& focus) {
        count.assign(bins.count.begin(), bins.count.end());
        focus.reserve(bins.focus.size());
        for (const std::uint64_t units : bins.focus) focus.push_back(double(units) * kFocusUnit);
    }

    Statistics result(const std::vector<BrickSums>& sums, const BinSet& bins) const {
        Statistics out;
        out.level = query_.level;
        for (std::size_t c = 0; c < query_.channels.size(); ++c) {
            Sums inside, outside;
            for (const BrickSums& brick : sums) {
                inside.add(brick.inside[c]);
                outside.add(brick.outside[c]);
            }
            Sums all = inside;
            all.add(outside);
            ChannelStatistics channel;
            channel.histogram.range = ranges_[c];
            unpack(bins.channels[c], channel.histogram.count, channel.histogram.focus);
            channel.all = all.summary(shifts_[c]);
            channel.inside = inside.summary(shifts_[c]);
            channel.outside = outside.summary(shifts_[c]);
            out.channels.push_back(std::move(channel));
        }
        for (std::size_t p = 0; p < query_.pairs.size(); ++p) {
            PairSums all, focus;
            for (const BrickSums& brick : sums) {
                all.add(brick.pairs[p]);
                focus.add(brick.focusPairs[p]);
            }
            JointHistogram joint;
            joint.x = query_.pairs[p][0];
            joint.y = query_.pairs[p][1];
            joint.xRange = ranges_[std::size_t(joint.x)];
            joint.yRange = ranges_[std::size_t(joint.y)];
            joint.bins = query_.bins;
            unpack(bins.pairs[p], joint.count, joint.focus);
            joint.samples = all.n;
            joint.correlation = all.correlation();
            joint.focusCorrelation = focus.correlation();
            out.joint.push_back(std::move(joint));
        }
        return out;
    }

    const BrickSource& source_;
    const StatisticsQuery& query_;
    const BrickGrid grid_;
    int sublattices_;
    std::vector<Range> ranges_;
    std::vector<double> shifts_;
    std::vector<double> lengths_[2][3]; ///< [sublattice][axis][sample]: of the sample's cell
};

} // namespace

std::vector<std::array<int, 2>> allPairs(int count) {
    std::vector<std::array<int, 2>> pairs;
    for (int j = 1; j < count; ++j)
        for (int i = 0; i < j; ++i) pairs.push_back({i, j});
    return pairs;
}

Statistics computeStatistics(const BrickSource& source, const StatisticsQuery& query, const Progress& progress) {
    assert(query.bins > 0 && query.level >= 0 && query.level < source.grid().levels);
    return Accumulator(source, query).run(progress);
}

} // namespace tessera::volume
