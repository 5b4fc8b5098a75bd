#pragma once

#include "app/pane/view_context.h"

#include <memory>

/// The data in space beside a plane of theirs whose times run along an axis.
namespace tessera::app {

/// The data in space that the plane is cut from; null where no plane is shown.
std::shared_ptr<const volume::BrickSource> spaceOfPlane(const ViewContext& context);

/// The session as the data in space are shown: the cross-hair at its point in space and time, and that time.
/// Without what the data in space do not have: layers of other parameters, and flow, brushes, lenses and lines whose
/// places are times. `along` describes the plane at all times, `space` the data it is cut from.
Session sessionInSpace(const Session& session, const volume::DatasetInfo& along, const volume::DatasetInfo& space);

/// Takes over what was edited in space: the camera, the cross-hair, and where the plane lies, which goes with the
/// cross-hair, and this with the plane: the time shown stays. `before` is what sessionInSpace() gave.
void takeFromSpace(Session& session, const Session& before, const Session& edited, const volume::DatasetInfo& along,
                   const volume::DatasetInfo& space);

} // namespace tessera::app
