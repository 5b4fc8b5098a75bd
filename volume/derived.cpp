#include "volume/derived.h"

#include "volume/brick_cache.h"
#include "volume/expression.h"
#include "volume/load_once.h"
#include "volume/memory_source.h"
#include "volume/sample_position.h"
#include "volume/stencil.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>

namespace tessera::volume {

namespace {

constexpr std::size_t kInputBudget = std::size_t(96) << 20, kResultBudget = std::size_t(96) << 20;
constexpr double kRangeSamples = 3e6; // looked at to find a range, over all times

/// Names a formula may use: channels, vectors (for their magnitude), then x, y, z, t where these are free.
struct FormulaNames {
    std::vector<std::string> names;
    std::vector<int> channel; ///< by name; -1 - axis for a coordinate, -4 for the time

    explicit FormulaNames(const DatasetInfo& info) {
        static constexpr const char* kCoordinates[] = {"x", "y", "z", "t"};
        for (int i = 0; i < 4; ++i) add(kCoordinates[i], -1 - i);
        const std::vector<Channel> channels = info.channels();
        for (std::size_t i = 0; i < channels.size(); ++i)
            if (channels[i].magnitude) add(info.parameters[std::size_t(channels[i].parameter)].name, int(i));
        for (std::size_t i = 0; i < channels.size(); ++i) add(channels[i].name, int(i));
    }

private:
    void add(const std::string& name, int which) {
        names.push_back(name);
        channel.push_back(which);
    }
};

const Parameter* findVector(const DatasetInfo& info, const std::string& name) {
    for (const Parameter& parameter : info.parameters)
        if (parameter.name == name && parameter.components == 3) return &parameter;
    return nullptr;
}

/// Channels of the components of a vector.
std::vector<int> componentsOf(const DatasetInfo& info, const std::string& vector) {
    std::vector<int> out;
    for (const char* suffix : {".x", ".y", ".z"}) out.push_back(info.findChannel(vector + suffix).value_or(0));
    return out;
}

int componentsOf(const DerivedParameter& derived) {
    const bool vector = std::holds_alternative<GradientRecipe>(derived.recipe) ||
                        std::holds_alternative<VorticityRecipe>(derived.recipe) ||
                        std::holds_alternative<PositionRecipe>(derived.recipe);
    return vector ? 3 : 1;
}

struct Problem {
    const DatasetInfo& info;
    std::string channel(const std::string& name) const {
        return info.findChannel(name) ? "" : "no parameter is named \"" + name + "\"";
    }
    std::string operator()(const ExpressionRecipe& recipe) const {
        try {
            const FormulaNames names(info);
            const Expression check(recipe.formula, names.names);
            return {};
        } catch (const Error& error) {
            return error.what();
        }
    }
    std::string operator()(const MagnitudeRecipe& recipe) const {
        for (const std::string& name : {recipe.x, recipe.y, recipe.z})
            if (const std::string problem = channel(name); !problem.empty()) return problem;
        return {};
    }
    std::string vector(const std::string& name) const {
        return findVector(info, name) ? "" : "no vector is named \"" + name + "\"";
    }
    std::string operator()(const GradientRecipe& recipe) const { return channel(recipe.channel); }
    std::string operator()(const DivergenceRecipe& recipe) const { return vector(recipe.vector); }
    std::string operator()(const VorticityRecipe& recipe) const { return vector(recipe.vector); }
    std::string operator()(const DeviationRecipe& recipe) const { return channel(recipe.channel); }
    std::string operator()(const SmoothRecipe& recipe) const {
        if (!(recipe.width >= 0.1 && recipe.width <= 16)) return "the width must be between 0.1 and 16 cells";
        return channel(recipe.channel);
    }
    std::string operator()(const PositionRecipe&) const { return {}; }
    std::string operator()(const TimeRecipe&) const { return {}; }
};

/// Components of a brick.
using Bricks = std::vector<BrickSamples>;

std::size_t bytesOf(const Bricks& bricks) {
    std::size_t bytes = 0;
    for (const BrickSamples& brick : bricks) bytes += brick.values.size() * 4 + brick.present.size();
    return bytes;
}

class DerivedSource final : public BrickSource {
public:
    DerivedSource(std::shared_ptr<const BrickSource> source, DerivedParameter derived, const Progress& progress)
        : below_(std::move(source)), inputs_(below_, kInputBudget), derived_(std::move(derived)), info_(below_->info()),
          first_(int(info_.channels().size())), names_(info_),
          results_(
              kResultBudget, [this](const BrickKey& key) { return std::make_shared<const Bricks>(compute(key)); },
              bytesOf),
          means_(
              kResultBudget, [this](const BrickKey& key) { return std::make_shared<const Bricks>(moments(key)); },
              bytesOf) {
        if (const auto* recipe = std::get_if<ExpressionRecipe>(&derived_.recipe))
            expression_.emplace(recipe->formula, names_.names);
        Parameter parameter;
        parameter.name = derived_.name;
        parameter.unit = derived_.unit;
        parameter.components = componentsOf(derived_);
        info_.parameters.push_back(parameter);
        info_.parameters.back().ranges = scan(parameter.components == 3 ? 4 : 1, progress);
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
        const BrickSamples samples = read(fine);
        BrickStats stats{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), 0};
        std::size_t present = 0;
        for (std::size_t i = 0; i < samples.values.size(); ++i) {
            if (!samples.present.empty() && samples.present[i] == 0) continue;
            ++present;
            stats.min = std::min(stats.min, samples.values[i]);
            stats.max = std::max(stats.max, samples.values[i]);
        }
        if (!samples.values.empty()) stats.presentFraction = float(double(present) / double(samples.values.size()));
        const std::lock_guard lock(statsMutex_);
        return stats_.try_emplace(fine, stats).first->second;
    }

