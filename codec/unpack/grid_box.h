#pragma once

#include "codec/archive/archive.h"
#include "volume/field/dataset.h"

#include <glm/vec3.hpp>
#include <memory>
#include <mutex>
#include <vector>

namespace tessera::codec {

/// Boxes of samples of an archive on the grid of gridDataset(), at any level, for other programs. Of a CC archive only
/// the bricks that a box touches are decoded (of integers at level 0 their layers of bricks); otherwise whole frames.
/// May be called from any thread.
class GridBoxes {
public:
    explicit GridBoxes(std::shared_ptr<const Archive> archive);

    const Archive& archive() const { return *archive_; }
    /// The data set on the grid of a level; `times` are those that the samples came from. Throws Error where there is
    /// no such level.
    const volume::DatasetInfo& info(int level) const;
    /// The samples [begin, end) of a component, in the type of the level: stored samples at level 0, floats at others
    /// (labels keep their type). Throws Error where the box is not inside the grid, or the data is damaged.
    volume::Field read(int parameter, int component, int time, int level, glm::ivec3 begin, glm::ivec3 end) const;

private:
    bool bricksSuffice(int parameter, int level) const;
    volume::Field readBricks(int parameter, int component, int time, int level, const volume::Lattice& box,
                             glm::ivec3 begin) const;

    std::shared_ptr<const Archive> archive_;
    std::vector<volume::Dataset> levels_; ///< for each level
    mutable std::mutex reading_;          ///< a data set takes one call at a time
};

} // namespace tessera::codec
