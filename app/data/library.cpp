#include "app/data/library.h"

#include "app/data/boundary_value.h"
#include "app/data/coarse_samples.h"
#include "app/session/own_functions.h"
#include "volume/base/error.h"

#include <algorithm>

namespace tessera::app {

namespace {

constexpr std::size_t kHistogramBins = 1024;

bool categorical(const volume::DatasetInfo& info, int channel) {
    return info.parameters[std::size_t(info.channel(channel).parameter)].categorical;
}

} // namespace

vis::ValueDistribution readDistribution(const volume::BrickSource& source, int channel, int time) {
    const volume::DatasetInfo& info = source.info();
    vis::ValueDistribution out;
    out.range = info.channelRange(info.channel(channel));
    out.count.assign(kHistogramBins, 0);
    if (!(out.range.hi > out.range.lo)) return out;
    const double scale = double(kHistogramBins) / (out.range.hi - out.range.lo);
    forSamples(
        source, channel, time, source.grid().levelWithin(kQuickSamples), [](glm::ivec3, glm::ivec3) { return true; },
        [&](glm::ivec3, float value) {
            const double bin = (double(value) - out.range.lo) * scale;
            ++out.count[std::size_t(std::clamp(bin, 0.0, double(kHistogramBins - 1)))];
        });
    out.background = backgroundShare(source, channel, time).value_or(vis::spikeBackground(out.count));
    return out;
}

std::optional<FunctionOfLayer> functionOfLayer(const Session& session, const volume::DatasetInfo& info,
                                               std::size_t layer) {
    if (layer >= session.layers.size()) return std::nullopt;
    const vis::Layer& of = session.layers[layer];
    const std::string& name = channelOfFunction(of.technique);
    const auto channel = info.findChannel(name);
    if (!channel) return std::nullopt;
    return FunctionOfLayer{of.transfer.empty() ? name : of.transfer, *channel};
}

const vis::TransferRecipe& recipeNamed(const std::string& name, std::span<const vis::TransferRecipe> own) {
    std::string known;
    for (const auto& list : {own, vis::transferLibrary()})
        for (const vis::TransferRecipe& recipe : list) {
            if (vis::sameName(recipe.name, name)) return recipe;
            known += (known.empty() ? "" : ", ") + vis::quotedName(recipe);
        }
    throw Error("there is no transfer function of this name; there are " + known, "transfer function", name);
}

void applyRecipe(Session& session, const volume::BrickSource& source, const FunctionOfLayer& to,
                 const vis::TransferRecipe& recipe) {
    const volume::DatasetInfo& info = source.info();
    const volume::Channel channel = info.channel(to.channel);
    if (categorical(info, to.channel))
        throw Error("is a label, whose values have colours of their own", "transfer function", channel.name);
    const int time = info.nearestTime(session.time);
    session.transfer[to.function] = vis::madeFrom(recipe, readDistribution(source, to.channel, time), channel.unit);
}

void applyNamed(Session& session, const volume::BrickSource& source, const std::string& words,
                std::span<const vis::TransferRecipe> own) {
    const volume::DatasetInfo& info = source.info();
    const std::size_t equals = words.find('=');
    if (equals == std::string::npos) {
        const vis::TransferRecipe& recipe = recipeNamed(words, own);
        const auto first = functionOfLayer(session, info, 0);
        if (!first) throw Error("there is no layer to colour", "transfer function", words);
        return applyRecipe(session, source, *first, recipe);
    }
    const std::string parameter = words.substr(0, equals);
    const auto channel = info.findChannel(parameter);
    if (!channel) throw Error("there is no such parameter", "transfer function", parameter);
    applyRecipe(session, source, {parameter, *channel}, recipeNamed(words.substr(equals + 1), own));
}

} // namespace tessera::app
