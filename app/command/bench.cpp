#include "app/command/command.h"

namespace tessera::app {

void addBenchCommand(CLI::App&) {}

} // namespace tessera::app
