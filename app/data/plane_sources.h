#pragma once

#include "app/data/sources.h"

#include <optional>

namespace tessera::app {

/// The sources of the plane in space and time that a session names (DataRef::timeAxis) in place of those of the data,
/// without derived parameters. NumberOrigin::spaceOfPlane keeps the numbers of the data. Throws Error.
Sources cutByPlane(const Sources& whole, const DataRef& data);

/// Another plane of the same data as the one shown, with the derived parameters of `data`: nothing is opened again.
/// None where that cannot be done: no plane is shown or wanted, or the data are shown as an archive would hold them.
std::optional<Sources> cutAgain(const Sources& shown, const DataRef& data, std::vector<std::string>& messages,
                                const Progress& progress = {});

} // namespace tessera::app
