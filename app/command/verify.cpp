#include "app/command/command.h"

namespace tessera::app {

void addVerifyCommand(CLI::App&) {}

} // namespace tessera::app
