#pragma once

#include "app/data/open.h"

namespace tessera::app {

/// Opens the window on a request and runs until it is closed. `screenshots`: a file that is written, atomically, with
/// the window's picture each time it has become complete ("" = none; for scripts). Throws MachineError without display
/// or GL 4.5.
void runWindow(const OpenRequest& request, const std::string& screenshots = {});

} // namespace tessera::app
