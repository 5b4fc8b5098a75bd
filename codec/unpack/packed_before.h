#pragma once

#include "codec/archive/archive.h"
#include "codec/container/resample_error.h"
#include "volume/field/dataset.h"

#include <memory>
#include <optional>
#include <vector>

namespace tessera::codec {

/// What is known of data that come from an archive (the errors of their samples so far) or belong to others; empty for
/// other data.
struct PackedBefore {
    /// Original grid of the samples, which is not known from their lattice if that is BCC.
    std::optional<volume::Lattice> grid = {};
    bool lossless = true;
    double maxError = 0;                                      ///< bound on |error|, relative to a parameter's range
    std::vector<std::optional<ResampleError>> resampled = {}; ///< Metadata::resampled of that archive
    /// The samples on that grid, which corrections lead back to; empty: unknown, or the data lie on it.
    std::optional<volume::Dataset> source = {};
    bool ofSeries = false; ///< the data are times of a series that others follow or precede
    /// Whether an archive with a bound gets the numbers of regions.
    bool keepsNumbers = true;
    /// Those that the archive keeps; null if it has none.
    std::shared_ptr<const StoredNumbers> numbers = {};
    /// The same times with all parameters that numbers are of, where the data have some of these; empty: the data.
    std::optional<volume::Dataset> whole = {};
};

/// The properties of an archive that pack needs where its stored samples are packed again: their errors so far.
PackedBefore packedBefore(const std::shared_ptr<const Archive>& archive);

} // namespace tessera::codec
