#include "app/command/command.h"

namespace tessera::app {

void addInfoCommand(CLI::App&) {}

} // namespace tessera::app
