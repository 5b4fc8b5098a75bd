#include "volume/derived/derived.h"

#include "volume/base/error.h"
#include "volume/bricks/brick_source.h"
#include "volume/bricks/magnitude.h"
#include "volume/bricks/source_at_time.h"
#include "volume/derived/derived_bricks.h"
#include "volume/derived/derived_names.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <unordered_map>
#include <utility>

namespace tessera::volume {

namespace {

constexpr double kRangeSamples = 3e6; // samples read to find a range, over all times

bool isZero(Range range) {
    return range.lo == 0 && range.hi == 0;
}

class DerivedSource final : public BrickSource, public ComputesBetweenTimes {
public:
    /// `known`: the ranges; empty: compute them.
    DerivedSource(std::shared_ptr<const BrickSource> source, DerivedParameter derived, const Progress& progress,
                  std::vector<Range> known = {})
        : below_(std::move(source)), bricks_(below_, derived.recipe), derived_(std::move(derived)),
          info_(below_->info()), first_(int(info_.channels().size())) {
        Parameter parameter;
        parameter.name = derived_.name;
        parameter.unit = derived_.unit;
        parameter.components = componentsOf(derived_.recipe);
        parameter.parts = partsOf(derived_.recipe, info_);
        parameter.categorical = kindOf(derived_.recipe).categorical;
        if (parameter.categorical) parameter.labels = {{0, "no piece"}};
        info_.parameters.push_back(parameter);
        info_.parameters.back().ranges =
            known.empty() ? scan(parameter.components == 3 ? 4 : 1, progress) : std::move(known);
        const auto below = [this](int channel) { return isComputedBetween(*below_, channel); };
        computed_ = isComputedBetween(derived_.recipe, below_->info(), below);
    }
    /// At one time between stored ones.
    DerivedSource(const DerivedSource& stored, const TimePair& now)
        : bricks_(stored.bricks_, now), derived_(stored.derived_), info_(stored.info_), first_(stored.first_),
          computed_(stored.computed_) {
        below_ = bricks_.sourceNow();
        info_.times = below_->info().times;
    }

    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return below_->grid(); }
    const std::shared_ptr<const BrickSource>& below() const { return below_; }

    BrickStats stats(const BrickKey& key) const override {
        if (key.channel < first_) return below_->stats(key);
        BrickKey fine = key;
        fine.level = 0;
        {
            const std::lock_guard lock(statsMutex_);
            if (const auto found = stats_.find(fine); found != stats_.end()) return found->second;
        }
        const BrickStats stats = statsOfSamples(read(fine));
        const std::lock_guard lock(statsMutex_);
        return stats_.try_emplace(fine, stats).first->second;
    }

    std::optional<BrickDistribution> distribution(const BrickKey& key) const override {
        return key.channel < first_ ? below_->distribution(key) : BrickSource::distribution(key);
    }

    std::optional<BrickImportance> importance(const BrickKey& key) const override {
        return key.channel < first_ ? below_->importance(key) : BrickSource::importance(key);
    }

    std::optional<BrickChange> change(const BrickKey& key, int toTime) const override {
        if (key.channel < first_) return below_->change(key, toTime);
        return key.time == toTime ? BrickChange{} : bricks_.change(key, toTime);
    }

    BrickSamples read(const BrickKey& key) const override {
        if (key.channel < first_) return below_->read(key);
        const auto component = std::size_t(key.channel - first_);
        const auto bricks = bricks_.get(key);
        if (component < bricks->size()) return (*bricks)[component];
        return magnitude((*bricks)[0], (*bricks)[1], (*bricks)[2]);
    }

    bool computes(int channel) const override {
        return channel < first_ ? isComputedBetween(*below_, channel) : computed_;
    }

    std::shared_ptr<const BrickSource> computedAt(const TimePair& time) const override {
        constexpr std::size_t kKept = 3;
        const std::lock_guard lock(betweenMutex_);
        for (const auto& [at, source] : between_)
            if (at == time) return source;
        if (between_.size() >= kKept) between_.erase(between_.begin());
        return between_.emplace_back(time, std::make_shared<const DerivedSource>(*this, time)).second;
    }

private:
    /// Ranges of the channels: exact for coordinates, from 0 on for an uncertainty, else of a coarse level.
    std::vector<Range> scan(int channels, const Progress& progress) const {
        if (std::holds_alternative<TimeRecipe>(derived_.recipe))
            return {info_.plane ? Range{info_.plane->lo.w, info_.plane->hi.w}
                                : Range{info_.times.front(), info_.times.back()}};
        if (std::holds_alternative<PiecesRecipe>(derived_.recipe))
            return {{0, double(std::max(1, bricks_.pieces(progress)))}};
        if (const auto* uncertainty = std::get_if<UncertaintyRecipe>(&derived_.recipe)) {
            const double bound = uncertainty->bound.value_or(0);
            return {{0, bound > 0 ? bound : 1}};
        }
        const BrickGrid& bricks = grid();
        const int level = bricks.levelWithin(kRangeSamples / double(info_.times.size()));
        std::vector<Range> coarse = scanLevel(channels, level, level > 0 ? progress.part(0, 0.3) : progress);
        // Where nothing seems to differ, that is said: all samples are asked.
        const bool isDifference = std::holds_alternative<DifferenceRecipe>(derived_.recipe);
        if (level > 0 && isDifference && std::ranges::all_of(coarse, isZero) && zeroIsOfAllSamples(info_))
            return scanLevel(channels, 0, progress.part(0.3, 1));
        return coarse;
    }

