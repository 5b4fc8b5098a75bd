#pragma once

#include "volume/base/progress.h"
#include "volume/import/files/file_block.h"
#include "volume/import/files/series.h"

#include <string>
#include <vector>

namespace tessera::volume {

/// Opens files of other programs through one `tessera-import` process for all of them; returns the blocks of each file.
/// `outside`: whether these may name files elsewhere.
/// The process lives as long as a block does, and answers one request at a time. If it crashes, ends or sends invalid
/// answers, Error is thrown with the file and the last line of stderr; a stop request ends it and throws Cancelled.
std::vector<std::vector<FileBlock>> openForeign(const std::vector<SeriesFile>& entries, Outside outside,
                                                const Progress& progress);

/// The program: $TESSERA_IMPORT, else "tessera-import" beside the running executable; "" when there is none.
std::string findImporter();

} // namespace tessera::volume
