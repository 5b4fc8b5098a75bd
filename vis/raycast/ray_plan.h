#pragma once

#include "vis/bricks/texels.h"
#include "vis/gl/program.h"
#include "vis/gl/shader_constants.h"
#include "vis/optics/brush_tests.h"
#include "vis/optics/ray_setup.h"
#include "vis/scene/scene.h"

#include <optional>
#include <string>
#include <vector>

/// A plan describes the ray-casting program for a scene: the fields it samples and its variant.
namespace tessera::vis {

/// A channel (or a part of it) as bound to the program.
struct BoundField {
    int channel = 0;
    bool categorical = false;
    bool raw = false;          ///< unfiltered samples, for pre-classification
    std::string transfer = {}; ///< Layer::transfer
    double timeShift = 0;      ///< Layer::timeShift
    double laterWeight = 0;    ///< weight of the later time, if the plan interpolates in time
    int parts = 1; ///< number of the channel's parts (volume/field/parts.h); part j > 0 is field `more` + j - 1
    int more = 0;
    int part = -1;        ///< the part in this field; -1: all samples
    bool nearest = false; ///< nearest-neighbour: for labels, or for want of room for parts
    // Filled from resident data:
    GLuint texture = 0;
    int level = 0;
    TexelEncoding encoding;
    glm::ivec3 textureSize{1}; ///< texels with halo
    const BlockRanges* blocks = nullptr;
    GLuint pages = 0, atlas = 0; ///< 0: the channel is a single texture
    glm::ivec3 atlasSize{1};
};

struct RayLayer {
    int layer = 0; ///< index into Scene::layers
    int row = 0;   ///< of the transfer tables
    RayStyle style = RayStyle::Composite;
    int field = 0; ///< index into RayPlan::fields
    bool shaded = false;
    RayLookup lookup = RayLookup::Curve;
    bool gradient = false; ///< shows the gradient magnitude
    int page = -1;         ///< page of the plane tables, for Plane and Slab
    int lens = -1;         ///< index into RayPlan::lenses of the lens that it is drawn in, -1: everywhere
    int look = 0;          ///< features of the look: lookBits()
    int color = -1;        ///< field that gives the colours, -1: its own
    int colorRow = -1;     ///< row of the transfer tables for these
    /// The interval of positions with opacity, set with the tables; none if it has gaps.
    std::optional<glm::vec2> opaque = {};
    BrushEffect brushes = BrushEffect::Fade;
};

struct SliceUse {
    int layer = 0, field = 0, lens = -1;
    BrushEffect brushes = BrushEffect::Fade;
    int row = 0;          ///< of the transfer tables
    bool strokes = false; ///< has strokes
};

/// Maximal number of fields of a plan, regardless of the driver.
inline constexpr int kMostFields = 23;

/// What a scene needs for ray casting, independent of resident data.
struct RayPlan {
    std::vector<BoundField> fields;
    /// Fields from here on, within those of one time, are further parts of earlier fields.
    int channels = 0;
    int later = 0; ///< fields from `later` on are the later times of those before; 0: no interpolation in time
    std::vector<RayLayer> layers;
    std::vector<SliceUse> slices;
    std::vector<int> brushFields;
    BrushTests brushes;             ///< active brushes
    std::vector<PlacedLens> lenses; ///< in world space
    int peels = 0;                  ///< number of peels of rasterised geometry
    int pages = 0;                  ///< number of pages of the plane tables
    int rows = 0;                   ///< rows of the transfer tables: of layers, then slices, then colour channels
    int mostFields = kMostFields;   ///< capacity of the program
    std::string limit;              ///< what exceeds the capacity; "": nothing
    bool empty() const { return layers.empty() && slices.empty() && peels == 0; }
};

/// Number of fields that a program with so many samplers can have besides its other textures; bricked fields take two
/// each.
int mostFields(int samplers, const Scene& scene, bool bricked);

/// Plans the visible layers. Layers whose channel the data set lacks, or for which `mostFields` leaves no room, are
/// left out. A channel with several parts gets a field for each; if that exceeds `mostFields`, its nearest samples are
/// shown, which never mix parts, and its iso-surfaces are left out.
RayPlan planRays(const Scene& scene, const volume::DatasetInfo& info, int mostFields = kMostFields);

/// The program variant of a plan with bound fields. `skip`: with empty-space skipping.
ProgramRecipe rayRecipe(const RayPlan& plan, const Scene& scene, const volume::BrickGrid& grid, bool skip);

} // namespace tessera::vis
