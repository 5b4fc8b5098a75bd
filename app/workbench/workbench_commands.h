#pragma once

#include "app/queries/extreme_query.h"
#include "app/ui/commands.h"
#include "volume/import/import_options.h"

#include <string>
#include <vector>

/// The commands of the workbench, one list for each menu, with their names and keys. They refer to the workbench they
/// were made for.
namespace tessera::app {

class Workbench;

std::vector<Command> fileCommands(Workbench& workbench);
/// Commands that compare times; they are in no menu.
std::vector<Command> editCommands(Workbench& workbench);
std::vector<Command> viewCommands(Workbench& workbench);
std::vector<Command> layoutCommands(Workbench& workbench);
/// What volume views share or own; they end the menu View.
std::vector<Command> volumeViewCommands(Workbench& workbench);
/// Commands that add to the scene, or choose one of few ways to show it, a part of the next.
std::vector<Command> addingCommands(Workbench& workbench);
/// Commands that change the scene; they are in no menu of the window.
std::vector<Command> sceneCommands(Workbench& workbench);
std::vector<Command> helpCommands(Workbench& workbench);

/// To the least and the greatest value of the parameter shown; and to keep the place of the cross-hair as a probe. A
/// part of editCommands().
std::vector<Command> placeCommands(Workbench& workbench);
/// Planes of the data in space and time in place of the data. A part of editCommands().
std::vector<Command> planeCommands(Workbench& workbench);
/// To the extremes of every parameter of the data now open, for the palette.
std::vector<Command> extremesOfParameters(Workbench& workbench);
/// Looks for a place in the background, then moves the cross-hair there, and the time where all were asked about; a
/// message says what was found.
void goTo(Workbench& workbench, const ExtremeQuestion& question);

/// Shows the data beside those of other files, of which the user states what they do not contain, in the comparison
/// that shows files or in a new one.
void compareWithFiles(Workbench& workbench, const std::vector<std::string>& paths,
                      const volume::ImportOptions& stated = {});

/// Opens files that were dropped on the window. If the dialog for opening is shown they are chosen in it, and it is
/// shown for a raw file whose layout must be stated. Below other dialogs nothing is opened: they ask about what is
/// shown.
void dropFiles(Workbench& workbench, const std::vector<std::string>& paths);

} // namespace tessera::app
