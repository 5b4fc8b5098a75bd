#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/field/parts.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

/// Derivatives and smoothing on the samples of one brick at its level, with its neighbourhood.
namespace tessera::volume {

using ReadSamples = std::function<BrickSamples(const BrickKey&)>;

/// The label of a channel's parts (volume/field/parts.h).
struct PartLabel {
    int channel = 0; ///< of the label
    Parts parts;
};
/// The label of a channel's parts; empty if it has one part.
std::optional<PartLabel> partLabel(const DatasetInfo& info, int channel);

/// A brick with `reach` samples of each sublattice around it. Samples beyond the lattice are absent, and from a sample
/// so are those of other parts.
class Neighbourhood {
public:
    Neighbourhood(const BrickGrid& grid, const BrickKey& key, int reach, const ReadSamples& read,
                  const std::optional<PartLabel>& label = {});

    glm::ivec3 size() const { return size_; } ///< of the brick itself
    /// The sample at a place of the brick, `steps` samples of its sublattice away along an axis; nothing where absent.
    std::optional<double> at(glm::ivec3 in, int axis = 0, int steps = 0) const;
    /// Change per length in space along an axis: of the parabola through the sample and its two neighbours at their
    /// distances (the central difference where these are equal), one-sided beside absent samples, nothing where both
    /// neighbours are absent. 0 along an axis on which there is one sample only. The sample itself must be present.
    std::optional<double> derivative(glm::ivec3 in, int axis) const;

private:
    BrickSamples samples_;
    /// Place in space, along an axis, of the sample at a place of the brick.
    double place(glm::ivec3 in, int axis) const;

    BrickGrid grid_;
    int level_;
    std::vector<std::uint8_t> parts_; ///< of the samples; empty: all are of one
    glm::ivec3 size_, first_, whole_;
    glm::dvec3 spacing_; ///< on the sheet, between samples of a sublattice at this level
    int reach_, slices_;
};

/// A Gaussian of `width` cells over the present samples of each sublattice, part by part, cut at three widths; absent
/// samples stay absent. Beyond the faces of the lattice there are none.
BrickSamples smoothed(const BrickGrid& grid, const BrickKey& key, double width, const ReadSamples& read,
                      const std::optional<PartLabel>& label = {});

} // namespace tessera::volume
