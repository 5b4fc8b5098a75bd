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
    /// `now`: the one time between stored ones at which the formula is computed; none: it is computed at stored times.
    InputTime(std::shared_ptr<const BrickSource> source, int channel, const TimeReference& reference,
              const std::optional<TimePair>& now = {})
        : source_(std::move(source)), channel_(channel), reference_(reference), now_(now) {
        if (reference.which == OtherTime::Other) channel_ = *otherChannel(source_->info(), channel);
        const bool one = now_ || isFixed(reference);
        if (const auto fixed = one ? times(0) : std::nullopt; fixed && fixed->between())
            between_ = sourceAt(source_, *fixed).source;
    }
    /// The times referred to from a stored time; from the one between stored ones, between those that these refer to.
    std::optional<TimePair> times(int now) const {
        const std::vector<double>& all = source_->info().times;
        if (!now_) return timesOf(reference_, all, now);
        const auto a = timesOf(reference_, all, now_->earlier), b = timesOf(reference_, all, now_->later);
        if (a == b) return a;
        if (!a || !b) return now_->nearest() == now_->earlier ? a : b;
        return TimePair{a->earlier, b->earlier, now_->weight}; // only fixed times can be between stored ones
    }
    bool exists(int now) const { return times(now).has_value(); }
    /// The time itself.
    double time(int now) const { return timeAt(source_->info().times, *times(now)); }
    BrickSamples read(BrickKey key) const {
        key.channel = channel_;
        key.time = between_ ? 0 : times(key.time)->earlier;
        return (between_ ? between_ : source_)->read(key);
    }
    /// Whether the channel is known, without reading, to be unchanged in a brick between both stored times.
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
    std::optional<TimePair> now_;
};

} // namespace tessera::volume
