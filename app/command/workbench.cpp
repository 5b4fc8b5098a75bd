#include "app/command/command.h"

namespace tessera::app {

void addWorkbench(CLI::App&) {}

} // namespace tessera::app
