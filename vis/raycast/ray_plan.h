#pragma once

#include "vis/bricks/texels.h"
#include "vis/gl/program.h"
#include "vis/optics/ray_setup.h"
#include "vis/raycast/brush_tests.h"
#include "vis/scene/scene.h"

#include <optional>
#include <string>
#include <vector>

/// Plan of one ray-casting program for a scene: the channels it samples, and the variant it needs.
namespace tessera::vis {

/// A channel as the program sees it now.
struct BoundField {
    int channel = 0;
    bool categorical = false;
    bool raw = false;          ///< the samples themselves, whatever the filter: for pre-classification
    std::string transfer = {}; ///< Layer::transfer
    double timeShift = 0;      ///< Layer::timeShift
    double laterWeight = 0;    ///< of the later frame, where the plan has some
    int parts = 1;             ///< that the channel has (volume/field/parts.h); part j > 0 is field `more` + j - 1
    int more = 0;
    int part = -1;        ///< that the field holds; -1: all there is
    bool nearest = false; ///< the nearest sample is shown: a label's, or for want of room for parts
    // Filled from what is resident:
    GLuint texture = 0;
    int level = 0;
    TexelEncoding encoding;
    glm::ivec3 textureSize{1}; ///< texels with halo
    const BlockRanges* blocks = nullptr;
    GLuint pages = 0, atlas = 0; ///< 0: the texture is all there is
    glm::ivec3 atlasSize{1};
};

struct RayLayer {
    int layer = 0; ///< index into Scene::layers
    int row = 0;   ///< of the transfer tables
    RayStyle style = RayStyle::Composite;
    int field = 0; ///< index into RayPlan::fields
    bool shaded = false;
    RayLookup lookup = RayLookup::Curve;
    bool gradient = false; ///< shows the gradient's magnitude
    int page = -1;         ///< of the plane tables, for Plane and Slab
    int lens = -1;         ///< of RayPlan::lenses that it is drawn in, -1: everywhere
    int look = 0;          ///< parts of the look: lookBits()
    int color = -1;        ///< field that gives the colours, -1: its own
    int colorRow = -1;     ///< of the transfer tables, for these
    /// The places between which all opacity lies, filled with the tables; none: there are gaps between.
    std::optional<glm::vec2> opaque = {};
    BrushEffect brushes = BrushEffect::Fade;
};

struct SliceUse {
    int layer = 0, field = 0, lens = -1;
    BrushEffect brushes = BrushEffect::Fade;
    int row = 0; ///< of the transfer tables
};

/// Fields that a plan has at most, whatever the driver offers.
inline constexpr int kMostFields = 23;

/// Requirements of a scene, independent of what is resident.
struct RayPlan {
    std::vector<BoundField> fields;
    /// Fields from here on, of those of one time, are further parts of the ones before.
    int channels = 0;
    int later = 0; ///< fields from `later` on are the later frames of those before; 0: all are on stored times
    std::vector<RayLayer> layers;
    std::vector<SliceUse> slices;
    std::vector<int> brushFields;
    BrushTests brushes;             ///< that act
    std::vector<PlacedLens> lenses; ///< in world space
    int peels = 0;                  ///< layers of rasterised geometry that lie among the samples
    int pages = 0;                  ///< of the plane tables
    int rows = 0;                   ///< of the transfer tables: of layers, then of slices, then of layers' colours
    int mostFields = kMostFields;   ///< that there is room for
    std::string limit;              ///< what there is no room for; "": nothing
    bool empty() const { return layers.empty() && slices.empty() && peels == 0; }
};

/// Fields that a program with so many samplers has room for, beside what else the scene looks up; bricks take two each.
int mostFields(int samplers, const Scene& scene, bool bricked);

/// Visible layers whose channel the data set has; layers of unknown channels are left out, and those for whose channels
/// `mostFields` leaves no room. A channel of several parts
/// has a field for each; where that would be more than `mostFields` its nearest samples are shown, which mix nothing,
/// and its surfaces are left out.
RayPlan planRays(const Scene& scene, const volume::DatasetInfo& info, int mostFields = kMostFields);

/// The program variant of a plan whose fields are bound. `skip`: leap over empty blocks.
ProgramRecipe rayRecipe(const RayPlan& plan, const Scene& scene, const volume::BrickGrid& grid, bool skip);

} // namespace tessera::vis
