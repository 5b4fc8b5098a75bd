#include "volume/sources/memory_source.h"

#include "volume/base/error.h"
#include "volume/base/load_once.h"
#include "volume/base/parallel.h"
#include "volume/bricks/brick_importance.h"
#include "volume/bricks/field_bricks.h"
#include "volume/bricks/magnitude.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/field/part_masks.h"
#include "volume/resample/resample.h"

#include <algorithm>
#include <compare>
#include <functional>
#include <map>
#include <mutex>

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

int chooseLevels(const Lattice& lattice, int brickSize) {
    constexpr int kCoarsestEdge = 4; // texels
    const glm::ivec3 texels = lattice.texels();
    const int longest = std::max({texels.x, texels.y, texels.z});
    int levels = 1;
    while ((std::min(brickSize, longest) >> levels) >= kCoarsestEdge) ++levels;
    return levels;
}

bool isResampled(const DatasetInfo& info, const MemorySourceOptions& options) {
    return options.lattice == LatticeKind::BCC && info.lattice.kind == LatticeKind::CC;
}

class MemorySource final : public BrickSource {
public:
    MemorySource(const Dataset& dataset, const MemorySourceOptions& options)
        : dataset_(isResampled(dataset.info, options) ? withParts(dataset) : dataset), info_(dataset_.info),
          frames_(
              options.budget, [this](const FrameKey& key) { return loadFrame(key); }, fieldBytes) {
        if (options.brickSize < 1 || (options.brickSize & (options.brickSize - 1)) != 0)
            throw Error("brick size " + std::to_string(options.brickSize) + " is not a power of two");
        if (isResampled(info_, options)) info_.lattice = bccFor(info_.lattice);
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
        if (!channel.magnitude)
            return frameStats({channel.parameter, channel.component, key.time})[grid_.numberOf(key.index)];
        std::vector<BrickStats> components;
        for (int c = 0; c < channel.component; ++c)
            components.push_back(frameStats({channel.parameter, c, key.time})[grid_.numberOf(key.index)]);
        return magnitudeStats(components);
    }

    std::optional<BrickImportance> importance(const BrickKey& key) const override {
        const Channel& channel = channelOf(key);
        if (!channel.magnitude)
            return frameImportance({channel.parameter, channel.component, key.time})[grid_.numberOf(key.index)];
        std::vector<BrickImportance> components;
        for (int c = 0; c < channel.component; ++c)
            components.push_back(frameImportance({channel.parameter, c, key.time})[grid_.numberOf(key.index)]);
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
        return magnitude(components);
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

    FramePtr loadFrame(const FrameKey& key) const {
        Field field;
        {
            const std::lock_guard lock(loading_);
            field = dataset_.read(key.parameter, key.component, key.time);
        }
        if (field.lattice.size != dataset_.info.lattice.size || field.lattice.kind != dataset_.info.lattice.kind ||
            field.samples.size() != field.count() * byteSize(field.type))
            throw Error("a time has another number of samples than the data set", info_.name,
                        parameter(key.parameter).name);
        // Comparing two frames requires numbers of the same type.
        if (field.type != parameter(key.parameter).type)
            throw Error("a time holds " + std::string(name(field.type)) + ", the parameter is " +
                            std::string(name(parameter(key.parameter).type)),
                        info_.name, parameter(key.parameter).name);
        if (field.lattice.kind != grid_.lattice.kind) field = toBcc(field, parameter(key.parameter).categorical);
        return std::make_shared<const Field>(withoutParts(std::move(field)));
    }

    BrickSamples readComponent(const BrickKey& key, int p, int component) const {
        const FramePtr frame = frames_.get({p, component, key.time});
        if (key.level == 0) return fineBrick(*frame, grid_.begin(key.index), grid_.end(key.index));
        if (const int label = labelOf(info_, parameter(p)); label >= 0) {
            const FramePtr labels = frames_.get({label, 0, key.time});
            const glm::ivec3 begin = grid_.begin(key.index), end = grid_.end(key.index);
            const BrickSamples fine = fineBrick(*labels, begin, end);
            const Parts& parts = parameter(p).parts;
            const std::vector<std::uint8_t> own = partsOfSamples(fine, parts);
            if (std::adjacent_find(own.begin(), own.end(), std::not_equal_to<>()) != own.end())
                return coarserOfParts(grid_, key.level, fineBrick(*frame, begin, end), fine,
                                      coarseBrick(*labels, grid_, key, true), parts);
        }
        return coarseBrick(*frame, grid_, key, parameter(p).categorical);
    }

    /// Statistics of every brick of a frame, x fastest; made at the first question and kept.
    const std::vector<BrickStats>& frameStats(const FrameKey& key) const {
        {
            const std::lock_guard lock(statsMutex_);
            if (const auto found = stats_.find(key); found != stats_.end()) return found->second;
        }
        const FramePtr frame = frames_.get(key);
        std::vector<BrickStats> all(grid_.brickCount());
        parallelFor(all.size(), [&](std::size_t i) {
            const glm::ivec3 brick = grid_.indexOf(i);
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

} // namespace tessera::volume
