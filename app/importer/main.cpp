// tessera-import. The only program that links VTK, so that the workbench starts light and a reader that crashes costs
// an error message.
#include "app/importer/serve.h"
#include "volume/system/free_memory.h"

int main(int argc, char** argv) {
    tessera::volume::keepFreeMemory();
    return tessera::importer::serve(argc, argv);
}
