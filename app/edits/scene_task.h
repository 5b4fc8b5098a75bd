#pragma once

#include "app/session/session.h"

/// Which task the panes of layers show.
namespace tessera::app {

/// Whether a pane of layers is the one that is turned to a task: one that shows it already, else the first.
bool takesTask(const Session& session, const std::string& pane, SceneTask task);

/// Turns that pane to a task. `entry` of its list, counted from 0, is unfolded there; a layer is selected. Returns the
/// key of the pane, "" if there is none.
std::string turnToTask(Session& session, SceneTask task, int entry = -1);

/// The same, and the pane comes to the front of its stack, unless another one fills the window.
void showTask(Session& session, SceneTask task, int entry = -1);

} // namespace tessera::app
