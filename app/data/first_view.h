#pragma once

#include "app/session/session.h"

#include "volume/bricks/brick_source.h"

#include <string>
#include <vector>

/// Adapts the default session to the samples, so that the first picture shows something.
namespace tessera::app {

/// Width by height of the volume pane in a new window, labels taken off: with and without a timeline below it.
double firstAspect(const volume::DatasetInfo& info);

/// Of data opened without a layout: shows the first parameter that varies, at the first time, or at another where it
/// varies clearly more, with a message. Only where data can be read while the user waits; if a brick is damaged, what
/// is shown stays.
void showWhatVaries(Session& session, const volume::BrickSource& source, std::vector<std::string>& messages);

/// Moves the camera so that the box fills the picture (`aspect`: width over height), from vis::firstOrientation()
/// unless the session has a direction of its own; if the first layer's parameter is absent at the cross-hair, moves the
/// cross-hair to the middle of its samples; chooses the opacity curves of volumes (aimFunction). If a brick is damaged,
/// the rest is unchanged.
void aimFirstView(Session& session, const volume::BrickSource& source, double aspect);

/// The last time, with a message, if the first volume of a layout hardly shows a sample at the session's time and more
/// at the last: opacities of layouts suit what a simulation ends with. If a brick is damaged, nothing changes.
void showLastIfEmpty(Session& session, const volume::BrickSource& source, std::vector<std::string>& messages);

/// aimFunction for the parameter of a volume that is new or shows another one; a surface moves to surfaceValue(). Data
/// on another machine, and large ones without coarse levels, are not waited for: there nothing changes, but that a
/// surface outside of the parameter's range moves to its middle.
void aimLayer(Session& session, const volume::BrickSource& source, vis::Layer& layer);

} // namespace tessera::app
