#pragma once

#include "vis/scene/glyph_layer.h"
#include "volume/mesh/surface_mesh.h"

#include <functional>

/// Where glyphs stand. Distances are those of the drawing: of the sheet times the stretch. Glyphs are as large as
/// `apart` at most, so no two overlap.
namespace tessera::vis {

struct GlyphSpace {
    GlyphPlace place = GlyphPlace::Plane;
    bool even = false;
    glm::dvec3 from{0}, to{1}; ///< corners, of the sheet
    glm::dvec3 stretch{1};     ///< lengths of the drawing per length of the sheet
    int count = 100;           ///< fewer where they would overlap, or where the weights leave no room
    std::uint32_t random = 1;  ///< the same places for the same number, on every machine
    double apart = 0;          ///< least distance of two, of the drawing
    glm::dvec3 cursor{0};      ///< of the sheet: the place of one that stands there
    const volume::SurfaceMesh* surface = nullptr; ///< of the sheet; of those that stand on one
};

struct GlyphStand {
    glm::dvec3 place{0};  ///< of the sheet
    glm::dvec3 normal{0}; ///< of a surface, length 1 in the drawing; 0: none
};

/// Weights, 0..1, of many places of the sheet: the density is proportional to it; 0: none stands there.
using GlyphWeights = std::function<std::vector<double>(std::span<const GlyphStand>)>;

/// The axis that a plane between two corners lies across: the thinnest side as drawn, the last of equal ones.
int thinnestAxis(glm::dvec3 edges);

/// Places of glyphs. On a grid those without weight are left out. By blue noise they are kept from many at random, in
/// random order, as long as each is as far from those kept before as its weight demands (dart throwing, as R. Cook,
/// Stochastic sampling in computer graphics, 1986, through a grid of cells); distances are as large as `count` allows.
/// On a surface those outside of the box between the corners are left out. @throws Cancelled what `weights` throws.
std::vector<GlyphStand> placeGlyphs(const GlyphSpace& space, const GlyphWeights& weights);

} // namespace tessera::vis
