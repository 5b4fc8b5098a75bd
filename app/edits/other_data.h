#pragma once

#include "app/session/session.h"

#include <string>
#include <vector>

namespace tessera::app {

/// Makes a session that a layout was applied to suit data other than those (`made`) the layout was made with: drawings
/// of a field, whose surfaces end at its borders, have the box around them, while a scan shows a body that stands by
/// itself; variants of a comparison that need another model are omitted, those of other sizes of the model shown have
/// its other settings; lenses and lines of profiles lie in the box of the data.
void suitOtherData(Session& session, const volume::DatasetInfo& info, const DataRef& made,
                   std::vector<std::string>& messages);

} // namespace tessera::app
