#pragma once

#include "vis/scene/scene.h"
#include "volume/bricks/brick_source.h"
#include "volume/field/time_pair.h"
#include "volume/reconstruct/cubic.h"
#include "volume/reconstruct/part_choice.h"
#include "volume/reconstruct/reconstruct.h"

#include <functional>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

namespace tessera::vis::reference {

/// Deliberate errors that a shader could make. Tests use them to prove that the comparison detects each.
struct Flaws {
    bool additiveBlend = false;     ///< sums samples without attenuation by those in front
    bool unmovedSublattice = false; ///< does not shift the odd BCC sublattice by half a cell
    bool clampedBricks = false;     ///< no halos: beyond its brick a sample repeats the nearest one inside
    bool ignoredMask = false;       ///< treats absent samples as present with value 0
    bool unfiltered = false;        ///< omits the prefilter
    bool mixedParts = false;        ///< mixes samples of different parts
};

/// The value at a position, and the part of the parameter that it belongs to.
struct Reading {
    double value = 0;
    int part = 0;
};

/// All samples of one channel at one time at full resolution, prepared for one filter, with a margin beyond the lattice
/// so that reading needs no special cases. Between two stored times both are held and interpolated: the present ones
/// contribute by weight (labels: the nearer time). If a parameter has several parts, each is held separately with the
/// samples of the others absent; volume/reconstruct/part_choice.h decides which part a position shows.
class Samples {
public:
    /// Throws Error when the source does.
    Samples(const volume::BrickSource& source, int channel, volume::TimePair time, Filter filter, const Flaws& flaws);

    /// The value at a continuous cell position (Lattice::toCells), and its part; nullopt where absent.
    std::optional<Reading> read(glm::dvec3 cells) const;
    std::optional<double> value(glm::dvec3 cells) const;
    /// The part that a position belongs to, whether present or absent.
    int part(glm::dvec3 cells) const;
    /// The value from the samples of one part only; nullopt if they have less than half of the weight.
    std::optional<double> ofPart(int part, glm::dvec3 cells) const;
    /// The same as far as samples of the part have any weight; NaN beyond.
    double continued(int part, glm::dvec3 cells) const;
    /// Trilinear interpolation (on BCC the mean over both sublattices) of `of` applied to the samples around a
    /// position; nullopt where the value would be absent.
    std::optional<glm::dvec4> blended(glm::dvec3 cells, const std::function<glm::dvec4(double)>& of) const;
    bool categorical() const { return categorical_; }
    /// Bounds of the present samples among the texels [begin, end), lo > hi if there are none; texels hold one sample
    /// of each sublattice and may lie up to 4 beyond the lattice.
    Range bounds(glm::ivec3 begin, glm::ivec3 end) const;
    /// Whether any sample is absent; always true if there are several parts.
    bool someAbsent() const;

private:
    struct View;
    struct Inside;
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
    void makeCoefficients();
    template <class Read> volume::Blend filtered(const Read& samples, glm::dvec3 cells) const;
    volume::Blend blend(glm::dvec3 cells) const;
    volume::LevelGeometry geometry_;
    Filter filter_;
    Flaws flaws_;
    bool categorical_ = false;
    std::vector<std::unique_ptr<Samples>>
        parts_; ///< one per part, then this object holds no samples; empty: a single part
    std::unique_ptr<Samples> later_;
    double laterWeight_ = 0;
    int brickSize_ = 0;
    glm::ivec3 first_{0}, size_{0};      ///< range of storage indices held
    int unread_ = 0;                     ///< samples of each sublattice at the ends of that range that no filter reads
    glm::dvec3 innerLo_{0}, innerHi_{0}; ///< cells between which no filter reads beyond it
    std::vector<double> values_;
    std::vector<std::uint8_t> present_; ///< empty: all
};

} // namespace tessera::vis::reference
