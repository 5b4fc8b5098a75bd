#include "app/command/command.h"

int main(int argc, char** argv) {
    return tessera::app::runCommandLine(argc, argv);
}
