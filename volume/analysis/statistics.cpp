#include "volume/analysis/statistics.h"

#include "volume/analysis/statistics_sums.h"
#include "volume/base/parallel.h"
#include "volume/bricks/cell_lengths.h"
#include "volume/bricks/sample_position.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <mutex>
#include <numeric>
#include <tbb/enumerable_thread_specific.h>

namespace tessera::volume {

namespace {

constexpr std::size_t kTogether = 8192; ///< samples at a time: those of seven channels fit the L2 cache

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
                lengths_[std::size_t(s)][std::size_t(axis)] = cellLengths(grid_, info.bounds, query.level, s, axis);
        for (const auto& lengths : lengths_) {
            double volume = 1.0 / sublattices_;
            for (const std::vector<double>& along : lengths) volume *= std::accumulate(along.begin(), along.end(), 0.0);
            box_ += volume;
        }
    }

    Statistics run(const Progress& progress) {
        const std::size_t bricks = grid_.brickCount();
        std::vector<BrickSums> sums(bricks);
        tbb::enumerable_thread_specific<BinSet> bins([this] { return emptyBins(); });
        std::atomic<std::size_t> done = 0;
        std::mutex reporting;
        progress.advance(0, "statistics");
        parallelFor(bricks, [&](std::size_t i) {
            if (progress.stop.stop_requested()) throw Cancelled();
            sums[i] = brick(grid_.indexOf(i), bins.local());
            const std::size_t finished = ++done;
            if (const std::unique_lock lock(reporting, std::try_to_lock); lock)
                progress.advance(double(finished) / double(bricks), "statistics");
        });
        BinSet all = emptyBins();
        for (BinSet& set : bins) {
            set.flush();
            for (std::size_t c = 0; c < all.channels.size(); ++c) all.channels[c].add(set.channels[c]);
            for (std::size_t p = 0; p < all.pairs.size(); ++p) all.pairs[p].add(set.pairs[p]);
        }
        return result(sums, all);
    }

private:
    std::size_t stride() const { return std::size_t(query_.bins) + 1; }

    BinSet emptyBins() const {
        BinSet set;
        const bool byVolume = query_.binsByVolume;
        set.channels.assign(query_.channels.size(), Bins(stride(), false, byVolume));
        set.pairs.assign(query_.pairs.size(), Bins(stride() * stride(), query_.meanOf >= 0, byVolume));
        return set;
    }

    /// Bins of values; NaN is in none. Without branches, so that the compiler vectorises it.
    void findBins(std::size_t channel, Column& column) const {
        if (column.rest.empty())
            findBins(
                channel, column.value.size(), [&](std::size_t i) { return double(column.value[i]); }, column.bin);
        else
            findBins(
                channel, column.value.size(), [&](std::size_t i) { return column.exact(i); }, column.bin);
    }
    void findBins(std::size_t channel, std::size_t samples, const auto& valueOf,
                  std::vector<std::uint16_t>& bins) const {
        const double lo = ranges_[channel].lo, hi = ranges_[channel].hi, width = hi > lo ? hi - lo : 1;
        const double count = query_.bins, last = count - 1;
        for (std::size_t i = 0; i < samples; ++i) {
            const double value = valueOf(i);
            // Multiply first, so that integer borders between bins stay integers.
            const double bin = std::min((std::min(std::max(value, lo), hi) - lo) * count / width, last);
            bins[i] = std::uint16_t(int(value >= lo && value <= hi ? bin : count));
        }
    }

