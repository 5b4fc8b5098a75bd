#include "volume/analysis/region_statistics.h"

#include "volume/analysis/statistics_sums.h"
#include "volume/bricks/brick_columns.h"
#include "volume/bricks/sample_cells.h"
#include "volume/bricks/sample_position.h"

#include <algorithm>

namespace tessera::volume {

namespace {

/// Sums over one brick, for each of R regions, then for all samples as region R.
struct BrickRegions {
    std::vector<double> samples, volume;
    std::vector<Sums> sums; ///< [region * channels + channel]
};

} // namespace

RegionStatistics computeRegionStatistics(const BrickSource& source, const RegionStatisticsQuery& query,
                                         const Progress& progress) {
    const BrickGrid grid = source.grid();
    const SampleCells cells(grid, source.info().bounds, query.level);
    const std::size_t channels = query.channels.size();
    const std::size_t regions = query.label >= 0 ? query.regions.size() : 0;
    const std::vector<Channel> all = source.info().channels();
    std::vector<double> shifts;
    for (const int channel : query.channels) {
        const Range range = source.info().channelRange(all.at(std::size_t(channel)));
        shifts.push_back(0.5 * (range.lo + range.hi));
    }
    const auto empty = [&] {
        return BrickRegions{std::vector<double>(regions + 1), std::vector<double>(regions + 1),
                            std::vector<Sums>((regions + 1) * channels)};
    };
    BrickRegions total = empty();
    inBrickOrder(
        allBricks(grid),
        [&](glm::ivec3 index) {
            BrickRegions out = empty();
            const auto columns = brickColumns(source, query.channels, query.time, index, query.level);
            const std::vector<double> label = brickColumn(source, query.label, query.time, index, query.level);
            std::vector<float> values(channels);
            forSamples(grid, index, query.level, [&](std::size_t i, glm::ivec3 at) {
                const double volume = cells.volume(at);
                const int region = regions > 0 ? regionOf(query.regions, label[i]) : -1;
                double interest = 1;
                if (query.doi) {
                    for (std::size_t c = 0; c < channels; ++c) values[c] = float(columns[c][i]);
                    interest = std::clamp(query.doi(values, samplePosition(grid, at, query.level)), 0.0, 1.0);
                }
                const auto count = [&](std::size_t r, double share) {
                    out.samples[r] += share;
                    out.volume[r] += share * volume;
                    for (std::size_t c = 0; c < channels; ++c)
                        if (!std::isnan(columns[c][i]))
                            out.sums[r * channels + c].add(columns[c][i], shifts[c], volume, interest);
                };
                if (region >= 0) count(std::size_t(region), interest);
                count(regions, 1);
            });
            return out;
        },
        [&](const BrickRegions& part) {
            for (std::size_t r = 0; r <= regions; ++r) {
                total.samples[r] += part.samples[r];
                total.volume[r] += part.volume[r];
            }
            for (std::size_t i = 0; i < total.sums.size(); ++i) total.sums[i].add(part.sums[i]);
        },
        [&](double fraction) { progress.advance(fraction, "statistics"); });
    RegionStatistics out;
    out.regions = query.label >= 0 ? query.regions : std::vector<int>();
    out.allSamples = total.samples[regions];
    out.allVolume = total.volume[regions];
    out.samples.assign(total.samples.begin(), total.samples.end() - 1);
    out.volume.assign(total.volume.begin(), total.volume.end() - 1);
    for (std::size_t r = 0; r <= regions; ++r) {
        std::vector<Summary> summaries;
        for (std::size_t c = 0; c < channels; ++c) summaries.push_back(total.sums[r * channels + c].summary(shifts[c]));
        if (r < regions)
            out.summary.push_back(std::move(summaries));
        else
            out.all = std::move(summaries);
    }
    return out;
}

} // namespace tessera::volume
