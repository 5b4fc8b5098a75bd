#include "volume/memory_source.h"

#include "volume/brick_importance.h"
#include "volume/error.h"
#include "volume/load_once.h"
#include "volume/parallel.h"
#include "volume/resample.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>
#include <map>
#include <mutex>
#include <span>

namespace tessera::volume {

namespace {

using FramePtr = std::shared_ptr<const Field>;

struct FrameKey {
    int parameter, component, time;
    auto operator<=>(const FrameKey&) const = default;
};

struct FrameKeyHash {
    std::size_t operator()(const FrameKey& key) const {
        return BrickKeyHash{}({key.parameter, key.time, key.component, glm::ivec3(0)});
    }
};

std::size_t fieldBytes(const Field& field) {
    return field.samples.size() + (field.mask ? field.mask->size() : 0);
}

/// The block of fine samples behind one level sample: mean of the present ones, or for labels the most frequent (the
/// smallest of equals). Present when at least half of the block is.
struct Block {
    bool categorical;
    double sum = 0;
    int present = 0, total = 0;
    std::vector<double> labels;

    void clear() {
        sum = 0;
        present = total = 0;
        labels.clear();
    }
    void add(double value, bool isPresent) {
        ++total;
        if (!isPresent) return;
        ++present;
        if (categorical)
            labels.push_back(value);
        else
            sum += value;
    }
    bool exists() const { return present > 0 && 2 * present >= total; }
    double value() {
        if (!categorical) return sum / present;
        std::sort(labels.begin(), labels.end());
        double best = labels.front();
        std::ptrdiff_t most = 0;
        for (auto run = labels.begin(); run != labels.end();) {
            const auto next = std::upper_bound(run, labels.end(), *run);
            if (next - run > most) {
                most = next - run;
                best = *run;
            }
            run = next;
        }
        return best;
    }
};

BrickSamples fineBrick(const Field& field, glm::ivec3 begin, glm::ivec3 end) {
    BrickSamples out;
    out.size = end - begin;
    const std::size_t total = std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z);
    out.values.resize(total);
    if (field.mask) out.present.resize(total);
    dispatch(field.type, [&]<class T>(T) {
        const auto stored = field.as<T>();
        std::size_t to = 0;
        for (int z = begin.z; z < end.z; ++z)
            for (int y = begin.y; y < end.y; ++y) {
                const std::size_t row = field.lattice.index({begin.x, y, z});
                const auto width = std::size_t(out.size.x);
                for (std::size_t x = 0; x < width; ++x)
                    out.values[to + x] = float(field.offset + field.scale * double(stored[row + x]));
                if (field.mask) std::copy_n(&(*field.mask)[row], width, &out.present[to]);
                to += width;
            }
    });
    if (std::all_of(out.present.begin(), out.present.end(), [](std::uint8_t p) { return p != 0; })) out.present.clear();
    return out;
}

BrickSamples coarseBrick(const Field& field, const BrickGrid& grid, const BrickKey& key, bool categorical) {
    const glm::ivec3 begin = grid.begin(key.index), end = grid.end(key.index);
    const BrickSamples fine = fineBrick(field, begin, end);
    const int slices = grid.lattice.kind == LatticeKind::BCC ? 2 : 1; // storage slices per texel
    const int step = 1 << key.level;
    BrickSamples out;
    out.size = grid.brickSamples(key.index, key.level);
    const std::size_t total = std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z);
    out.values.resize(total);
    if (!fine.present.empty()) out.present.resize(total);
    Block block{categorical, 0, 0, 0, {}};
    std::size_t to = 0;
    for (int z = 0; z < out.size.z; ++z)
        for (int y = 0; y < out.size.y; ++y)
            for (int x = 0; x < out.size.x; ++x, ++to) {
                block.clear();
                const int first = (z / slices) * step * slices + z % slices;
                for (int k = first; k < std::min(first + step * slices, fine.size.z); k += slices)
                    for (int j = y * step; j < std::min((y + 1) * step, fine.size.y); ++j)
                        for (int i = x * step; i < std::min((x + 1) * step, fine.size.x); ++i) {
                            const std::size_t at = (std::size_t(k) * std::size_t(fine.size.y) + std::size_t(j)) *
                                                       std::size_t(fine.size.x) +
                                                   std::size_t(i);
                            block.add(double(fine.values[at]), fine.present.empty() || fine.present[at] != 0);
                        }
                if (block.exists()) out.values[to] = float(block.value());
                if (!out.present.empty()) out.present[to] = block.exists() ? 1 : 0;
            }
    return out;
}

