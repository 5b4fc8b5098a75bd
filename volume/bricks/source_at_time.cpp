#include "volume/bricks/source_at_time.h"

#include "volume/bricks/magnitude.h"
#include "volume/bricks/parts_bricks.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace tessera::volume {

namespace {

class SourceBetweenTimes final : public BrickSource {
public:
    SourceBetweenTimes(std::shared_ptr<const BrickSource> source, const TimePair& time)
        : source_(std::move(source)), time_(time), info_(source_->info()) {
        info_.times = {timeAt(info_.times, time_)};
        channels_ = info_.channels();
        const auto* computes = dynamic_cast<const ComputesBetweenTimes*>(source_.get());
        for (std::size_t i = 0; i < channels_.size(); ++i) {
            const Parameter& parameter = info_.parameters[std::size_t(channels_[i].parameter)];
            label_.push_back(parameter.categorical);
            parts_.push_back({labelChannel(info_, parameter), parameter.parts});
            ofComputed_.push_back(computes && computes->computes(int(i)));
            if (ofComputed_.back() && !computed_) computed_ = computes->computedAt(time_);
        }
    }

    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return source_->grid(); }

    BrickStats stats(const BrickKey& key) const override {
        if (ofComputed_[std::size_t(key.channel)]) return computed_->stats(at(key, 0));
        if (channels_[std::size_t(key.channel)].magnitude) {
            std::vector<BrickStats> components;
            for (const BrickKey& component : componentsOf(key)) components.push_back(stats(component));
            return magnitudeStats(components);
        }
        const BrickStats a = source_->stats(at(key, time_.earlier)), b = source_->stats(at(key, time_.later));
        if (!(a.presentFraction > 0)) return b;
        if (!(b.presentFraction > 0)) return a;
        return {std::min(a.min, b.min), std::max(a.max, b.max), std::max(a.presentFraction, b.presentFraction)};
    }

    BrickSamples read(const BrickKey& key) const override {
        if (ofComputed_[std::size_t(key.channel)]) return computed_->read(at(key, 0));
        if (channels_[std::size_t(key.channel)].magnitude) {
            std::vector<BrickSamples> components;
            for (const BrickKey& component : componentsOf(key)) components.push_back(mixed(component));
            return magnitude(components);
        }
        return mixed(key);
    }

private:
    static BrickKey at(BrickKey key, int time) {
        key.time = time;
        return key;
    }
    /// The keys of the components of a magnitude, which come right before it.
    std::vector<BrickKey> componentsOf(BrickKey key) const {
        const int count = channels_[std::size_t(key.channel)].component, first = key.channel - count;
        std::vector<BrickKey> out;
        for (int c = 0; c < count; ++c) {
            key.channel = first + c;
            out.push_back(key);
        }
        return out;
    }
    BrickSamples mixed(const BrickKey& key) const {
        BrickSamples near = source_->read(at(key, time_.nearest()));
        if (label_[std::size_t(key.channel)]) return near;
        const bool later = time_.nearest() == time_.later;
        const BrickSamples far = source_->read(at(key, later ? time_.earlier : time_.later));
        const double weight = later ? 1 - time_.weight : time_.weight; // weight of the farther time
        std::vector<std::uint8_t> nearParts, farParts;
        if (const auto& [channel, parts] = parts_[std::size_t(key.channel)]; channel) {
            BrickKey label = key;
            label.channel = *channel;
            nearParts = partsOfSamples(source_->read(at(label, time_.nearest())), parts);
            farParts = partsOfSamples(source_->read(at(label, later ? time_.earlier : time_.later)), parts);
        }
        for (std::size_t i = 0; i < near.values.size(); ++i) {
            if (!near.isPresent(i)) continue;
            if (!far.isPresent(i)) continue;
            if (!nearParts.empty() && nearParts[i] != farParts[i]) continue;
            near.values[i] = float((1 - weight) * near.exact(i) + weight * far.exact(i));
            if (!near.rest.empty()) near.rest[i] = 0;
        }
        return near;
    }

    std::shared_ptr<const BrickSource> source_;
    TimePair time_;
    DatasetInfo info_;
    std::vector<Channel> channels_;
    std::shared_ptr<const BrickSource> computed_;             ///< null: no channel is computed
    std::vector<bool> ofComputed_;                            ///< by channel
    std::vector<bool> label_;                                 ///< by channel
    std::vector<std::pair<std::optional<int>, Parts>> parts_; ///< by channel: that of the label, if it has parts
};

} // namespace

bool isComputedBetween(const BrickSource& source, int channel) {
    if (source.info().channel(channel).magnitude) return true;
    const auto* computes = dynamic_cast<const ComputesBetweenTimes*>(&source);
    return computes && computes->computes(channel);
}

SourceAtTime sourceAt(std::shared_ptr<const BrickSource> source, const TimePair& time) {
    if (!time.between()) return {std::move(source), time.earlier};
    return {std::make_shared<SourceBetweenTimes>(std::move(source), time), 0};
}

} // namespace tessera::volume
