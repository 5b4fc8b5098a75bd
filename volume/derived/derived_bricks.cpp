#include "volume/derived/derived_bricks.h"

#include "volume/base/load_once.h"
#include "volume/bricks/brick_cache.h"
#include "volume/bricks/magnitude.h"
#include "volume/bricks/sample_position.h"
#include "volume/derived/computed_samples.h"
#include "volume/derived/derived_names.h"
#include "volume/derived/expression.h"
#include "volume/derived/input_time.h"
#include "volume/derived/other_source.h"
#include "volume/derived/stencil.h"
#include "volume/pieces/piece_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace tessera::volume {

namespace {

using Bricks = DerivedBricks::Bricks;

constexpr std::size_t kInputBudget = std::size_t(96) << 20, kResultBudget = std::size_t(96) << 20;

/// Channels of the components of a vector.
std::vector<int> componentsOf(const DatasetInfo& info, const std::string& vector) {
    std::vector<int> out;
    for (const char* suffix : {".x", ".y", ".z"}) out.push_back(info.findChannel(vector + suffix).value_or(0));
    return out;
}

std::size_t bytesOf(const Bricks& bricks) {
    std::size_t bytes = 0;
    for (const BrickSamples& brick : bricks) bytes += brick.values.size() * 4 + brick.present.size();
    return bytes;
}

/// Sums of derivatives; absent as a whole where one of them is.
template <std::size_t N> struct Derivative {
    std::array<double, N> sum{};
    bool there = true;
    void add(std::size_t component, std::optional<double> derivative, double sign) {
        sum[component] += sign * derivative.value_or(0);
        there = there && derivative;
    }
    void store(Bricks& out, std::size_t i) const {
        for (std::size_t n = 0; n < N; ++n) there ? setComputed(out[n], i, sum[n]) : setAbsent(out[n], i);
    }
};

} // namespace

struct DerivedBricks::Impl {
    struct Formula {
        explicit Formula(Expression of) : expression(std::move(of)) {}
        Expression expression;
        std::vector<InputTime> times; ///< of its inputs
    };

    /// `now`: the one time between stored ones; `source` is then cached already.
    Impl(std::shared_ptr<const BrickSource> source, DerivedRecipe recipe, const std::optional<TimePair>& now)
        : source_(std::move(source)), now_(now), sourceNow_(now ? sourceAt(source_, *now).source : source_),
          cached_(std::make_shared<const BrickCache>(sourceNow_, kInputBudget)), stored_(now ? source_ : cached_),
          inputs_(*cached_), recipe_(std::move(recipe)), names_(source_->info()),
          results_(
              kResultBudget, [this](const BrickKey& key) { return std::make_shared<const Bricks>(compute(key)); },
              bytesOf),
          means_(
              kResultBudget, [this](const BrickKey& key) { return std::make_shared<const Bricks>(moments(key)); },
              bytesOf) {
        if (const auto* recipeOf = std::get_if<ExpressionRecipe>(&recipe_))
            for (const std::string& text : formulaComponents(recipeOf->formula)) {
                Formula& formula = formulas_.emplace_back(Expression(text, names_.names, OtherTimes::Allowed));
                for (const Expression::Input& input : formula.expression.inputs())
                    formula.times.emplace_back(stored_, names_.channel[std::size_t(input.name)],
                                               input.at.value_or(TimeReference{}), now_);
            }
        if (const auto* difference = std::get_if<DifferenceRecipe>(&recipe_)) {
            const int channel = channelOf(difference->channel);
            times_.emplace_back(stored_, channel, difference->reference(), now_);
            if (difference->from == OtherTime::Other) toOwnUnit_ = otherConversion(source_->info(), channel).value();
        }
        if (const auto* of = std::get_if<PiecesRecipe>(&recipe_))
            pieces_ = std::make_shared<const PieceLabels>(stored_, piecesQuery(*of, source_->info(), source_->grid()));
    }

    /// The key of a channel of the source at a brick.
    BrickSamples input(int channel, BrickKey key) const {
        key.channel = channel;
        return inputs_.read(key);
    }
    /// The same at another time.
    BrickSamples input(const InputTime& at, const BrickKey& key) const {
        return at.exists(key.time) ? at.read(key) : nothing(key);
    }
    /// The time of a key.
    double timeOf(const BrickKey& key) const {
        const std::vector<double>& times = source_->info().times;
        return now_ ? timeAt(times, *now_) : times[std::size_t(key.time)];
    }
    int channelOf(const std::string& name) const { return *source_->info().findChannel(name); }

