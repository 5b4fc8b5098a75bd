#pragma once

#include "app/session/session.h"

#include <optional>
#include <string>
#include <vector>

/// The plane in space and time that is shown in place of the data (volume/sources/time_axis.h).
namespace tessera::app {

/// As the session has it now, of the data that it is cut from: also while it is being edited, before the data are made.
/// None where the data are shown themselves, and while the setting means no plane that meets them.
std::optional<volume::SpaceTimePlane> planeShown(const Session& session, const volume::DatasetInfo& space);

/// What a plane is, in the units of its data: "z = 1.20 mm at all times", "t = 3.20 s everywhere",
/// "z = 0.50 mm at t = 0 s, moving at 0.20 mm/s", or its equation. `info`: of the plane, or of what it is cut from.
std::string planeText(const volume::DatasetInfo& info, const volume::SpaceTimePlane& plane);

/// In a slice of such data across an axis: what follows there, "t = 3.20 s", or where it is not the same everywhere
/// "t 0.00 to 3.20 s"; "t outside of the data" where nothing is. "" of other data.
std::string followsText(const volume::DatasetInfo& info, int axis, double position);

/// The first and the last time at which a plane meets the space of the data that it is cut from.
Range timesMet(const volume::SpaceTimePlane& plane);

/// Where it lies at a time: the corners of its section with the box, around it. None where it is elsewhere, or all of
/// space.
std::vector<glm::dvec3> sectionAtTime(const volume::SpaceTimePlane& plane, double time, const volume::Box& box);

} // namespace tessera::app
