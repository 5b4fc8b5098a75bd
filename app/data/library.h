#pragma once

#include "app/session/session.h"
#include "vis/transfer/transfer_recipe.h"
#include "volume/bricks/brick_source.h"

#include <optional>
#include <span>
#include <string>

/// Transfer functions of the library, applied to data by name.
namespace tessera::app {

/// The values of a channel at a stored time, from a coarse level. Their background is that of a scan
/// (backgroundShare()), else one value that most samples have (vis::spikeBackground()). Throws Error when a brick is
/// damaged.
vis::ValueDistribution readDistribution(const volume::BrickSource& source, int channel, int time);

/// The function that colours a layer, by its name in Session::transfer, and the channel whose values it maps.
struct FunctionOfLayer {
    std::string function;
    int channel = 0;
};
/// nullopt: there is no such layer, or the data lack its parameter.
std::optional<FunctionOfLayer> functionOfLayer(const Session& session, const volume::DatasetInfo& info,
                                               std::size_t layer);

/// The recipe of that name (vis::sameName), among one's own first. Throws Error that lists all names.
const vis::TransferRecipe& recipeNamed(const std::string& name, std::span<const vis::TransferRecipe> own);

/// Replaces a function of the session by a recipe's for the data at the session's time. Throws Error: labels have
/// colours of their own, a brick is damaged.
void applyRecipe(Session& session, const volume::BrickSource& source, const FunctionOfLayer& to,
                 const vis::TransferRecipe& recipe);

/// The same by words: "NAME" for the first layer, or "PARAMETER=NAME". Throws Error.
void applyNamed(Session& session, const volume::BrickSource& source, const std::string& words,
                std::span<const vis::TransferRecipe> own);

} // namespace tessera::app