    std::optional<BrickImportance> importance(const BrickKey& key) const override {
        return key.channel < first_ ? below_->importance(key) : BrickSource::importance(key);
    }

    std::optional<BrickChange> change(const BrickKey& key, int toTime) const override {
        return key.channel < first_ ? below_->change(key, toTime) : BrickSource::change(key, toTime);
    }

    BrickSamples read(const BrickKey& key) const override {
        if (key.channel < first_) return below_->read(key);
        const auto component = std::size_t(key.channel - first_);
        BrickKey whole = key;
        whole.channel = 0;
        const auto bricks = results_.get(whole);
        if (component < bricks->size()) return (*bricks)[component];
        return magnitude((*bricks)[0], (*bricks)[1], (*bricks)[2]);
    }

private:
    /// A channel of the source below, at a brick.
    BrickSamples input(int channel, BrickKey key) const {
        key.channel = channel;
        return inputs_.read(key);
    }
    int channelOf(const std::string& name) const { return *below_->info().findChannel(name); }

    BrickSamples empty(const BrickKey& key) const {
        BrickSamples out;
        out.size = grid().brickSamples(key.index, key.level);
        out.values.resize(std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z));
        return out;
    }
    static void setAbsent(BrickSamples& samples, std::size_t i) {
        if (samples.present.empty()) samples.present.assign(samples.values.size(), 1);
        samples.present[i] = 0;
        samples.values[i] = 0;
    }
    static bool presentAt(const BrickSamples& samples, std::size_t i) {
        return samples.present.empty() || samples.present[i] != 0;
    }
    static void set(BrickSamples& samples, std::size_t i, double value) {
        const auto narrow = float(value);
        if (std::isfinite(narrow))
            samples.values[i] = narrow;
        else
            setAbsent(samples, i);
    }

    Bricks compute(const BrickKey& key) const {
        return std::visit([&](const auto& recipe) { return make(recipe, key); }, derived_.recipe);
    }

