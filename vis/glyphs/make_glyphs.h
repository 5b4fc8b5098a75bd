#pragma once

#include "vis/glyphs/glyph_places.h"
#include "vis/scene/geometry.h"
#include "vis/scene/selection.h"
#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <optional>

/// Layers of glyphs as geometry.
namespace tessera::vis {

/// What glyphs are made from, besides their layer.
struct GlyphMoment {
    int time = 0;
    glm::dvec3 stretch{1};
    glm::dvec3 cursor{0};                  ///< physical
    const DoiFunction* interest = nullptr; ///< null: 1 everywhere
};

/// Glyphs at their places, with the values of the data there: those of volume/reconstruct/probe.h at full resolution,
/// NaN where absent.
struct GlyphSamples {
    std::vector<GlyphStand> stands;
    std::vector<std::vector<double>> values; ///< for each of GlyphLayer::parts, physical, in the order of `stands`
    std::vector<float> colors;               ///< what is looked up in the transfer function
    std::vector<glm::dvec3> directions; ///< as drawn, length 1; 0: none, nothing is drawn; empty: they stand upright
    std::vector<double> interest;       ///< degree of interest; empty: 1
    double size = 0;                    ///< of the largest glyph, as drawn
    glm::dvec3 facing{0, 0, 1};         ///< of those without a surface, as drawn
};

/// Samples a layer. Places where no parameter of the glyph has a value have none. Throws Error, Cancelled.
GlyphSamples sampleGlyphs(const volume::BrickSource& source, const GlyphLayer& layer, const GlyphMoment& moment,
                          const Progress& progress = {});

/// The share, 0..1, that each part of the kind has for physical values of GlyphLayer::parts (NaN = absent); of tensors
/// -1..1, where the length of the largest tensor that the ranges allow is 1. kPartAtRest where nothing moves a part.
std::vector<double> glyphShares(const GlyphLayer& layer, std::span<const double> values,
                                const volume::DatasetInfo& info);

/// The mesh of a layer, with the colours of its parts. Larger where the degree of interest is higher.
std::shared_ptr<const Geometry> makeGlyphs(const volume::BrickSource& source, const GlyphLayer& layer,
                                           const GlyphMoment& moment, const Progress& progress = {});

} // namespace tessera::vis
