#include "app/command/command.h"
#include "volume/system/free_memory.h"

int main(int argc, char** argv) {
    tessera::volume::keepFreeMemory();
    return tessera::app::runCommandLine(argc, argv);
}
