#pragma once

#include "vis/scene/scene.h"
#include "volume/bricks/brick_source.h"
#include "volume/field/time_pair.h"
#include "volume/reconstruct/part_choice.h"
#include "volume/reconstruct/reconstruct.h"

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
    bool mixedParts = false;        ///< samples of different parts are mixed
};

/// What is seen at a place, and which part of the parameter it belongs to.
struct Reading {
    double value = 0;
    int part = 0;
};

/// All samples of one channel at one time, full resolution, ready for one filter, with a margin of samples beyond the
/// lattice so that no reading needs a special case. Between two stored times both are held and mixed: of a place, what
/// is present in either takes part by its weight (labels: the nearer time). Of a parameter of several parts each is
/// held by itself, the samples of the others absent; a place shows the part that volume/reconstruct/part_choice.h says.
class Samples {
public:
    /// Throws Error when the source does.
    Samples(const volume::BrickSource& source, int channel, volume::TimePair time, Filter filter, const Flaws& flaws);

    /// The value at a continuous cell position (Lattice::toCells), and its part; nullopt where absent.
    std::optional<Reading> read(glm::dvec3 cells) const;
    std::optional<double> value(glm::dvec3 cells) const;
    /// The part that a position belongs to, present or not.
    int part(glm::dvec3 cells) const;
    /// The value by the samples of one part alone; nullopt where they carry less than half of the weight.
    std::optional<double> ofPart(int part, glm::dvec3 cells) const;
    /// The same as far as they reach; NaN beyond.
    double continued(int part, glm::dvec3 cells) const;
    /// What trilinear interpolation (on BCC the mean over both sublattices) makes of `of` the samples around a
    /// position; nullopt where the value would be absent.
    std::optional<glm::dvec4> blended(glm::dvec3 cells, const std::function<glm::dvec4(double)>& of) const;
    bool categorical() const { return categorical_; }
    /// Bounds of the samples that are present among the texels [begin, end), lo > hi where none is; texels hold one
    /// sample of each sublattice and may lie up to 4 beyond the lattice.
    Range bounds(glm::ivec3 begin, glm::ivec3 end) const;
    /// Whether any sample is absent, of each part.
    bool someAbsent() const;

private:
    struct View;
    struct ColorBlend {
        glm::dvec4 sum{0};
        double coverage = 0;
    };
    struct OnePart {
        int label; ///< channel
        const volume::Parts& parts;
        std::size_t part;
    };
    Samples(const volume::BrickSource& source, int channel, volume::TimePair time, Filter filter, const Flaws& flaws,
            std::optional<OnePart> only);
    ColorBlend colorBlend(glm::dvec3 cells, const std::function<glm::dvec4(double)>& of) const;
    View view() const;
    volume::Blend blend(glm::dvec3 cells) const;
    volume::LevelGeometry geometry_;
    Filter filter_;
    Flaws flaws_;
    bool categorical_ = false;
    std::vector<std::unique_ptr<Samples>> parts_; ///< then nothing is held here; empty: there is one part
    std::unique_ptr<Samples> later_;
    double laterWeight_ = 0;
    int brickSize_ = 0;
    glm::ivec3 first_{0}, size_{0}; ///< storage indices held
    std::vector<double> values_;
    std::vector<std::uint8_t> present_; ///< empty: all
};

} // namespace tessera::vis::reference
