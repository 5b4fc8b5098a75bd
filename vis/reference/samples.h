#pragma once

#include "vis/model/scene.h"
#include "volume/brick_source.h"
#include "volume/reconstruct.h"
#include "volume/time_pair.h"

#include <functional>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

namespace tessera::vis::reference {

/// Deliberate errors, each one that a shader could make. Tests use them to show that the comparison would notice.
struct Flaws {
    bool additiveBlend = false;     ///< samples are added without regard to what lies before them
    bool unmovedSublattice = false; ///< the odd BCC sublattice is not moved by half a cell
    bool clampedBricks = false;     ///< no borders: beyond its brick a sample repeats the last one in it
    bool ignoredMask = false;       ///< absent samples count as present with value 0
    bool unfiltered = false;        ///< the prefilter is left out
};

/// All samples of one channel at one time, full resolution, ready for one filter, with a margin of samples beyond the
/// lattice so that no reading needs a special case. Between two stored times both are held and mixed: of a place, what
/// is present in either takes part by its weight (labels: the nearer time).
class Samples {
public:
    /// Throws Error when the source does.
    Samples(const volume::BrickSource& source, int channel, volume::TimePair time, Filter filter, const Flaws& flaws);

    /// The value at a continuous cell position (Lattice::toCells); nullopt where absent.
    std::optional<double> value(glm::dvec3 cells) const;
    /// What trilinear interpolation (on BCC the mean over both sublattices) makes of `of` the samples around a
    /// position; nullopt where the value would be absent.
    std::optional<glm::dvec4> blended(glm::dvec3 cells, const std::function<glm::dvec4(double)>& of) const;
    bool categorical() const { return categorical_; }
    /// Bounds of the samples that are present among the texels [begin, end), lo > hi where none is; texels hold one
    /// sample of each sublattice and may lie up to 4 beyond the lattice.
    Range bounds(glm::ivec3 begin, glm::ivec3 end) const;
    /// Whether any sample is absent.
    bool someAbsent() const;

private:
    struct View;
    View view() const;
    volume::Blend blend(glm::dvec3 cells) const;
    volume::LevelGeometry geometry_;
    Filter filter_;
    Flaws flaws_;
    bool categorical_ = false;
    std::unique_ptr<Samples> later_;
    double laterWeight_ = 0;
    int brickSize_ = 0;
    glm::ivec3 first_{0}, size_{0}; ///< storage indices held
    std::vector<double> values_;
    std::vector<std::uint8_t> present_; ///< empty: all
};

} // namespace tessera::vis::reference
