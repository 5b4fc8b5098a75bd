#pragma once

#include "codec/archive/archive.h"
#include "volume/field/dataset.h"

#include <optional>
#include <vector>

namespace tessera::codec {

/// Mapping from the frames of a data set to an archive that it begins or continues.
struct Continuation {
    std::size_t firstTime = 0;
    std::vector<int> parameterOf; ///< number in the archive of each parameter of the data set
    bool wholeTimes = true;       ///< with each of its times one of the archive is whole

    /// The beginning of an archive of its own.
    explicit Continuation(const volume::DatasetInfo& info);
    Continuation() = default;
    /// Widens the ranges of the archive's parameters by those that are known of the data set's.
    void widen(const volume::DatasetInfo& from, volume::DatasetInfo& to) const;
    /// Adds resampling errors, by parameter of the data set, to those in `now`, the metadata of the archive before:
    /// `before` are errors that the data set had already (empty if it was resampled with unknown error), `then` the new
    /// ones.
    void noteResampled(const std::vector<std::optional<ResampleError>>& before, const std::vector<ResampleError>& then,
                       Metadata& now) const;
};

/// True if a data set has later times of parameters of the archive, instead of further parameters.
bool bringsTimes(const Archive& archive, const volume::DatasetInfo& added);

/// The parameters of a data set that an archive lacks, if all others are labels that it already has; with the parts of
/// samples in their masks (volume/field/part_masks.h). Empty if the data set has no label that the archive has, or
/// other parameters of the archive. Throws Error if the archive's label differs from that of the data.
std::optional<volume::Dataset> withoutKnownLabels(const volume::Dataset& source, const Archive& archive);

/// How a data set continues an archive. `metadata` describes the data set as if for an archive of its own, and becomes
/// that of both together. Throws Error when lattice, bricks, parameters or times do not fit.
Continuation continuationOf(const Archive& archive, Metadata& metadata);

} // namespace tessera::codec
