#include "app/command/command.h"

namespace tessera::app {

void addReplayCommand(CLI::App&) {}

} // namespace tessera::app
