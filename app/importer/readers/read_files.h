#pragma once

#include "app/importer/readers/source.h"

/// Readers named in volume/import/files/format_rows.inc, one file each.
namespace tessera::importer {

void openCsv(Source& source);
void openNrrd(Source& source);
void openTecplot(Source& source);
void openNumpy(Source& source);
void openHdf(Source& source);
void openTiff(Source& source);
void openDicom(Source& source);
void openEnSight(Source& source);
void openCgns(Source& source);
void openExodus(Source& source);
void openFluent(Source& source);
void openGmsh(Source& source);
void openPlot3d(Source& source);

} // namespace tessera::importer
