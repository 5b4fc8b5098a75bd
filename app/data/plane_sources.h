#pragma once

#include "app/data/shown_sources.h"
#include "app/session/session.h"

#include <optional>
#include <string>
#include <vector>

namespace tessera::app {

/// The sources of the plane in space and time that a session names (DataRef::timeAxis) in place of those of the data,
/// without derived parameters. NumberOrigin::spaceOfPlane keeps the numbers of the data. Throws Error.
Sources cutByPlane(const Sources& whole, const DataRef& data);

/// The same of a session that is opened: where its plane does not meet the data they are shown as they are, which is
/// said.
Sources cutIfMet(const Sources& whole, const DataRef& data, std::vector<std::string>& messages);

/// Says of gradients, divergences and curls in such data that one of the directions is time.
void tellTimeDirection(const std::vector<volume::DerivedParameter>& derived, const volume::DatasetInfo& info,
                       std::vector<std::string>& messages);

/// Whether a layout shows a plane in space and time, and these data, shown without one, have the times for it.
bool layoutCuts(const Session& layout, const DataRef& data, const volume::DatasetInfo& info);
/// That plane for these data: their longest axis in place of one without extent. None where it does not meet them,
/// which is said.
std::optional<volume::TimeAxis> planeOfLayout(const Session& layout, const volume::DatasetInfo& info,
                                              std::vector<std::string>& messages);
/// Said where the layout does and the data have one time.
inline constexpr const char* kNoTimesToCut =
    "The layout shows a plane in space and time, and these data have one time: they are shown as they are.";

} // namespace tessera::app
