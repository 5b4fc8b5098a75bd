#pragma once

#include "app/importer/readers/source.h"

/// Readers named in volume/import/files/format_rows.inc, one file each.
namespace tessera::importer {

void openCsv(Source& source);
void openNrrd(Source& source);
void openNifti(Source& source);
void openMetaImage(Source& source);
void openMgh(Source& source);
void openMinc(Source& source);
void openTecplot(Source& source);
void openNumpy(Source& source);
void openHdf(Source& source);
void openNetCdf(Source& source);
void openTiff(Source& source);
void openPng(Source& source);
void openJpeg(Source& source);
void openBmp(Source& source);
void openPnm(Source& source);
void openMrc(Source& source);
void openAmira(Source& source);
void openCube(Source& source);
void openXsf(Source& source);
void openVasp(Source& source);
void openDx(Source& source);
void openBov(Source& source);
void openDicom(Source& source);
void openEnSight(Source& source);
void openCgns(Source& source);
void openExodus(Source& source);
void openFoam(Source& source);
void openFluent(Source& source);
void openGmsh(Source& source);
void openPlot3d(Source& source);
void openVtkHdf(Source& source);
void openFluentHdf(Source& source);
void openXdmf(Source& source);
void openZarr(Source& source);

} // namespace tessera::importer