    Bricks make(const ExpressionRecipe&, const BrickKey& key) const {
        BrickSamples out = empty(key);
        const std::size_t count = out.values.size();
        std::vector<BrickSamples> samples;
        std::vector<std::vector<double>> values;
        for (const int name : expression_->used()) {
            const int channel = names_.channel[std::size_t(name)];
            std::vector<double>& of = values.emplace_back(count);
            if (channel >= 0) {
                samples.push_back(input(channel, key));
                std::copy(samples.back().values.begin(), samples.back().values.end(), of.begin());
            } else if (channel == -4) {
                std::fill(of.begin(), of.end(), info_.times[std::size_t(key.time)]);
            } else {
                SamplePositions position(grid(), key.index, key.level);
                for (std::size_t i = 0; i < count; ++i, position.next()) of[i] = position.at()[-1 - channel];
            }
        }
        std::vector<double> results(count);
        expression_->evaluate(values, results);
        for (std::size_t i = 0; i < count; ++i) {
            const bool present =
                std::all_of(samples.begin(), samples.end(), [&](const BrickSamples& of) { return presentAt(of, i); });
            if (present)
                set(out, i, results[i]);
            else
                setAbsent(out, i);
        }
        return {std::move(out)};
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
            out.emplace_back(grid(), own, 1, [&](const BrickKey& near) { return inputs_.read(near); });
        }
        return out;
    }

    Bricks make(const GradientRecipe& recipe, const BrickKey& key) const {
        Bricks out(3, empty(key));
        const auto near = around({channelOf(recipe.channel)}, key);
        everywhere(near, out, [&](glm::ivec3 at, std::size_t i) {
            for (int axis = 0; axis < 3; ++axis) set(out[std::size_t(axis)], i, near[0].derivative(at, axis));
        });
        return out;
    }

    Bricks make(const DivergenceRecipe& recipe, const BrickKey& key) const {
        Bricks out(1, empty(key));
        const auto near = around(componentsOf(info_, recipe.vector), key);
        everywhere(near, out, [&](glm::ivec3 at, std::size_t i) {
            set(out[0], i, near[0].derivative(at, 0) + near[1].derivative(at, 1) + near[2].derivative(at, 2));
        });
        return out;
    }

    Bricks make(const VorticityRecipe& recipe, const BrickKey& key) const {
        Bricks out(3, empty(key));
        const auto near = around(componentsOf(info_, recipe.vector), key);
        everywhere(near, out, [&](glm::ivec3 at, std::size_t i) {
            for (int axis = 0; axis < 3; ++axis) {
                const int next = (axis + 1) % 3, last = (axis + 2) % 3;
                set(out[std::size_t(axis)], i,
                    near[std::size_t(last)].derivative(at, next) - near[std::size_t(next)].derivative(at, last));
            }
        });
        return out;
    }

    /// Mean and standard deviation over the times at which a sample is present.
    Bricks moments(const BrickKey& key) const {
        const int channel = channelOf(std::get<DeviationRecipe>(derived_.recipe).channel);
        Bricks out(2, empty(key));
        const std::size_t count = out[0].values.size();
        std::vector<double> n(count), mean(count), squares(count);
        for (int time = 0; time < int(info_.times.size()); ++time) {
            BrickKey own = key;
            own.time = time;
            own.channel = channel;
            const BrickSamples samples = below_->read(own);
            for (std::size_t i = 0; i < count; ++i) {
                if (!presentAt(samples, i)) continue;
                // Welford: close values keep their digits.
                const double value = double(samples.values[i]), before = value - mean[i];
                n[i] += 1;
                mean[i] += before / n[i];
                squares[i] += before * (value - mean[i]);
            }
        }
        for (std::size_t i = 0; i < count; ++i) {
            set(out[0], i, mean[i]);
            set(out[1], i, n[i] > 0 ? std::sqrt(squares[i] / n[i]) : 0);
        }
        return out;
    }

    Bricks make(const DeviationRecipe& recipe, const BrickKey& key) const {
        BrickKey overTime = key;
        overTime.time = 0;
        const auto both = means_.get(overTime);
        BrickSamples out = input(channelOf(recipe.channel), key);
        for (std::size_t i = 0; i < out.values.size(); ++i) {
            if (!presentAt(out, i)) continue;
            if (recipe.measure == TimeMeasure::FromMean)
                set(out, i, double(out.values[i]) - double((*both)[0].values[i]));
            else
                set(out, i, double((*both)[1].values[i]));
        }
        return {std::move(out)};
    }

    Bricks make(const SmoothRecipe& recipe, const BrickKey& key) const {
        BrickKey own = key;
        own.channel = channelOf(recipe.channel);
        return {smoothed(grid(), own, recipe.width, [&](const BrickKey& near) { return inputs_.read(near); })};
    }

    Bricks make(const PositionRecipe&, const BrickKey& key) const {
        Bricks out(3, empty(key));
        SamplePositions position(grid(), key.index, key.level);
        for (std::size_t i = 0; i < out[0].values.size(); ++i, position.next())
            for (int axis = 0; axis < 3; ++axis) set(out[std::size_t(axis)], i, position.at()[axis]);
        return out;
    }

    Bricks make(const TimeRecipe&, const BrickKey& key) const {
        Bricks out(1, empty(key));
        std::fill(out[0].values.begin(), out[0].values.end(), float(info_.times[std::size_t(key.time)]));
        return out;
    }

    /// Ranges of the channels: exact for coordinates, else of a coarse level.
    std::vector<Range> scan(int channels, const Progress& progress) const {
        if (std::holds_alternative<TimeRecipe>(derived_.recipe)) return {{info_.times.front(), info_.times.back()}};
        const BrickGrid& bricks = grid();
        int level = 0;
        const auto samples = [&] {
            const glm::dvec3 size(bricks.levelSamples(level));
            return size.x * size.y * size.z * double(info_.times.size());
        };
        while (level + 1 < bricks.levels && samples() > kRangeSamples) ++level;
        std::vector<Range> ranges(std::size_t(channels),
                                  {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()});
        const glm::ivec3 count = bricks.count();
        const int total = count.x * count.y * count.z * int(info_.times.size());
        for (int n = 0; n < total; ++n) {
            progress.advance(double(n) / total, derived_.name);
            const int brick = n % (count.x * count.y * count.z);
            BrickKey key{0,
                         n / (count.x * count.y * count.z),
                         level,
                         {brick % count.x, brick / count.x % count.y, brick / (count.x * count.y)}};
            for (int c = 0; c < channels; ++c) {
                key.channel = first_ + c;
                const BrickSamples read = this->read(key);
                Range& range = ranges[std::size_t(c)];
                for (std::size_t i = 0; i < read.values.size(); ++i)
                    if (presentAt(read, i)) {
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
    BrickCache inputs_;
    DerivedParameter derived_;
    DatasetInfo info_;
    int first_; ///< of our channels
    FormulaNames names_;
    std::optional<Expression> expression_;
    mutable LoadOnce<BrickKey, Bricks, BrickKeyHash> results_, means_;
    mutable std::mutex statsMutex_;
    mutable std::unordered_map<BrickKey, BrickStats, BrickKeyHash> stats_;
};

} // namespace

std::string derivedProblem(const DerivedParameter& parameter, const DatasetInfo& info) {
    if (parameter.name.empty()) return "it needs a name";
    if (parameter.name.find('`') != std::string::npos) return "the name must not hold a back quote";
    if (std::any_of(info.parameters.begin(), info.parameters.end(),
                    [&](const Parameter& own) { return own.name == parameter.name; }) ||
        info.findChannel(parameter.name))
        return "the name \"" + parameter.name + "\" is taken";
    return std::visit(Problem{info}, parameter.recipe);
}

std::vector<std::string> derivedProblems(const std::vector<DerivedParameter>& parameters, DatasetInfo info) {
    std::vector<std::string> problems;
    for (const DerivedParameter& each : parameters) {
        problems.push_back(derivedProblem(each, info));
        if (!problems.back().empty()) continue;
        Parameter parameter;
        parameter.name = each.name;
        parameter.components = componentsOf(each);
        info.parameters.push_back(std::move(parameter));
    }
    return problems;
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

std::shared_ptr<const BrickSource> underived(std::shared_ptr<const BrickSource> source) {
    while (const auto* derived = dynamic_cast<const DerivedSource*>(source.get())) source = derived->below();
    return source;
}

} // namespace tessera::volume
