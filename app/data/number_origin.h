#pragma once

#include "volume/derived/derived_recipe.h"
#include "volume/flow/computed_numbers.h"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::volume {
class BrickSource;
}

namespace tessera::codec {
struct Metadata;
}

namespace tessera::app {

/// Origin of the samples that numbers are read from.
struct NumberOrigin {
    bool mesh = false;      ///< resampled from cells that are no regular grid
    bool stored = false;    ///< read from an archive, or from data packed as one
    bool originals = false; ///< parameters called "... as computed" are what the others were before they were packed
    std::string lattice;    ///< of the stored samples: "CC", "BCC", "D4*", "one grid of D4*" or "one grid of BCC"
    bool exact = true;      ///< every stored sample is what was packed
    double maxError = 0;    ///< else: bound on the error of a sample, relative to the largest range of its components
    double absError = 0;    ///< in the unit of the parameter; 0 = no such bound
    bool ofComponents = false; ///< that is relative to the range of each component
    bool unpacked = false;     ///< computed on the grid of the source from samples of the lattice
    bool corrected = false;    ///< then: with labels and absent samples as they were, and bounds that hold there
    /// Then: largest errors at the samples of the source, by parameter, in its unit; empty: none is known.
    std::vector<double> resampleErrors = {};
    bool discarded = false; ///< bricks of little importance are left out
    bool alongTime = false; ///< time takes the place of an axis: read between times
    std::shared_ptr<const volume::BrickSource> spaceOfPlane = {}; ///< then: the data in space that the plane is of
    std::string other =
        {}; ///< where those of the other data beside (volume/derived/other_source.h) come from, "" = none
    /// Parameters that are read; those after them are derived from these. -1: all.
    int parameters = -1;
    /// Numbers of regions as they were computed, which an archive with a bound keeps; null: none are known.
    std::shared_ptr<const volume::ComputedNumbers> computed = {};
    double packedBytes = 0; ///< of the archive that data shown as packed are drawn from; 0: there is none
    bool operator==(const NumberOrigin&) const = default;
};

/// Of data that are no archive.
NumberOrigin computedOrigin(const volume::DatasetInfo& info);
/// Of an archive: of its stored samples, or `unpacked` to the grid of the source.
NumberOrigin storedOrigin(const codec::Metadata& metadata, bool unpacked = false);

/// Bound on the error of a sample of a channel, in its unit; 0 where it is exact.
double errorBound(const NumberOrigin& origin, const volume::DatasetInfo& info, const volume::Channel& channel);

/// How far samples of a channel may be from those that were packed, in its unit.
struct PackingBound {
    double most = 0;            ///< 0 = exact
    bool measured = false;      ///< the largest error found when it was packed; else what the archive keeps to
    bool beforeLattice = false; ///< without what resampling to the lattice of the archive has changed
    bool operator==(const PackingBound&) const = default;
};
/// Nothing where it is not known: of derived parameters, of labels, and of archives without bricks of little
/// importance.
std::optional<PackingBound> packingBound(const NumberOrigin& origin, const volume::DatasetInfo& info,
                                         const volume::Channel& channel);
/// What kind of bound it is: "bound of the archive", "largest error measured when packed", "bound of the archive,
/// without resampling".
std::string boundKind(const PackingBound& bound);
/// "0.05 K": rounded up to two digits.
std::string boundWithUnit(double bound, std::string_view unit);

/// The derived parameters with the bounds that those called uncertainties are made of, as their data have them.
std::vector<volume::DerivedParameter> withBounds(std::vector<volume::DerivedParameter> derived,
                                                 const NumberOrigin& origin, const volume::DatasetInfo& info);

/// Whether that bound holds for numbers of regions, too: every sample of the source is there, in its own region.
bool boundsNumbers(const NumberOrigin& origin);

/// Bound on the error of numbers of regions or sections of a channel that are made of its samples, in its unit: 0 if
/// these are as computed, NaN if it is not known.
double numberError(const NumberOrigin& origin, const volume::DatasetInfo& info, const volume::Channel& channel);

/// By position in `channels`: whether statistics of the regions of a label ("" = everything) are known as computed, at
/// all of these times.
std::vector<bool> knownStatistics(const NumberOrigin& origin, const volume::DatasetInfo& info,
                                  const std::vector<int>& channels, const std::string& label,
                                  const std::vector<double>& times);

/// In words, for these channels (indices of info.channels(); none: all): "as computed", "resampled from a mesh",
/// "stored on CC, error at most 0.4 K".
std::string originText(const NumberOrigin& origin, const volume::DatasetInfo& info,
                       const std::vector<int>& channels = {});

/// The same of numbers that are known as computed for some of the channels.
std::string originText(const NumberOrigin& origin, const volume::DatasetInfo& info, const std::vector<int>& channels,
                       const std::vector<bool>& known);

/// The same as the first line of a table: "# numbers: as computed".
std::string originLine(const NumberOrigin& origin, const volume::DatasetInfo& info,
                       const std::vector<int>& channels = {});

} // namespace tessera::app
