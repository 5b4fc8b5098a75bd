#include "app/command/command.h"

namespace tessera::app {

void addGenerateCommand(CLI::App&) {}

} // namespace tessera::app
