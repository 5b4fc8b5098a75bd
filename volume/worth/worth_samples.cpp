#include "volume/worth/worth_samples.h"

#include "volume/base/parallel.h"
#include "volume/bricks/sample_position.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <utility>

namespace tessera::volume {

namespace {

constexpr float kAbsentSample = std::numeric_limits<float>::quiet_NaN();

std::vector<float> presentValues(const BrickSource& source, const BrickKey& key) {
    BrickSamples read = source.read(key);
    for (std::size_t i = 0; i < read.values.size(); ++i)
        if (!read.isPresent(i) || !std::isfinite(read.values[i])) read.values[i] = kAbsentSample;
    return std::move(read.values);
}

/// Fills what a brick covers.
void readBrick(const BrickSource& source, const WorthSamplesQuery& query, glm::ivec3 brick, std::vector<float>& labels,
               WorthSamples& out) {
    const BrickGrid& grid = source.grid();
    const int every = grid.lattice.kind == LatticeKind::BCC ? 2 : 1; // slices of the even sublattice
    const glm::ivec3 first = grid.levelBegin(brick, query.level), size = grid.brickSamples(brick, query.level);
    const auto forSamples = [&](auto&& visit) {
        for (int z = 0; z < size.z; ++z) {
            if ((first.z + z) % every != 0) continue;
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x)
                    visit((std::size_t(z) * std::size_t(size.y) + std::size_t(y)) * std::size_t(size.x) +
                              std::size_t(x),
                          (std::size_t((first.z + z) / every) * std::size_t(out.size.y) + std::size_t(first.y + y)) *
                                  std::size_t(out.size.x) +
                              std::size_t(first.x + x));
        }
    };
    const auto valuesOf = [&](int channel) { return presentValues(source, {channel, query.time, query.level, brick}); };
    for (std::size_t c = 0; c < query.channels.size(); ++c) {
        const std::vector<float> values = valuesOf(query.channels[c]);
        forSamples([&](std::size_t from, std::size_t to) { out.values[c][to] = values[from]; });
    }
    if (query.label >= 0) {
        const std::vector<float> values = valuesOf(query.label);
        forSamples([&](std::size_t from, std::size_t to) { labels[to] = values[from]; });
    }
    if (!query.doi) return;
    std::vector<std::vector<float>> of;
    for (const int channel : query.doiChannels) of.push_back(valuesOf(channel));
    std::vector<float> values(of.size());
    forSamples([&](std::size_t from, std::size_t to) {
        for (std::size_t c = 0; c < of.size(); ++c) values[c] = of[c][from];
        out.inside[to] = query.doi(values, out.placeOf(to)) >= 0.5 ? 1 : 0;
    });
}

void findGroups(const std::vector<float>& labels, WorthSamples& out) {
    constexpr std::size_t kMost = 255; // groups have a byte
    std::map<int, std::size_t> counts;
    for (const float label : labels)
        if (!std::isnan(label)) ++counts[int(std::lround(label))];
    std::vector<std::pair<std::size_t, int>> largest;
    for (const auto& [value, count] : counts) largest.emplace_back(count, value);
    std::ranges::stable_sort(largest, [](const auto& a, const auto& b) { return a.first > b.first; });
    out.regionsLeft = largest.size() - std::min(largest.size(), kMost);
    largest.resize(largest.size() - out.regionsLeft);
    for (const auto& [count, value] : largest) out.regions.push_back(value);
    std::ranges::sort(out.regions);
    out.group.assign(labels.size(), 0);
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (std::isnan(labels[i])) continue;
        const auto found = std::ranges::lower_bound(out.regions, int(std::lround(labels[i])));
        if (found != out.regions.end() && *found == int(std::lround(labels[i])))
            out.group[i] = std::uint8_t(1 + (found - out.regions.begin()));
    }
}

} // namespace

WorthSamples readWorthSamples(const BrickSource& source, const WorthSamplesQuery& query, const Progress& progress) {
    const BrickGrid& grid = source.grid();
    const bool bcc = grid.lattice.kind == LatticeKind::BCC;
    WorthSamples out;
    out.size = grid.levelSamples(query.level);
    if (bcc) out.size.z = (out.size.z + 1) / 2;
    out.channels = query.channels;
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < out.size[axis]; ++i) {
            glm::ivec3 at(0);
            at[axis] = bcc && axis == 2 ? 2 * i : i;
            out.places[std::size_t(axis)].push_back(samplePosition(grid, at, query.level)[axis]);
        }
    out.values.assign(query.channels.size(), std::vector<float>(out.count(), kAbsentSample));
    if (query.doi) out.inside.assign(out.count(), 0);
    std::vector<float> labels(query.label >= 0 ? out.count() : 0, kAbsentSample);
    const std::size_t bricks = grid.brickCount();
    std::atomic<std::size_t> done = 0;
    std::mutex reporting;
    progress.advance(0, "samples");
    parallelFor(bricks, [&](std::size_t i) {
        if (progress.stop.stop_requested()) throw Cancelled();
        readBrick(source, query, grid.indexOf(i), labels, out);
        const std::size_t finished = ++done;
        if (const std::unique_lock lock(reporting, std::try_to_lock); lock)
            progress.advance(double(finished) / double(bricks), "samples");
    });
    if (query.label >= 0) findGroups(labels, out);
    return out;
}

void keepInside(WorthSamples& samples) {
    if (samples.inside.empty()) return;
    for (std::vector<float>& values : samples.values)
        for (std::size_t i = 0; i < values.size(); ++i)
            if (samples.inside[i] == 0) values[i] = kAbsentSample;
}

std::vector<std::uint8_t> anyPresent(const WorthSamples& samples) {
    std::vector<std::uint8_t> present(samples.count());
    for (const std::vector<float>& values : samples.values)
        for (std::size_t i = 0; i < values.size(); ++i)
            if (!std::isnan(values[i])) present[i] = 1;
    return present;
}

} // namespace tessera::volume
