#pragma once

#include "codec/archive/archive.h"
#include "volume/field/dataset.h"

#include <memory>
#include <optional>
#include <vector>

namespace tessera::codec {

/// Maps the frames of a data set to an archive that it starts or continues.
struct Continuation {
    std::size_t firstTime = 0;
    std::vector<int> parameterOf; ///< index in the archive of each parameter of the data set
    bool wholeTimes = true;       ///< after each time of the data set, a time of the archive is complete

    /// The mapping to a new archive.
    explicit Continuation(const volume::DatasetInfo& info);
    Continuation() = default;
    /// Extends the ranges of the archive's parameters by the known ranges of the data set's.
    void widen(const volume::DatasetInfo& from, volume::DatasetInfo& to) const;
    /// Adds resampling errors, per parameter of the data set, to those in `now`, the metadata of the archive so far:
    /// `before` are previous errors of the data set (empty if it was resampled with unknown error), `then` the new
    /// ones.
    void noteResampled(const std::vector<std::optional<ResampleError>>& before, const std::vector<ResampleError>& then,
                       Metadata& now) const;
};

/// Whether a data set adds times to parameters of the archive, rather than parameters.
bool bringsTimes(const Archive& archive, const volume::DatasetInfo& added);

/// The parameters of a data set that an archive lacks, with the parts of samples in their masks
/// (volume/field/part_masks.h), if all other parameters are labels that the archive already has. Empty if the data set
/// has no label of the archive, or has other parameters of the archive. Throws Error if the archive's label differs
/// from that of the data.
std::optional<volume::Dataset> withoutKnownLabels(const volume::Dataset& source,
                                                  const std::shared_ptr<const Archive>& archive);

/// Determines how a data set continues an archive. `metadata` describes the data set as for a new archive, and is
/// changed to that of both together. Throws Error when lattice, bricks, parameters or times do not match.
Continuation continuationOf(const Archive& archive, Metadata& metadata);

} // namespace tessera::codec
