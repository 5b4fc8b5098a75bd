#include "volume/bricks/source_at_time.h"

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
        const auto at = [&](int i) { return info_.times[std::size_t(i)]; };
        info_.times = {(1 - time_.weight) * at(time_.earlier) + time_.weight * at(time_.later)};
        for (const Channel& channel : info_.channels()) {
            const Parameter& parameter = info_.parameters[std::size_t(channel.parameter)];
            label_.push_back(parameter.categorical);
            parts_.push_back({labelChannel(info_, parameter), parameter.parts});
        }
    }

    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return source_->grid(); }

    BrickStats stats(const BrickKey& key) const override {
        const BrickStats a = source_->stats(at(key, time_.earlier)), b = source_->stats(at(key, time_.later));
        if (!(a.presentFraction > 0)) return b;
        if (!(b.presentFraction > 0)) return a;
        return {std::min(a.min, b.min), std::max(a.max, b.max), std::max(a.presentFraction, b.presentFraction)};
    }

    BrickSamples read(const BrickKey& key) const override {
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
            near.values[i] = float((1 - weight) * double(near.values[i]) + weight * double(far.values[i]));
        }
        return near;
    }

private:
    static BrickKey at(BrickKey key, int time) {
        key.time = time;
        return key;
    }

    std::shared_ptr<const BrickSource> source_;
    TimePair time_;
    DatasetInfo info_;
    std::vector<bool> label_;                                 ///< by channel
    std::vector<std::pair<std::optional<int>, Parts>> parts_; ///< by channel: that of the label, if it has parts
};

} // namespace

SourceAtTime sourceAt(std::shared_ptr<const BrickSource> source, const TimePair& time) {
    if (!time.between()) return {std::move(source), time.earlier};
    return {std::make_shared<SourceBetweenTimes>(std::move(source), time), 0};
}

} // namespace tessera::volume
