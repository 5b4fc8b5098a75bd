#pragma once

#include "volume/base/progress.h"
#include "volume/field/dataset.h"
#include "volume/import/import_options.h"

#include <string>

namespace tessera::volume {

/// A series of numbered files that is still being written. Its first file decides how the others are read: names and
/// types of arrays, units, the grid of a mesh, absent samples, parts.
struct GrowingSeries {
    std::string first;
    ImportOptions options; ///< as stated, and the absent samples and parts that the first file shows
    DatasetInfo info;      ///< of the first file alone
};

/// Opens the first file of a series. Throws Error, also for options that list the times of the whole series.
GrowingSeries growingSeries(const std::string& first, const ImportOptions& stated, const Progress& progress = {});

/// The times of one file of the series (`first` or a later one), as in openFiles of the whole series: where no file
/// states a time, it is the number in the name. Throws Error if the file cannot be read or does not fit the first one.
Dataset openOfSeries(const GrowingSeries& series, const std::string& path, const Progress& progress = {});

/// A data set with those of its times that are greater than `time`. Throws Error if there is none; `path` names the
/// data in it.
Dataset timesAfter(Dataset data, double time, const std::string& path);

} // namespace tessera::volume