    Column column(std::size_t channel, glm::ivec3 index) const {
        BrickSamples samples = source_.read({query_.channels[channel], query_.time, query_.level, index});
        Column out;
        out.value = std::move(samples.values);
        out.rest = std::move(samples.rest);
        const std::size_t count = out.value.size();
        out.centred.resize(count);
        out.present.resize(count);
        out.bin.resize(count);
        for (std::size_t i = 0; i < samples.present.size(); ++i)
            if (samples.present[i] == 0) out.value[i] = std::numeric_limits<float>::quiet_NaN();
        int absent = 0;
        const double shift = shifts_[channel];
        for (std::size_t i = 0; i < count; ++i) {
            const float value = out.value[i];
            const bool present = value == value;
            out.centred[i] = present ? float(out.exact(i) - shift) : 0;
            out.present[i] = present ? 1 : 0;
            absent += present ? 0 : 1;
        }
        out.whole = absent == 0;
        findBins(channel, out);
        return out;
    }

    /// Volume of every sample's cell in a brick.
    std::vector<double> cells(glm::ivec3 index) const {
        const glm::ivec3 size = grid_.brickSamples(index, query_.level);
        const glm::ivec3 first = grid_.levelBegin(index, query_.level);
        std::vector<double> out;
        out.reserve(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z));
        for (int z = first.z; z < first.z + size.z; ++z) {
            const auto& lengths = lengths_[std::size_t(z % sublattices_)];
            const double depth = lengths[2][std::size_t(z / sublattices_)] / sublattices_;
            for (int y = first.y; y < first.y + size.y; ++y)
                for (int x = first.x; x < first.x + size.x; ++x)
                    out.push_back(depth * lengths[1][std::size_t(y)] * lengths[0][std::size_t(x)]);
        }
        return out;
    }

    BrickSums brick(glm::ivec3 index, BinSet& bins) const {
        const std::size_t channels = query_.channels.size();
        BrickSums sums;
        sums.inside.resize(channels);
        sums.outside.resize(channels);
        sums.pairs.resize(query_.pairs.size());
        sums.focusPairs.resize(query_.pairs.size());
        std::vector<Column> columns;
        for (std::size_t c = 0; c < channels; ++c) columns.push_back(column(c, index));
        const std::vector<double> cell = cells(index);
        const std::size_t count = cell.size();

        if (bins.samples + count > kFlush) bins.flush();
        bins.samples += count;
        std::vector<std::uint64_t> packed(count, packedSample(1));
        std::vector<float> inside(query_.doi ? count : 0), values(channels);
        const double volume = query_.doi ? 0 : std::accumulate(cell.begin(), cell.end(), 0.0);
        SamplePositions position(grid_, index, query_.level);
        for (std::size_t i = 0; query_.doi && i < count; ++i, position.next()) {
            for (std::size_t c = 0; c < channels; ++c) values[c] = columns[c].value[i];
            const double doi = std::clamp(query_.doi(values, position.at()), 0.0, 1.0);
            packed[i] = packedSample(doi);
            inside[i] = float(doi);
        }
        for (std::size_t c = 0; c < channels; ++c) {
            std::vector<std::uint64_t>& histogram = bins.channels[c].packed;
            for (std::size_t i = 0; i < count; ++i)
                if (columns[c].present[i] != 0) histogram[columns[c].bin[i]] += packed[i];
            if (query_.binsByVolume)
                addVolumes(bins.channels[c], cell, inside, {0, count, cell.data(), nullptr}, [&](std::size_t i) {
                    return columns[c].present[i] != 0 ? std::size_t(columns[c].bin[i]) : std::size_t(query_.bins);
                });
            if (!query_.doi && columns[c].whole && columns[c].rest.empty()) {
                sums.inside[c].add(columns[c], shifts_[c], cell, volume);
                continue;
            }
            for (std::size_t i = 0; i < count; ++i) {
                if (columns[c].present[i] == 0) continue;
                const double weight = query_.doi ? double(inside[i]) : 1.0;
                sums.inside[c].add(columns[c].exact(i), shifts_[c], cell[i], weight);
                // Values exactly half-way are inside.
                sums.outside[c].add(columns[c].exact(i), shifts_[c], cell[i],
                                    weight == 0.5 ? std::nextafter(0.5, 0.0) : 1 - weight);
            }
        }
        std::vector<double> focused(inside.size());
        for (std::size_t i = 0; i < inside.size(); ++i) focused[i] = double(inside[i]) * cell[i];
        for (std::size_t begin = 0; begin < count; begin += kTogether) {
            const std::size_t end = std::min(begin + kTogether, count);
            const Stretch all{begin, end, cell.data(), nullptr}, focus{begin, end, focused.data(), inside.data()};
            addPairs(columns, packed, all, focus, bins, sums);
            for (std::size_t p = 0; query_.binsByVolume && p < query_.pairs.size(); ++p) {
                const Column &x = columns[std::size_t(query_.pairs[p][0])],
                             &y = columns[std::size_t(query_.pairs[p][1])];
                addVolumes(bins.pairs[p], cell, inside, all,
                           [&](std::size_t i) { return y.bin[i] * stride() + x.bin[i]; });
            }
        }
        if (!query_.doi) sums.focusPairs = sums.pairs;
        return sums;
    }

    /// A volume as an integer, so that sums do not depend on the order; what is there counts.
    std::uint64_t units(double volume, double unit) const {
        return volume > 0 ? std::uint64_t(std::max(volume / unit, 1.0) + 0.5) : 0;
    }

    /// Adds the volume of samples to the bins that `binOf(i)` says.
    void addVolumes(Bins& bins, const std::vector<double>& cell, const std::vector<float>& inside,
                    const Stretch& stretch, const auto& binOf) const {
        const double unit = std::ldexp(box_, -kVolumeBits);
        for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
            const std::size_t bin = binOf(i);
            bins.volume[bin] += units(cell[i], unit);
            bins.focusVolume[bin] += units(inside.empty() ? cell[i] : double(inside[i]) * cell[i], unit);
        }
    }

    /// Adds a run of samples to every pair while its values are in the processor's cache.
    void addPairs(const std::vector<Column>& columns, const std::vector<std::uint64_t>& packed, const Stretch& all,
                  const Stretch& focus, BinSet& bins, BrickSums& sums) const {
        std::vector<Moments> moments(columns.size()), focusMoments(columns.size());
        for (std::size_t c = 0; c < columns.size() && !query_.pairs.empty(); ++c) {
            if (!columns[c].whole) continue;
            moments[c] = Moments::of(columns[c], all);
            if (query_.doi) focusMoments[c] = Moments::of(columns[c], focus);
        }
        for (std::size_t p = 0; p < query_.pairs.size(); ++p) {
            const std::size_t a = std::size_t(query_.pairs[p][0]), b = std::size_t(query_.pairs[p][1]);
            const Column &x = columns[a], &y = columns[b];
            std::vector<std::uint64_t>& histogram = bins.pairs[p].packed;
            for (std::size_t i = all.begin; i < all.end; ++i) histogram[y.bin[i] * stride() + x.bin[i]] += packed[i];
            if (query_.meanOf >= 0) addThird(bins.pairs[p], x, y, columns[std::size_t(query_.meanOf)], all);
            sums.pairs[p].add(x, y, moments[a], moments[b], all);
            if (query_.doi) sums.focusPairs[p].add(x, y, focusMoments[a], focusMoments[b], focus);
        }
    }

    /// Adds the value of a third channel to the bins of a pair, as integers, whose sum does not depend on the order.
    void addThird(Bins& bins, const Column& x, const Column& y, const Column& third, const Stretch& stretch) const {
        const Range& range = ranges_[std::size_t(query_.meanOf)];
        const double scale = range.hi > range.lo ? 65535 / (range.hi - range.lo) : 0;
        const double unit = std::ldexp(box_, -kThirdBits);
        for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
            if (third.present[i] == 0) continue;
            const std::size_t at = y.bin[i] * stride() + x.bin[i];
            const std::uint64_t weight = units(stretch.weight[i], unit);
            bins.third[at] +=
                weight * std::uint64_t(std::clamp((double(third.value[i]) - range.lo) * scale, 0.0, 65535.0) + 0.5);
            bins.thirdVolume[at] += weight;
        }
    }

    std::vector<double> thirdMeans(const Bins& bins) const {
        std::vector<double> means;
        if (query_.meanOf < 0) return means;
        const Range& range = ranges_[std::size_t(query_.meanOf)];
        for (int row = 0; row < query_.bins; ++row)
            for (int bin = 0; bin < query_.bins; ++bin) {
                const std::size_t at = std::size_t(row) * stride() + std::size_t(bin);
                const double n = double(bins.thirdVolume[at]);
                means.push_back(n > 0 ? range.lo + double(bins.third[at]) / n / 65535 * (range.hi - range.lo) : kNan);
            }
        return means;
    }

    /// Removes the extra bins for values that belong in none; `rows` is 1 or the number of bins.
    void unpack(const Bins& bins, int rows, std::vector<std::uint64_t>& count, std::vector<double>& focus) const {
        for (int row = 0; row < rows; ++row)
            for (int bin = 0; bin < query_.bins; ++bin) {
                const std::size_t at = std::size_t(row) * stride() + std::size_t(bin);
                count.push_back(bins.count[at]);
                focus.push_back(double(bins.focus[at]) / (1 << kFocusBits));
            }
    }

    /// The volumes of bins, without the extra ones; empty if they are not asked for.
    std::vector<double> volumes(const std::vector<std::uint64_t>& of, int rows) const {
        std::vector<double> out;
        for (int row = 0; row < rows && !of.empty(); ++row)
            for (int bin = 0; bin < query_.bins; ++bin)
                out.push_back(std::ldexp(double(of[std::size_t(row) * stride() + std::size_t(bin)]), -kVolumeBits) *
                              box_);
        return out;
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
            unpack(bins.channels[c], 1, channel.histogram.count, channel.histogram.focus);
            channel.histogram.volume = volumes(bins.channels[c].volume, 1);
            channel.histogram.focusVolume = volumes(bins.channels[c].focusVolume, 1);
            channel.all = all.summary(shifts_[c]);
            channel.all.samples =
                std::round(channel.all.samples); // an integer, since each sample contributes d + (1 - d)
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
            unpack(bins.pairs[p], query_.bins, joint.count, joint.focus);
            joint.volume = volumes(bins.pairs[p].volume, query_.bins);
            joint.focusVolume = volumes(bins.pairs[p].focusVolume, query_.bins);
            joint.samples = std::uint64_t(all.samples);
            joint.correlation = all.correlation();
            joint.focusCorrelation = focus.correlation();
            joint.outsideCorrelation = all.without(focus).correlation();
            joint.mean = thirdMeans(bins.pairs[p]);
            out.joint.push_back(std::move(joint));
        }
        return out;
    }

    const BrickSource& source_;
    const StatisticsQuery& query_;
    const BrickGrid grid_;
    int sublattices_;
    double box_ = 0; ///< volume of all cells
    std::vector<Range> ranges_;
    std::vector<double> shifts_;
    std::array<std::array<std::vector<double>, 3>, 2> lengths_; ///< [sublattice][axis][sample]: of the sample's cell
};

} // namespace

std::vector<std::array<int, 2>> allPairs(int count) {
    std::vector<std::array<int, 2>> pairs;
    for (int j = 1; j < count; ++j)
        for (int i = 0; i < j; ++i) pairs.push_back({i, j});
    return pairs;
}

Statistics computeStatistics(const BrickSource& source, const StatisticsQuery& query, const Progress& progress) {
    assert(query.bins > 0 && query.bins < 65535 && query.level >= 0 && query.level < source.grid().levels);
    return Accumulator(source, query).run(progress);
}

} // namespace tessera::volume
