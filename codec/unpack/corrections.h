#pragma once

#include "codec/archive/archive.h"
#include "codec/container/pack_options.h"
#include "codec/container/resample_error.h"
#include "codec/unpack/prediction.h"
#include "volume/field/dataset.h"

#include <memory>
#include <optional>
#include <vector>

/// Corrections of a BCC or D4* archive: an archive inside it, on the grid of its source, with what its own samples do
/// not tell. (FORMAT.md "Corrections".) Of labels the labels; of numbers which samples are present, and, if the archive
/// keeps a bound, the differences between the samples of the source and their prediction from the stored ones (or where
/// floats cannot say these well enough, the samples). So labels
/// and presence are those of the source, values of different parts are never mixed, and a bound holds at every sample
/// of the source.
namespace tessera::codec {

/// What a part of a data set becomes in an archive.
struct PlaceInArchive {
    std::vector<int> parameterOf; ///< by parameter of the data set
    int firstTime = 0;            ///< index in the archive of its first time
};

/// Corrections, and the errors that stay where there is no bound.
struct Corrections {
    volume::Dataset data;
    PackOptions options; ///< to pack them with
    /// By parameter of the source: set when all of `data` has been read.
    std::shared_ptr<std::vector<ResampleError>> errors;
    std::vector<double> bounds; ///< by parameter, in its unit; 0: none, or a label
};

/// The corrections of an archive for the data set it was packed from, whose lattice is CC. `written` has all frames,
/// and in its metadata the ranges that bounds refer to.
Corrections correctionsOf(std::shared_ptr<const Archive> written, const volume::Dataset& source,
                          const PlaceInArchive& place, const PackOptions& options);

/// Whether all samples of an archive at all times have corrections.
bool isCorrected(const Archive& archive);
/// Whether some are differences, which belong to predictions with the cubic filter between times.
bool hasDifferences(const Archive& archive);

/// One component of a parameter at a time index of the source as a correction gives it: nullopt where the archive has
/// none for it. Throws Error when it is damaged. A function to be called by one thread at a time.
using CorrectedReader = std::function<std::optional<volume::Field>(int parameter, int component, int time)>;
CorrectedReader correctedReader(std::shared_ptr<const Archive> archive, Prediction prediction);

} // namespace tessera::codec
