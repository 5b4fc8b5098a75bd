#include "app/command/command.h"

namespace tessera::app {

void addPackCommand(CLI::App&) {}

} // namespace tessera::app
