#pragma once

#include "app/ui/commands.h"

#include <vector>

/// The commands of the workbench, a list for each menu: what the program can do, by which name and key. Each refers to
/// the workbench it was made for.
namespace tessera::app {

class Workbench;

std::vector<Command> fileCommands(Workbench& workbench);
/// Those that calculate with times as well, which are in no menu.
std::vector<Command> editCommands(Workbench& workbench);
std::vector<Command> viewCommands(Workbench& workbench);
std::vector<Command> layoutCommands(Workbench& workbench);
std::vector<Command> helpCommands(Workbench& workbench);

} // namespace tessera::app
