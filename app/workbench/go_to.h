#pragma once

#include "app/queries/extreme_query.h"
#include "app/ui/commands.h"

#include <vector>

/// The cross-hair goes to places that are named by what is there.
namespace tessera::app {

class Workbench;

/// Looks for the place in the background, then moves the cross-hair there, and the time where all were asked about; a
/// message says what was found.
void goTo(Workbench& workbench, const ExtremeQuestion& question);

/// To the least and the greatest value of the parameter shown; and to keep the place of the cross-hair as a probe.
std::vector<Command> placeCommands(Workbench& workbench);
/// Those of every parameter of the data now open, for the palette.
std::vector<Command> extremesOfParameters(Workbench& workbench);

} // namespace tessera::app
