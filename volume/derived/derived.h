#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"
#include "volume/derived/derived_names.h"
#include "volume/derived/derived_recipe.h"

#include <memory>
#include <string>
#include <vector>

/// Parameters computed from others on demand, brick by brick at the requested level; absent where any input is absent
/// or the result is not a number.
namespace tessera::volume {

/// The source with one more parameter. Its range is that of a coarse level over all times, scanned here. Throws Error
/// (derivedProblem), Cancelled.
std::shared_ptr<const BrickSource> derive(std::shared_ptr<const BrickSource> source, const DerivedParameter& parameter,
                                          const Progress& progress = {});

/// Whether a difference with a range of 0 to 0 is 0 at every sample of the data; else, where these are very many or far
/// away, at those of a coarse level.
bool zeroIsOfAllSamples(const DatasetInfo& info);

/// Adds several derived parameters, each of which may use those before it; invalid ones are skipped with a message.
std::shared_ptr<const BrickSource> deriveAll(std::shared_ptr<const BrickSource> source,
                                             const std::vector<DerivedParameter>& parameters,
                                             std::vector<std::string>& messages, const Progress& progress = {});

/// The same for another source of the same data: ranges of derived parameters are copied from `like`, which has them
/// already.
std::shared_ptr<const BrickSource> deriveLike(const BrickSource& like, std::shared_ptr<const BrickSource> source,
                                              const std::vector<DerivedParameter>& parameters);

/// The source below all derived parameters.
std::shared_ptr<const BrickSource> underived(std::shared_ptr<const BrickSource> source);

} // namespace tessera::volume
