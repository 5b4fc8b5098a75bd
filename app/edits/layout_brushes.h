#pragma once

#include "app/session/session.h"

#include <string>
#include <vector>

namespace tessera::app {

/// Brushes after a layout was chosen: those that the user made or changed stay, before the layout's own. Brushes that
/// came from one (Session::layoutBrushes), at most switched on or off since, go with it. Beside an enabled brush of the
/// user those of the layout are switched off, so that the selection stays; one whose name the user's have is left out,
/// as is a brush of the user by a lens that `next` lacks. Messages say so.
void keepOwnBrushes(Session& next, const Session& shown, std::vector<std::string>& messages);

} // namespace tessera::app
