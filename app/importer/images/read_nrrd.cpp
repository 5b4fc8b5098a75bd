// NRRD in every form: main programs without VTK read those with raw samples themselves.
#include "app/importer/images/serve_stored.h"
#include "app/importer/readers/check_file.h"
#include "app/importer/readers/read_files.h"
#include "volume/import/files/nrrd.h"

namespace tessera::importer {

void openNrrd(Source& source) {
    serveStored(source, volume::parseNrrd(readPart(source.path, 0, volume::kMostNrrdHeader)));
}

} // namespace tessera::importer
