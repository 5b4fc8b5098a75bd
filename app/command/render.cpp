#include "app/command/command.h"

namespace tessera::app {

void addRenderCommand(CLI::App&) {}

} // namespace tessera::app
