#pragma once

#include "codec/archive/archive.h"
#include "volume/field/dataset.h"
#include "volume/field/slices.h"

#include <optional>
#include <vector>

namespace tessera::codec {

/// Where the frames of a data set go in an archive that it begins or continues.
struct Continuation {
    std::size_t firstTime = 0;
    std::vector<int> parameterOf; ///< number in the archive of each parameter of the data set
    bool wholeTimes = true;       ///< with each of its times one of the archive is whole

    /// The beginning of an archive of its own.
    explicit Continuation(const volume::DatasetInfo& info);
    Continuation() = default;
    /// Widens the ranges of the archive's parameters by those that are known of the data set's.
    void widen(const volume::DatasetInfo& from, volume::DatasetInfo& to) const;
    /// Adds what resampling has cost, by parameter of the data set, to what `now`, the metadata of the archive as it
    /// was, notes: `before`, that the data set had already (of what was resampled at an unknown cost: nothing), and
    /// `then`.
    void noteResampled(const std::vector<std::optional<ResampleError>>& before, const std::vector<ResampleError>& then,
                       Metadata& now) const;
};

/// True if a data set brings later times of parameters of the archive, not further parameters.
bool bringsTimes(const Archive& archive, const volume::DatasetInfo& added);

/// Further parameters for an archive, without labels that it holds already.
struct FurtherParameters {
    volume::Dataset dataset; ///< its frames say the parts of their samples (volume/field/part_masks.h)
    volume::SliceLoad slices;
};
/// Nothing where a data set brings no such label, or other parameters that the archive has. `slices` may be null.
/// Throws Error where the archive's label is not that of the data.
std::optional<FurtherParameters> withoutKnownLabels(const volume::Dataset& source, const volume::SliceLoad& slices,
                                                    const Archive& archive);

/// How the data set of `metadata`, made as for an archive of its own, continues an archive; `metadata` becomes that of
/// both together. Throws Error when lattice, bricks, parameters or times do not fit.
Continuation continuationOf(const Archive& archive, Metadata& metadata);

} // namespace tessera::codec
