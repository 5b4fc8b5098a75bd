#pragma once

#include "volume/base/progress.h"
#include "volume/field/dataset.h"
#include "volume/import/files/series.h"
#include "volume/import/import_options.h"

#include <string>
#include <vector>

namespace tessera::volume {

/// Files that are opened together, and what was found in them.
struct OpenedSeries {
    Dataset dataset;
    std::string format; ///< of the first file
    std::vector<std::string> notes;
    std::vector<std::string> absent; ///< the rules for absent samples, stated or suggested by the samples
};

/// Opens what expandPaths lists. Without `readSamples` samples are read only if that is fast. `meshRanges`: see
/// openFiles. Throws Error.
OpenedSeries openSeries(const std::vector<SeriesFile>& entries, const ImportOptions& options, bool readSamples,
                        const Progress& progress, bool meshRanges, Misfits misfits = Misfits::Refused);

} // namespace tessera::volume
