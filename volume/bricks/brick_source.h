#pragma once

#include "volume/bricks/brick_grid.h"
#include "volume/bricks/brick_stats.h"
#include "volume/field/dataset.h"

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace tessera::volume {

/// Samples of one brick at one level, without border: physical values, x fastest, storage order of the lattice.
struct BrickSamples {
    glm::ivec3 size{0};
    std::vector<float> values;
    std::vector<std::uint8_t> present; ///< empty: all present; else one byte per sample, 0 = absent (value undefined)
    /// What values lack of 32-bit integers beyond 2^24, which floats do not hold; empty: nothing. Lost where samples
    /// are mixed; numbers of statistics, formulas and differences are computed from exact().
    std::vector<float> rest = {};

    double exact(std::size_t index) const {
        return rest.empty() ? double(values[index]) : double(values[index]) + double(rest[index]);
    }
    bool isPresent(std::size_t index) const { return volume::isPresent(present, index); }
};

/// Sets BrickSamples::rest where `exactly(i)`, which is within the rounding of values[i], is not that.
void keepRest(BrickSamples& samples, const std::function<double(std::size_t)>& exactly);

/// Range and share of the present samples of a brick; of none an empty range (infinity to -infinity) and 0.
BrickStats statsOfSamples(const BrickSamples& samples);

/// A data set as bricks; implemented by in-memory data sets and by archives. All functions may be called from any
/// thread at any time.
class BrickSource {
public:
    virtual ~BrickSource() = default;
    virtual const DatasetInfo& info() const = 0;
    virtual const BrickGrid& grid() const = 0;
    /// Statistics of a brick; `key.level` is ignored. Cheap for an archive; an in-memory source may have to load a
    /// frame.
    virtual BrickStats stats(const BrickKey& key) const = 0;
    /// Mean and histogram of a brick; `key.level` is ignored. As cheap as `stats`; nothing where they are not known.
    virtual std::optional<BrickDistribution> distribution(const BrickKey& key) const;
    /// Importance of a brick; `key.level` is ignored. As cheap as `stats`; nothing where it is not known.
    virtual std::optional<BrickImportance> importance(const BrickKey& key) const;
    /// Upper bound on the change of a brick at full resolution from key.time to `toTime`, which may be earlier; empty
    /// if unknown. For coarser levels only a change of 0 is meaningful: they are unchanged, too. As cheap as `stats`.
    virtual std::optional<BrickChange> change(const BrickKey& key, int toTime) const;
    /// Reads, and if need be decodes, one brick. Throws Error when the data is damaged.
    virtual BrickSamples read(const BrickKey& key) const = 0;
};

/// Samples of a brick with a border of `halo` samples of each sublattice, as the renderer needs them: CC (n + 2 halo)
/// per axis; BCC (nx + 2 halo, ny + 2 halo, 2 (texels z + 2 halo)), with alternating even and odd slices, starting with
/// an even one. Beyond the lattice the nearest sample is repeated, including its flag. `read` returns one brick without
/// border.
BrickSamples gather(const BrickGrid& grid, const BrickKey& key, int halo,
                    const std::function<BrickSamples(const BrickKey&)>& read);

} // namespace tessera::volume
