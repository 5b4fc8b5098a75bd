#pragma once

#include "volume/base/progress.h"
#include "volume/base/unit_conversion.h"
#include "volume/bricks/brick_source.h"
#include "volume/bricks/source_at_time.h"

#include <memory>
#include <string>
#include <string_view>

/// Two data sets compared: two designs, two solvers, before and after packing.
namespace tessera::volume {

/// Suffix of parameter names of the other data set: "T (other)".
inline constexpr std::string_view kOtherSuffix = " (other)";

/// Values of one data set at the samples of another: the samples themselves where both have the same grid, else
/// interpolated (volume/reconstruct/probe.h) at full resolution and absent outside of its box; labels are those of the
/// nearest sample.
class SampledOnto {
public:
    /// Samples onto the grid of `onto`. Lengths of a source that states no unit of them are taken in that of the other.
    /// Throws Error when the units of length cannot be converted.
    SampledOnto(const std::shared_ptr<const BrickSource>& source, const BrickSource& onto);
    bool sameGrid() const { return sameGrid_; }
    /// key.channel and key.time refer to `at`, which is the source or sourceAt(it); the rest of the key refers to the
    /// grid.
    BrickSamples read(const BrickSource& at, const BrickKey& key) const;
    /// The source, behind a brick cache.
    const std::shared_ptr<const BrickSource>& source() const { return source_; }

private:
    std::shared_ptr<const BrickSource> source_;
    BrickGrid grid_;
    double scale_ = 1; ///< units of length of the source per one of the grid
    bool sameGrid_ = false;
};

/// A data set with the parameters of another one appended, named "T (other)", on its grid and at its times. If either
/// has a single parameter, that of the other data set is named after the first one. The other data set is read at the
/// same time, interpolated between its stored times and absent outside them; one with a single time is used at every
/// time. The provenance says so. Throws Error when units of length or time cannot be converted.
std::shared_ptr<const BrickSource> withOther(std::shared_ptr<const BrickSource> source,
                                             std::shared_ptr<const BrickSource> other);

/// The other data set of a source made by withOther; null for other sources.
std::shared_ptr<const BrickSource> otherOf(const BrickSource& source);
/// The first data set of a source made by withOther.
std::shared_ptr<const BrickSource> firstDataOf(const BrickSource& source);

/// Whether two data sets have samples at the same positions, in any bricks. Throws Error when units of length cannot be
/// converted.
bool samePlaces(const BrickSource& source, const BrickSource& other);

/// "interpolated onto the grid of A" or, where nothing is interpolated, "on the same grid", which parameters are
/// converted before their difference is taken: ", p from bar to Pa", and where only one states a unit of length, what
/// that of the other is taken to be: ", its lengths taken in mm, as its file states no unit of length". Units of time
/// likewise.
std::string otherText(const BrickSource& source, const BrickSource& other);

/// The channel of the other data set with the same name; empty if there is none.
std::optional<int> otherChannel(const DatasetInfo& info, int channel);

/// Converts values of otherChannel(info, channel) to the unit of the channel. Empty if there is no such channel, or its
/// unit measures something else.
std::optional<UnitConversion> otherConversion(const DatasetInfo& info, int channel);

/// One channel of a source at a time.
struct FieldAt {
    std::shared_ptr<const BrickSource> source;
    int channel = 0;
    TimePair time;
};

/// The difference of two fields at the samples of the second one, as a data set with one parameter "difference" and one
/// time; absent where either is, in the unit of the first. Its range is that of a coarse level. Throws Error when the
/// units cannot be converted, Cancelled.
std::shared_ptr<const BrickSource> differenceSource(const FieldAt& of, const FieldAt& minus,
                                                    const Progress& progress = {});

} // namespace tessera::volume
