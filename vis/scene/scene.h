#pragma once

#include "vis/scene/camera.h"
#include "vis/scene/clipping.h"
#include "vis/scene/depth_mask.h"
#include "vis/scene/geometry.h"
#include "vis/scene/layers.h"
#include "vis/scene/lens.h"
#include "vis/scene/lighting.h"
#include "vis/scene/limits.h"
#include "vis/scene/selection.h"
#include "vis/scene/tone.h"
#include "vis/transfer/transfer_function.h"
#include "volume/reconstruct/gradient.h"
#include "volume/reconstruct/prefilter.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tessera::vis {

enum class Filter { AverageQuasi, Average, Tetrahedral, Cubic };
inline constexpr std::string_view kFilterNames[] = {"quasi", "average", "tetrahedral", "cubic"};
/// What samples are filtered by before a filter reads them.
constexpr volume::Prefilter prefilterOf(Filter filter) {
    return filter == Filter::AverageQuasi ? volume::Prefilter::Linear
           : filter == Filter::Cubic      ? volume::Prefilter::Cubic
                                          : volume::Prefilter::None;
}

/// How composite volumes are sampled; see vis/shapes/proxy.h.
enum class Proxy { Rays, Slices, Shells, Stacks };
inline constexpr std::string_view kProxyNames[] = {"rays", "slices", "shells", "stacks"};

/// What casts rays. Automatic: the processor where OpenGL itself runs on it, else OpenGL.
enum class Engine { Automatic, OpenGl, Processor };
inline constexpr std::string_view kEngineNames[] = {"auto", "gl", "cpu"};

/// Settings of the shared ray caster.
struct RenderParams {
    Filter filter = Filter::AverageQuasi; ///< reconstruction; on CC "quasi" is prefiltered trilinear, "average" and
                                          ///< "tetrahedral" trilinear
    float detail = 1;                     ///< pixels: bricked data use a coarser level where voxels would be smaller
    float importance = 1;                 ///< number of levels by which unimportant bricks may be coarser
    RenderLimits limits;
    float stepVoxels = 0.5f; ///< sample distance in cells of the finest level wanted
    volume::GradientSpan gradient = volume::GradientSpan::Neighbours;
    int normalBits = 0;     ///< quantisation of gradient directions per coordinate, 0: none
    bool jitter = false;    ///< vis/optics/jitter.h
    int samples = 4;        ///< rays per pixel of a picture at rest, at most
    bool cullHidden = true; ///< occlusion culling: vis/demand/hidden_bricks.h
    float adaptiveStep = 0; ///< vis/optics/adaptive_step.h

    Proxy proxy = Proxy::Rays;
    Engine engine = Engine::Automatic;