    std::vector<Range> scanLevel(int channels, int level, const Progress& progress) const {
        const BrickGrid& bricks = grid();
        std::vector<Range> ranges(std::size_t(channels),
                                  {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()});
        const std::size_t count = bricks.brickCount(), total = count * info_.times.size();
        for (std::size_t n = 0; n < total; ++n) {
            progress.advance(double(n) / double(total), derived_.name);
            BrickKey key{0, int(n / count), level, bricks.indexOf(n % count)};
            for (int c = 0; c < channels; ++c) {
                key.channel = first_ + c;
                const BrickSamples read = this->read(key);
                Range& range = ranges[std::size_t(c)];
                for (std::size_t i = 0; i < read.values.size(); ++i)
                    if (read.isPresent(i)) {
                        range.lo = std::min(range.lo, double(read.values[i]));
                        range.hi = std::max(range.hi, double(read.values[i]));
                    }
            }
        }
        for (Range& range : ranges)
            if (range.lo > range.hi) range = {0, 1}; // absent everywhere
        if (std::holds_alternative<PositionRecipe>(derived_.recipe))
            for (int axis = 0; axis < 3; ++axis)
                ranges[std::size_t(axis)] = {info_.bounds.lo[axis], info_.bounds.hi[axis]};
        return ranges;
    }

    std::shared_ptr<const BrickSource> below_;
    DerivedBricks bricks_;
    DerivedParameter derived_;
    DatasetInfo info_;
    int first_;             ///< of our channels
    bool computed_ = false; ///< between stored times
    mutable std::mutex betweenMutex_;
    mutable std::vector<std::pair<TimePair, std::shared_ptr<const BrickSource>>> between_; ///< used last
    mutable std::mutex statsMutex_;
    mutable std::unordered_map<BrickKey, BrickStats, BrickKeyHash> stats_;
};

} // namespace

bool zeroIsOfAllSamples(const DatasetInfo& info) {
    constexpr double kMost = 2.5e8; // samples over all times
    return !info.remote && double(info.lattice.count()) * double(info.times.size()) <= kMost;
}

std::shared_ptr<const BrickSource> derive(std::shared_ptr<const BrickSource> source, const DerivedParameter& parameter,
                                          const Progress& progress) {
    if (const std::string problem = derivedProblem(parameter, source->info()); !problem.empty())
        throw Error(problem, parameter.name);
    return std::make_shared<const DerivedSource>(std::move(source), parameter, progress);
}

std::shared_ptr<const BrickSource> deriveAll(std::shared_ptr<const BrickSource> source,
                                             const std::vector<DerivedParameter>& parameters,
                                             std::vector<std::string>& messages, const Progress& progress) {
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const double n = double(parameters.size());
        try {
            source = derive(source, parameters[i], progress.part(double(i) / n, double(i + 1) / n));
        } catch (const Error& error) {
            messages.push_back("derived parameter " + std::string(error.what()));
        }
    }
    return source;
}

std::shared_ptr<const BrickSource> deriveLike(const BrickSource& like, std::shared_ptr<const BrickSource> source,
                                              const std::vector<DerivedParameter>& parameters) {
    const std::vector<Parameter>& known = like.info().parameters;
    for (const DerivedParameter& parameter : parameters) {
        const auto found =
            std::ranges::find_if(known, [&](const Parameter& other) { return other.name == parameter.name; });
        if (found == known.end() || !derivedProblem(parameter, source->info()).empty()) continue;
        source = std::make_shared<const DerivedSource>(source, parameter, Progress{}, found->ranges);
    }
    return source;
}

std::shared_ptr<const BrickSource> underived(std::shared_ptr<const BrickSource> source) {
    while (const auto* derived = dynamic_cast<const DerivedSource*>(source.get())) source = derived->below();
    return source;
}

} // namespace tessera::volume
