#pragma once

#include "app/session/session.h"

#include "volume/bricks/brick_source.h"

#include <optional>

/// Adapts the default session to the samples, so that the first picture shows something.
namespace tessera::app {

/// Upper end of the background of a scan, as a share 0..1 of the channel's range: just above nearly all samples on the
/// outer faces of the box. Only for measured integers (scanners have air and noise around the object, simulations do
/// not), and only if it leaves more than half of the range. Reads the outer bricks of one time; throws Error.
std::optional<double> backgroundShare(const volume::BrickSource& source, int channel, int time);

/// Moves the camera so that the box fills the picture (`aspect`: width over height), keeping its direction; if the
/// first layer's parameter is absent at the cross-hair, moves the cross-hair to the middle of its samples; makes the
/// background of scans transparent in the default opacity curves. If a brick is damaged, the rest is unchanged.
void aimFirstView(Session& session, const volume::BrickSource& source, double aspect);

} // namespace tessera::app
