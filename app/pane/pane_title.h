#pragma once

#include "app/session/session.h"

#include <string>

namespace tessera::app {

/// The name of a pane by what it shows: a volume view with layers or a time of its own is called after them, "O2",
/// "t = 0.26 s"; with the usual name behind it where another view shows the same; a list of what is worth seeing after
/// what it lists. All others: paneTitle().
std::string shownTitle(const Session& session, const std::string& pane, const volume::DatasetInfo& info);

} // namespace tessera::app
