#pragma once

#include "vis/scene/camera.h"
#include "vis/scene/clipping.h"
#include "vis/scene/geometry.h"
#include "vis/scene/layers.h"
#include "vis/scene/lens.h"
#include "vis/scene/lighting.h"
#include "vis/scene/limits.h"
#include "vis/scene/selection.h"
#include "vis/scene/tone.h"
#include "vis/transfer/transfer_function.h"
#include "volume/reconstruct/gradient.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tessera::vis {

enum class Filter { AverageQuasi, Average, Tetrahedral };
inline constexpr std::string_view kFilterNames[] = {"quasi", "average", "tetrahedral"};

/// What samples composite volumes; see vis/optics/proxy.h.
enum class Proxy { Rays, Slices, Shells, Stacks };
inline constexpr std::string_view kProxyNames[] = {"rays", "slices", "shells", "stacks"};

/// Settings of the shared ray caster.
struct RenderParams {
    Filter filter =
        Filter::AverageQuasi; ///< reconstruction; on CC "quasi" is prefiltered trilinear, the others trilinear
    float detail = 1;         ///< pixels; voxels of bricked data finer than this are shown at a coarser level
    float importance = 1;     ///< levels by which bricks with nothing to show may be coarser
    RenderLimits limits;
    float stepVoxels = 0.5f; ///< distance between samples, in cells of the finest level that the picture wants
    volume::GradientSpan gradient = volume::GradientSpan::Neighbours;
    int normalBits = 0;     ///< of either coordinate of a gradient's direction, 0: as they are
    bool jitter = false;    ///< vis/optics/jitter.h
    int samples = 4;        ///< rays per pixel of a still
    bool cullHidden = true; ///< bricks behind what is opaque stay coarse: vis/demand/hidden_bricks.h
    float adaptiveStep = 0; ///< vis/optics/adaptive_step.h

    Proxy proxy = Proxy::Rays;

    bool operator==(const RenderParams&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.filter,
              FieldInfo{
                  .key = "filter", .unit = "", .doc = "Reconstruction between lattice points", .names = kFilterNames});
        visit(self.stepVoxels,
              FieldInfo{.key = "step",
                        .unit = "voxel",
                        .doc = "Distance between samples along a ray, in voxels of the finest level drawn",
                        .range = Range{0.05, 4},
                        .logScale = true});
        visit(self.detail, FieldInfo{.key = "detail",
                                     .unit = "pixel",
                                     .doc = "Voxels smaller than this are shown at a coarser level, in data too large "
                                            "for one texture; 0 = full resolution",
                                     .range = Range{0, 8}});
        visit(self.importance,
              FieldInfo{.key = "importance",
                        .unit = "level",
                        .doc = "Number of levels by which the least important bricks may be coarser than the most "
                               "important one; 0 = the level depends on the size on screen only",
                        .range = Range{0, 4}});
        visit(self.limits, FieldInfo{.key = "limits", .unit = "", .doc = "Limits of memory and time"});
        visit(self.gradient,
              FieldInfo{.key = "gradient",
                        .unit = "",
                        .doc = "How gradients are computed: by differences of the nearest neighbours in the lattice "
                               "(sharp; along the diagonals on BCC), or over two cells along the axes (smooth)",
                        .names = volume::kGradientSpanNames});
        visit(self.normalBits,
              FieldInfo{.key = "normalBits",
                        .unit = "bit",
                        .doc = "Bits for each of the two coordinates of the gradient direction in shading; 0 = exact",
                        .range = Range{0, 16}});
        visit(self.proxy,
              FieldInfo{
                  .key = "proxy",
                  .unit = "",
                  .doc =
                      "Proxy geometry of composite volumes: rays, or for comparison planes facing the viewer (slices), "
                      "spheres around the eye (shells) or lattice planes (stacks). Other layers always use rays",
                  .names = kProxyNames});
        visit(self.jitter,
              FieldInfo{.key = "jitter",
                        .unit = "",
                        .doc = "Shift the samples of each ray at random: fine noise instead of wood-grain artefacts"});
        visit(self.samples, FieldInfo{.key = "samples",
                                      .unit = "",
                                      .doc = "Rays per pixel when the picture is at rest",
                                      .range = Range{1, 64}});
        visit(self.cullHidden, FieldInfo{.key = "cullHidden",
                                         .unit = "",
                                         .doc = "Keep bricks behind opaque ones coarse until they become visible"});
        visit(self.adaptiveStep,
              FieldInfo{.key = "adaptiveStep",
                        .unit = "",
                        .doc = "Largest change of light and opacity over one step; where volumes are smooth under "
                               "their transfer functions steps become longer. 0 = all steps have the same length",
                        .range = Range{0, 0.1}});
    }
};

/// Everything that decides one rendered picture of the data (texts and axes are drawn over it by the views).
struct Scene {
    Camera camera;
    std::vector<Layer> layers;                        ///< drawn first to last; volume-like ones share one ray loop
    std::map<std::string, TransferFunction> transfer; ///< by channel, or Layer::transfer; others use the default
    Selection selection;
    RenderParams render;
    std::vector<GeometryLayer> geometry; ///< meshes and lines, made outside of the renderer
    Lighting lighting;
    std::vector<Clip> clips; ///< what is drawn lies on the kept side of all
    std::vector<Lens> lenses;
    Tone tone;
    glm::dvec3 stretch{1};
    glm::dvec3 cursor{0}; ///< physical
    double time = 0;
    glm::vec3 background{0.11f, 0.12f, 0.14f}; ///< sRGB
    std::optional<Paper> paper = {};           ///< in place of the background; see paperOf()
    bool showGround = true;                    ///< else the picture carries its opacity and lies on nothing
    bool showBox = true;                       ///< wire box around the data
    glm::vec3 boxColor{0.6f};
    bool operator==(const Scene&) const = default;
};

/// The transfer function of a channel (or of a layer with one of its own) in a scene, the default one if it has none.
const TransferFunction& transferFor(const Scene& scene, const std::string& name);

/// Surfaces of the scene's geometry, one behind the other, that are kept for each pixel: 0 where there is none, 1 where
/// all are opaque, else kPeels.
int peelsOf(const Scene& scene);

/// Whether there is anything to see of a layer of geometry.
bool drawn(const Scene& scene, const GeometryLayer& layer);

/// The lenses of a scene.
std::vector<PlacedLens> placeLenses(const Scene& scene, const WorldFrame& frame);

/// What the picture lies on: the scene's paper; or the paper that a visible layer's drawing wants (not in a lens
/// alone), cream under charcoal, dark under chalk; nullopt: the background.
std::optional<Paper> paperOf(const Scene& scene);
/// Its colour or the background's, sRGB.
glm::vec3 groundColor(const Scene& scene);

} // namespace tessera::vis