    bool operator==(const RenderParams&) const = default;
    static void describe(auto& self, auto&& visit) {
        constexpr std::string_view kParts = "Large data", kGradients = "Gradients", kSteps = "Steps along rays";
        visit(self.filter,
              FieldInfo{.key = "filter",
                        .doc = "Reconstruction between lattice points: linear between prefiltered samples (quasi), "
                               "linear between the samples (average), on BCC from four of them (tetrahedral), or by "
                               "cubic B-splines, with the least error and in several times the time, for pictures at "
                               "rest (cubic). Cubic is for samples as they are: draw a grid on its own lattice, since "
                               "its body-centred samples are corrected for quasi",
                        .names = kFilterNames});
        visit(self.stepVoxels,
              FieldInfo{.key = "step",
                        .doc = "Distance between samples along a ray, in voxels of the finest level drawn",
                        .unit = "voxel",
                        .range = Range{0.05, 4},
                        .logScale = true});
        visit(self.detail, FieldInfo{.key = "detail",
                                     .doc = "Voxels smaller than this are shown at a coarser level by OpenGL, in data "
                                            "too large for one texture; 0 = full resolution, as the processor draws "
                                            "all data",
                                     .unit = "pixel",
                                     .range = Range{0, 8}});
        visit(self.importance,
              FieldInfo{.key = "importance",
                        .doc = "Number of levels by which the least important bricks may be coarser than the most "
                               "important one, as for the detail; 0 = the level depends on the size on screen only",
                        .unit = "level",
                        .range = Range{0, 4},
                        .group = kParts});
        visit(self.limits, FieldInfo{.key = "limits", .doc = "Limits of memory and time", .group = kParts});
        visit(self.gradient,
              FieldInfo{.key = "gradient",
                        .doc = "How gradients are computed: by differences of the nearest neighbours in the lattice "
                               "(sharp; along the diagonals on BCC), or over two cells along the axes (smooth)",
                        .names = volume::kGradientSpanNames,
                        .group = kGradients});
        visit(self.normalBits,
              FieldInfo{.key = "normalBits",
                        .doc = "Bits for each of the two coordinates of the gradient direction in shading; 0 = exact",
                        .unit = "bit",
                        .range = Range{0, 16},
                        .group = kGradients});
        visit(self.proxy,
              FieldInfo{
                  .key = "proxy",
                  .doc =
                      "Proxy geometry of composite volumes: rays, or for comparison planes facing the viewer (slices), "
                      "spheres around the eye (shells) or lattice planes (stacks). Other layers always use rays",
                  .names = kProxyNames,
                  .group = kSteps});
        visit(self.engine,
              FieldInfo{.key = "engine",
                        .doc =
                            "What casts rays: OpenGL, or the vector units of the processor (auto: where OpenGL has no "
                            "graphics card, or still compiles). OpenGL draws what the processor cannot; the status bar "
                            "says which",
                        .names = kEngineNames});
        visit(self.jitter,
              FieldInfo{.key = "jitter",
                        .doc = "Shift the samples of each ray at random: fine noise instead of wood-grain artefacts",
                        .group = kSteps});
        visit(self.samples, FieldInfo{.key = "samples",
                                      .doc = "Rays per pixel when the picture is at rest, at most: fewer where the "
                                             "processor casts them and neighbours are alike; with depth of field 64",
                                      .range = Range{1, 64}});
        visit(self.cullHidden, FieldInfo{.key = "cullHidden",
                                         .doc = "Keep bricks behind opaque ones coarse until they become visible",
                                         .group = kParts});
        visit(self.adaptiveStep,
              FieldInfo{.key = "adaptiveStep",
                        .doc = "Largest change of light and opacity over one step; where volumes are smooth under "
                               "their transfer functions steps become longer. 0 = all steps have the same length",
                        .range = Range{0, 0.1},
                        .group = kSteps});
    }
};

/// Everything that determines a rendered picture of the data (views draw text and axes on top).
struct Scene {
    Camera camera;
    std::vector<Layer> layers;                        ///< in drawing order; ray layers share one ray loop
    std::map<std::string, TransferFunction> transfer; ///< by channel, or Layer::transfer; others use a default
    Selection selection;
    RenderParams render;
    std::vector<GeometryLayer> geometry; ///< meshes and lines, computed outside the renderer
    std::vector<SliceStrokes> strokes;   ///< of slices, computed outside the renderer
    Lighting lighting;
    std::vector<Clip> clips; ///< only what all keep is drawn
    std::vector<Lens> lenses;
    Tone tone;
    DepthMask depthMask;
    glm::dvec3 stretch{1};
    glm::dvec3 cursor{0}; ///< physical
    double time = 0;
    glm::vec3 background{0.11f, 0.12f, 0.14f}; ///< sRGB
    std::optional<Paper> paper = {};           ///< instead of the background; see paperOf()
    bool showGround = true;                    ///< else the picture has an alpha channel and no background
    bool showBox = true;                       ///< wire box around the data
    glm::vec3 boxColor{0.6f};
    bool operator==(const Scene&) const = default;
};

/// Rays per pixel of the scene's picture at rest: with depth of field at least kLensPlaces, each through its own place
/// on the lens.
int raysPerPixel(const Scene& scene);
inline constexpr int kLensPlaces = 64;

/// The transfer function of a channel (or of a layer with its own), a default one if the scene has none.
const TransferFunction& transferFor(const Scene& scene, const std::string& name);

/// Number of depth-peeling layers of the scene's geometry: 0 without geometry, 1 if all is opaque, else kPeels.
int peelsOf(const Scene& scene);

/// The strokes of a slice, null where it has none (yet).
const StrokePicture* strokesOf(const Scene& scene, int layer);

/// Whether a geometry layer is visible.
bool drawn(const Scene& scene, const GeometryLayer& layer);

/// Whether a lens magnifies, so that data appear displaced.
bool lensesBend(const Scene& scene);
std::vector<PlacedLens> placeLenses(const Scene& scene, const WorldFrame& frame);

/// The ground of the picture: the scene's paper, or else the paper of a visible layer's charcoal look (not drawn in a
/// lens), cream under charcoal and dark under chalk; nullopt: the background.
std::optional<Paper> paperOf(const Scene& scene);
/// Colour of the paper or background, sRGB.
glm::vec3 groundColor(const Scene& scene);

} // namespace tessera::vis