BrickStats brickStats(const Field& field, glm::ivec3 begin, glm::ivec3 end) {
    const BrickSamples brick = fineBrick(field, begin, end);
    BrickStats stats{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest(), 0};
    std::size_t present = 0;
    for (std::size_t i = 0; i < brick.values.size(); ++i) {
        if (!brick.present.empty() && brick.present[i] == 0) continue;
        ++present;
        stats.min = std::min(stats.min, brick.values[i]);
        stats.max = std::max(stats.max, brick.values[i]);
    }
    stats.presentFraction = float(double(present) / double(brick.values.size()));
    return stats;
}

BrickSamples magnitudeOf(std::span<const BrickSamples> components) {
    BrickSamples out;
    out.size = components.front().size;
    out.values.resize(components.front().values.size());
    for (std::size_t i = 0; i < out.values.size(); ++i) {
        double square = 0;
        for (const BrickSamples& component : components)
            square += double(component.values[i]) * double(component.values[i]);
        out.values[i] = float(std::sqrt(square));
    }
    for (const BrickSamples& component : components) {
        if (component.present.empty()) continue;
        if (out.present.empty()) out.present.assign(out.values.size(), 1);
        for (std::size_t i = 0; i < out.values.size(); ++i)
            if (component.present[i] == 0) out.present[i] = 0;
    }
    return out;
}

BrickStats magnitudeStatsOf(std::span<const BrickStats> components) {
    double low = 0, high = 0;
    BrickStats out;
    for (const BrickStats& component : components) {
        out.presentFraction = std::min(out.presentFraction, component.presentFraction);
        const double a = component.min, b = component.max;
        const double nearest = a <= 0 && b >= 0 ? 0 : std::min(std::abs(a), std::abs(b));
        low += nearest * nearest;
        high += std::max(a * a, b * b);
    }
    if (out.presentFraction == 0) return {std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest(), 0};
    out.min = std::nextafter(float(std::sqrt(low)), 0.0f);
    out.max = std::nextafter(float(std::sqrt(high)), std::numeric_limits<float>::max());
    return out;
}

int chooseLevels(const Lattice& lattice, int brickSize) {
    constexpr int kCoarsestEdge = 4; // texels
    const glm::ivec3 texels = lattice.texels();
    const int longest = std::max({texels.x, texels.y, texels.z});
    int levels = 1;
    while ((std::min(brickSize, longest) >> levels) >= kCoarsestEdge) ++levels;
    return levels;
}

class MemorySource final : public BrickSource {
public:
    MemorySource(Dataset dataset, const MemorySourceOptions& options)
        : dataset_(std::move(dataset)), info_(dataset_.info),
          frames_(
              options.budget, [this](const FrameKey& key) { return loadFrame(key); }, fieldBytes) {
        if (options.brickSize < 1 || (options.brickSize & (options.brickSize - 1)) != 0)
            throw Error("brick size " + std::to_string(options.brickSize) + " is not a power of two");
        if (options.lattice == LatticeKind::BCC && info_.lattice.kind == LatticeKind::CC)
            info_.lattice = bccFor(info_.lattice);
        grid_.lattice = info_.lattice;
        grid_.brickSize = options.brickSize;
        grid_.levels = chooseLevels(grid_.lattice, options.brickSize);
        grid_.phase = 0.5;
        channels_ = info_.channels();
    }

    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return grid_; }

    BrickStats stats(const BrickKey& key) const override {
        const Channel& channel = channelOf(key);
        if (!channel.magnitude) return frameStats({channel.parameter, channel.component, key.time})[brickIndex(key)];
        std::vector<BrickStats> components;
        for (int c = 0; c < channel.component; ++c)
            components.push_back(frameStats({channel.parameter, c, key.time})[brickIndex(key)]);
        return magnitudeStatsOf(components);
    }

    std::optional<BrickImportance> importance(const BrickKey& key) const override {
        const Channel& channel = channelOf(key);
        if (!channel.magnitude)
            return frameImportance({channel.parameter, channel.component, key.time})[brickIndex(key)];
        std::vector<BrickImportance> components;
        for (int c = 0; c < channel.component; ++c)
            components.push_back(frameImportance({channel.parameter, c, key.time})[brickIndex(key)]);
        return magnitudeImportance(components);
    }

    std::optional<BrickChange> change(const BrickKey& key, int toTime) const override {
        const Channel& channel = channelOf(key);
        if (toTime < 0 || std::size_t(toTime) >= info_.times.size()) throw Error("no such time", info_.name);
        const auto of = [&](int component) {
            const FramePtr from = frames_.get({channel.parameter, component, key.time}),
                           to = frames_.get({channel.parameter, component, toTime});
            return changeOfBrick(grid_, key.index, *from, *to);
        };
        if (key.time == toTime) return BrickChange{};
        if (!channel.magnitude) return of(channel.component);
        std::vector<BrickChange> components;
        for (int c = 0; c < channel.component; ++c) components.push_back(of(c));
        return magnitudeChange(components);
    }

    BrickSamples read(const BrickKey& key) const override {
        const Channel& channel = channelOf(key);
        if (!channel.magnitude) return readComponent(key, channel.parameter, channel.component);
        std::vector<BrickSamples> components;
        for (int c = 0; c < channel.component; ++c) components.push_back(readComponent(key, channel.parameter, c));
        return magnitudeOf(components);
    }