    BrickSamples empty(const BrickKey& key) const {
        BrickSamples out;
        out.size = source_->grid().brickSamples(key.index, key.level);
        out.values.resize(std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z));
        return out;
    }
    BrickSamples nothing(const BrickKey& key) const {
        BrickSamples out = empty(key);
        out.present.assign(out.values.size(), 0);
        return out;
    }
    Bricks compute(const BrickKey& key) const {
        return std::visit([&](const auto& recipe) { return make(recipe, key); }, recipe_);
    }

    /// A formula, or one for each component of a vector, which is absent where one of them is.
    Bricks make(const ExpressionRecipe&, const BrickKey& key) const {
        Bricks out;
        for (const Formula& formula : formulas_) out.push_back(resultOf(formula, key));
        for (std::size_t i = 0; out.size() > 1 && i < out[0].values.size(); ++i)
            if (std::ranges::any_of(out, [&](const BrickSamples& of) { return !of.isPresent(i); }))
                for (BrickSamples& component : out) setAbsent(component, i);
        return out;
    }

    BrickSamples resultOf(const Formula& formula, const BrickKey& key) const {
        BrickSamples out = empty(key);
        const std::size_t count = out.values.size();
        std::vector<BrickSamples> samples;
        std::vector<std::vector<double>> values;
        for (std::size_t n = 0; n < formula.expression.inputs().size(); ++n) {
            const Expression::Input& used = formula.expression.inputs()[n];
            const InputTime& at = formula.times[n];
            const int channel = names_.channel[std::size_t(used.name)];
            std::vector<double>& of = values.emplace_back(count);
            if (used.at && channel == FormulaNames::kTime && !at.exists(key.time)) {
                samples.push_back(nothing(key));
            } else if (channel >= 0) {
                samples.push_back(used.at ? input(at, key) : input(channel, key));
                for (std::size_t i = 0; i < count; ++i) of[i] = samples.back().exact(i);
            } else if (channel == FormulaNames::kTime) {
                std::fill(of.begin(), of.end(), used.at ? at.time(key.time) : timeOf(key));
            } else {
                SamplePositions position(source_->grid(), key.index, key.level);
                for (std::size_t i = 0; i < count; ++i, position.next()) of[i] = position.at()[-1 - channel];
            }
        }
        std::vector<double> results(count);
        formula.expression.evaluate(values, results);
        for (std::size_t i = 0; i < count; ++i) {
            const bool present =
                std::all_of(samples.begin(), samples.end(), [&](const BrickSamples& of) { return of.isPresent(i); });
            if (present)
                setComputed(out, i, results[i]);
            else
                setAbsent(out, i);
        }
        return out;
    }

    Bricks make(const MagnitudeRecipe& recipe, const BrickKey& key) const {
        return {magnitude(input(channelOf(recipe.x), key), input(channelOf(recipe.y), key),
                          input(channelOf(recipe.z), key))};
    }

    /// Calls `body(place, index)` for the samples of a brick that are present in all neighbourhoods; the others become
    /// absent in every brick of `out`.
    template <class Body>
    void everywhere(const std::vector<Neighbourhood>& around, Bricks& out, const Body& body) const {
        const glm::ivec3 size = around.front().size();
        std::size_t i = 0;
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x, ++i) {
                    const glm::ivec3 at(x, y, z);
                    if (std::all_of(around.begin(), around.end(),
                                    [&](const Neighbourhood& n) { return n.at(at).has_value(); }))
                        body(at, i);
                    else
                        for (BrickSamples& brick : out) setAbsent(brick, i);
                }
    }
    std::vector<Neighbourhood> around(const std::vector<int>& channels, const BrickKey& key) const {
        std::vector<Neighbourhood> out;
        for (const int channel : channels) {
            BrickKey own = key;
            own.channel = channel;
            out.emplace_back(
                source_->grid(), own, 1, [&](const BrickKey& near) { return inputs_.read(near); },
                partLabel(source_->info(), channel));
        }
        return out;
    }

    Bricks make(const GradientRecipe& recipe, const BrickKey& key) const {
        Bricks out(3, empty(key));
        const auto near = around({channelOf(recipe.channel)}, key);
        everywhere(near, out, [&](glm::ivec3 at, std::size_t i) {
            Derivative<3> value;
            for (std::size_t axis = 0; axis < 3; ++axis) value.add(axis, near[0].derivative(at, int(axis)), 1);
            value.store(out, i);
        });
        return out;
    }

    Bricks make(const DivergenceRecipe& recipe, const BrickKey& key) const {
        Bricks out(1, empty(key));
        const auto near = around(componentsOf(source_->info(), recipe.vector), key);
        everywhere(near, out, [&](glm::ivec3 at, std::size_t i) {
            Derivative<1> value;
            for (std::size_t axis = 0; axis < 3; ++axis) value.add(0, near[axis].derivative(at, int(axis)), 1);
            value.store(out, i);
        });
        return out;
    }

    Bricks make(const VorticityRecipe& recipe, const BrickKey& key) const {
        Bricks out(3, empty(key));
        const auto near = around(componentsOf(source_->info(), recipe.vector), key);
        everywhere(near, out, [&](glm::ivec3 at, std::size_t i) {
            Derivative<3> value;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::size_t next = (axis + 1) % 3, last = (axis + 2) % 3;
                value.add(axis, near[last].derivative(at, int(next)), 1);
                value.add(axis, near[next].derivative(at, int(last)), -1);
            }
            value.store(out, i);
        });
        return out;
    }

    /// Mean and standard deviation over the times at which a sample is present.
    Bricks moments(const BrickKey& key) const {
        const int channel = channelOf(std::get<DeviationRecipe>(recipe_).channel);
        Bricks out(2, empty(key));
        const std::size_t count = out[0].values.size();
        std::vector<double> n(count), mean(count), squares(count);
        for (int time = 0; time < int(source_->info().times.size()); ++time) {
            BrickKey own = key;
            own.time = time;
            own.channel = channel;
            const BrickSamples samples = source_->read(own);
            for (std::size_t i = 0; i < count; ++i) {
                if (!samples.isPresent(i)) continue;
                // Welford: close values keep their digits.
                const double value = samples.exact(i), before = value - mean[i];
                n[i] += 1;
                mean[i] += before / n[i];
                squares[i] += before * (value - mean[i]);
            }
        }
        for (std::size_t i = 0; i < count; ++i) {
            setComputed(out[0], i, mean[i]);
            setComputed(out[1], i, n[i] > 0 ? std::sqrt(squares[i] / n[i]) : 0);
        }
        return out;
    }

    Bricks make(const DeviationRecipe& recipe, const BrickKey& key) const {
        BrickKey overTime = key;
        overTime.time = 0;
        const auto both = means_.get(overTime);
        BrickSamples out = input(channelOf(recipe.channel), key);
        for (std::size_t i = 0; i < out.values.size(); ++i) {
            if (!out.isPresent(i)) continue;
            if (recipe.measure == TimeMeasure::FromMean)
                setComputed(out, i, out.exact(i) - double((*both)[0].values[i]));
            else
                setComputed(out, i, double((*both)[1].values[i]));
        }
        return {std::move(out)};
    }

    Bricks make(const SmoothRecipe& recipe, const BrickKey& key) const {
        BrickKey own = key;
        own.channel = channelOf(recipe.channel);
        return {smoothed(
            source_->grid(), own, recipe.width, [&](const BrickKey& near) { return inputs_.read(near); },
            partLabel(source_->info(), own.channel))};
    }

    Bricks make(const DifferenceRecipe& recipe, const BrickKey& key) const {
        const int channel = channelOf(recipe.channel);
        BrickSamples out = input(channel, key);
        const BrickSamples other = input(times_.front(), key);
        for (std::size_t i = 0; i < out.values.size(); ++i) {
            if (out.isPresent(i) && other.isPresent(i))
                setComputed(out, i, out.exact(i) - toOwnUnit_(other.exact(i)));
            else
                setAbsent(out, i);
        }
        return {std::move(out)};
    }

    Bricks make(const PiecesRecipe&, BrickKey key) const {
        if (now_) key.time = now_->nearest();
        return {pieces_->brick(key)};
    }
    Bricks make(const UncertaintyRecipe& recipe, const BrickKey& key) const {
        BrickSamples out = input(channelOf(recipe.channel), key);
        out.rest.clear();
        for (std::size_t i = 0; i < out.values.size(); ++i)
            if (out.isPresent(i)) recipe.bound ? setComputed(out, i, *recipe.bound) : setAbsent(out, i);
        return {std::move(out)};
    }

    Bricks make(const PositionRecipe&, const BrickKey& key) const {
        Bricks out(3, empty(key));
        SamplePositions position(source_->grid(), key.index, key.level);
        for (std::size_t i = 0; i < out[0].values.size(); ++i, position.next())
            for (int axis = 0; axis < 3; ++axis) setComputed(out[std::size_t(axis)], i, position.at()[axis]);
        return out;
    }

    Bricks make(const TimeRecipe&, const BrickKey& key) const {
        const auto& plane = source_->info().plane; // whose samples have a time each; absent where it has left its data
        Bricks out(1, empty(key));
        SamplePositions position(source_->grid(), key.index, key.level);
        for (std::size_t i = 0; i < out[0].values.size(); ++i, position.next()) {
            glm::dvec4 point = source_->info().pointAt(position.at(), timeOf(key));
            !plane || plane->reaches(point) ? setComputed(out[0], i, point.w) : setAbsent(out[0], i);
        }
        return out;
    }

    /// Whether a channel is known, without reading, to be unchanged in a brick between both times.
    bool stays(int channel, BrickKey key, int toTime) const {
        key.channel = channel;
        const std::optional<BrickChange> change = source_->change(key, toTime);
        return change && change->max == 0;
    }
    bool stays(const BrickKey& key, int toTime) const {
        if (const auto* difference = std::get_if<DifferenceRecipe>(&recipe_)) {
            return stays(channelOf(difference->channel), key, toTime) && times_.front().stays(key, toTime);
        }
        return !formulas_.empty() &&
               std::ranges::all_of(formulas_, [&](const Formula& formula) { return stays(formula, key, toTime); });
    }
    bool stays(const Formula& formula, const BrickKey& key, int toTime) const {
        for (std::size_t n = 0; n < formula.expression.inputs().size(); ++n) {
            const Expression::Input& used = formula.expression.inputs()[n];
            const int channel = names_.channel[std::size_t(used.name)];
            const bool fixed = used.at && isFixed(*used.at);
            if (channel == FormulaNames::kTime
                    ? !fixed
                    : channel >= 0 && !(used.at ? formula.times[n].stays(key, toTime) : stays(channel, key, toTime)))
                return false;
        }
        return true;
    }

    std::shared_ptr<const BrickSource> source_; ///< all stored times
    std::optional<TimePair> now_;
    std::shared_ptr<const BrickSource> sourceNow_; ///< the time between stored ones, or the source
    std::shared_ptr<const BrickCache> cached_;     ///< of it
    std::shared_ptr<const BrickSource> stored_;    ///< all stored times, cached
    const BrickCache& inputs_;
    DerivedRecipe recipe_;
    FormulaNames names_;
    std::vector<Formula> formulas_; ///< of an expression: one, or one for each component
    UnitConversion toOwnUnit_;      ///< of the other data of a difference
    std::vector<InputTime> times_;  ///< of the difference
    std::shared_ptr<const PieceLabels> pieces_;
    mutable LoadOnce<BrickKey, Bricks, BrickKeyHash> results_, means_;
};

DerivedBricks::DerivedBricks(std::shared_ptr<const BrickSource> source, DerivedRecipe recipe)
    : impl_(std::make_unique<Impl>(std::move(source), std::move(recipe), std::nullopt)) {}

DerivedBricks::DerivedBricks(const DerivedBricks& stored, const TimePair& now)
    : impl_(std::make_unique<Impl>(stored.impl_->stored_, stored.impl_->recipe_, now)) {
    impl_->pieces_ = stored.impl_->pieces_;
}

const std::shared_ptr<const BrickSource>& DerivedBricks::sourceNow() const {
    return impl_->sourceNow_;
}

DerivedBricks::~DerivedBricks() = default;

int DerivedBricks::pieces(const Progress& progress) const {
    return impl_->pieces_ ? impl_->pieces_->graph(progress)->tracks : 0;
}

std::shared_ptr<const DerivedBricks::Bricks> DerivedBricks::get(BrickKey key) const {
    key.channel = 0;
    return impl_->results_.get(key);
}

std::optional<BrickChange> DerivedBricks::change(const BrickKey& key, int toTime) const {
    return impl_->stays(key, toTime) ? std::optional(BrickChange{}) : std::nullopt;
}

} // namespace tessera::volume
