// tessera-import. The only program that links VTK, so that the workbench starts light and a reader that crashes costs
// an error message.
#include "app/importer/serve.h"

int main(int argc, char** argv) {
    return tessera::importer::serve(argc, argv);
}
