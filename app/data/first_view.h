#pragma once

#include "app/session/session.h"

#include "volume/bricks/brick_source.h"

#include <optional>

/// What a look at the samples adds to the default session: a first picture that shows something.
namespace tessera::app {

/// Where the background of a scan ends, as a share 0..1 of the channel's range: just above nearly all samples on the
/// outer faces of the box. Only for measured integers (scanners have air and noise around the object; simulations
/// have none), and only where it leaves more than half of the range. Reads the outer bricks of one time; throws Error.
std::optional<double> backgroundShare(const volume::BrickSource& source, int channel, int time);

/// Moves the camera so that the box fills the picture (`aspect`: width over height) from where it looks; puts a cursor
/// that lies where the first layer's parameter is absent to the middle of its samples; leaves the background of scans
/// out of the default opacity curves. With a damaged
/// brick the rest stays as it is.
void aimFirstView(Session& session, const volume::BrickSource& source, double aspect);

} // namespace tessera::app