private:
    const Parameter& parameter(int index) const { return info_.parameters[std::size_t(index)]; }

    const Channel& channelOf(const BrickKey& key) const {
        const glm::ivec3 count = grid_.count();
        if (key.channel < 0 || std::size_t(key.channel) >= channels_.size() || key.time < 0 ||
            std::size_t(key.time) >= info_.times.size() || key.level < 0 || key.level >= grid_.levels ||
            key.index.x < 0 || key.index.y < 0 || key.index.z < 0 || key.index.x >= count.x || key.index.y >= count.y ||
            key.index.z >= count.z)
            throw Error("no such brick", info_.name);
        return channels_[std::size_t(key.channel)];
    }

    std::size_t brickIndex(const BrickKey& key) const {
        const glm::ivec3 count = grid_.count();
        return std::size_t((key.index.z * count.y + key.index.y) * count.x + key.index.x);
    }

    FramePtr loadFrame(const FrameKey& key) const {
        Field field;
        {
            const std::lock_guard lock(loading_);
            field = dataset_.load(key.parameter, key.component, key.time);
        }
        if (field.lattice.size != dataset_.info.lattice.size || field.lattice.kind != dataset_.info.lattice.kind ||
            field.samples.size() != field.count() * byteSize(field.type))
            throw Error("a frame has another number of samples than the data set", info_.name,
                        parameter(key.parameter).name);
        if (field.lattice.kind != grid_.lattice.kind) field = toBcc(field, parameter(key.parameter).categorical);
        return std::make_shared<const Field>(std::move(field));
    }

    BrickSamples readComponent(const BrickKey& key, int p, int component) const {
        const FramePtr frame = frames_.get({p, component, key.time});
        if (key.level == 0) return fineBrick(*frame, grid_.begin(key.index), grid_.end(key.index));
        return coarseBrick(*frame, grid_, key, parameter(p).categorical);
    }

    /// Statistics of every brick of a frame, x fastest; made at the first question and kept.
    const std::vector<BrickStats>& frameStats(const FrameKey& key) const {
        {
            const std::lock_guard lock(statsMutex_);
            if (const auto found = stats_.find(key); found != stats_.end()) return found->second;
        }
        const FramePtr frame = frames_.get(key);
        const glm::ivec3 count = grid_.count();
        std::vector<BrickStats> all(std::size_t(count.x * count.y * count.z));
        parallelFor(all.size(), [&](std::size_t i) {
            const int n = int(i);
            const glm::ivec3 brick(n % count.x, n / count.x % count.y, n / (count.x * count.y));
            all[i] = brickStats(*frame, grid_.begin(brick), grid_.end(brick));
        });
        const std::lock_guard lock(statsMutex_);
        return stats_.try_emplace(key, std::move(all)).first->second;
    }

    /// Importance of every brick of a frame; made at the first question and kept.
    const std::vector<BrickImportance>& frameImportance(const FrameKey& key) const {
        {
            const std::lock_guard lock(statsMutex_);
            if (const auto found = importance_.find(key); found != importance_.end()) return found->second;
        }
        const FramePtr frame = frames_.get(key);
        const Parameter& about = parameter(key.parameter);
        const std::size_t component = std::size_t(key.component);
        const Range range = component < about.ranges.size() ? about.ranges[component] : Range{1, 0};
        std::vector<BrickImportance> all = importanceOfBricks(grid_, *frame, range, about.categorical);
        const std::lock_guard lock(statsMutex_);
        return importance_.try_emplace(key, std::move(all)).first->second;
    }

    Dataset dataset_;
    DatasetInfo info_;
    BrickGrid grid_;
    std::vector<Channel> channels_;
    mutable std::mutex loading_;
    mutable LoadOnce<FrameKey, Field, FrameKeyHash> frames_;
    mutable std::mutex statsMutex_;
    mutable std::map<FrameKey, std::vector<BrickStats>> stats_;
    mutable std::map<FrameKey, std::vector<BrickImportance>> importance_;
};

} // namespace

std::shared_ptr<const BrickSource> makeMemorySource(Dataset dataset, const MemorySourceOptions& options) {
    return std::make_shared<const MemorySource>(std::move(dataset), options);
}

BrickSamples magnitude(const BrickSamples& x, const BrickSamples& y, const BrickSamples& z) {
    const BrickSamples components[] = {x, y, z};
    return magnitudeOf(components);
}

BrickStats magnitudeStats(const BrickStats& x, const BrickStats& y, const BrickStats& z) {
    const BrickStats components[] = {x, y, z};
    return magnitudeStatsOf(components);
}

} // namespace tessera::volume
