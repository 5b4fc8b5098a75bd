#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/bricks/source_at_time.h"
#include "volume/derived/other_source.h"
#include "volume/derived/other_time.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace tessera::volume {

/// The time that a formula or a difference refers to.
class InputTime {
public:
    InputTime(std::shared_ptr<const BrickSource> source, int channel, const TimeReference& reference)
        : source_(std::move(source)), channel_(channel), reference_(reference) {
        if (reference.which == OtherTime::Other) channel_ = *otherChannel(source_->info(), channel);
        if (const auto fixed = isFixed(reference) ? times(0) : std::nullopt; fixed && fixed->between())
            between_ = sourceAt(source_, *fixed).source;
    }
    std::optional<TimePair> times(int now) const { return timesOf(reference_, source_->info().times, now); }
    bool exists(int now) const { return times(now).has_value(); }
    /// The time itself.
    double time(int now) const {
        const std::vector<double>& all = source_->info().times;
        const TimePair at = *times(now);
        return (1 - at.weight) * all[std::size_t(at.earlier)] + at.weight * all[std::size_t(at.later)];
    }
    BrickSamples read(BrickKey key) const {
        key.channel = channel_;
        key.time = between_ ? 0 : times(key.time)->earlier;
        return (between_ ? between_ : source_)->read(key);
    }
    /// Whether the channel is known, without reading, to be unchanged in a brick between both times.
    bool stays(BrickKey key, int toTime) const {
        const std::optional<TimePair> from = times(key.time), to = times(toTime);
        if (from == to) return true;
        if (!from || !to) return false;
        key.channel = channel_;
        key.time = from->earlier; // only fixed times can be between stored ones
        const std::optional<BrickChange> change = source_->change(key, to->earlier);
        return change && change->max == 0;
    }

private:
    std::shared_ptr<const BrickSource> source_, between_;
    int channel_;
    TimeReference reference_;
};

} // namespace tessera::volume
