#include "app/command/command.h"

namespace tessera::app {

void addUnpackCommand(CLI::App&) {}

} // namespace tessera::app
