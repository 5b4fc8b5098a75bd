#pragma once

#include "vis/optics/look_shading.h"
#include "vis/optics/shade.h"
#include "vis/packed/packed_light.h"
#include "vis/processor/triangle.h"
#include "vis/scene/drawn_scene.h"
#include "volume/field/dataset.h"

namespace tessera::vis {

/// A geometry layer with all that its colours depend on.
struct SurfaceLayer {
    const GeometryLayer* layer = nullptr;
    int lens = -1;                           ///< index of the lens that it is drawn in, -1: everywhere
    std::optional<DrawnChannel> colors = {}; ///< what its scalars are looked up in; none: its own colour
};

/// What a pixel sees of a triangle, and what the next pixels in its row and its column see of the same one.
struct SurfaceSpot {
    SurfacePoint here, right, above;
};

/// A colour of its own (linear light) and an opacity of a triangle; red below 0: coloured by its values.
inline constexpr glm::vec4 kNoTint{-1, -1, -1, 1};

/// A visible part of rasterised geometry.
struct SurfaceColor {
    double along = 0;    ///< distance along the ray
    glm::dvec4 color{0}; ///< linear light, premultiplied
};

/// The colours of rasterised geometry in one picture. Twin: vis/shaders/geometry.frag.glsl.
class SurfaceShading {
public:
    SurfaceShading(const Scene& scene, const volume::DatasetInfo& info, const packet::SceneLight& light,
                   glm::ivec2 size);
    SurfaceShading(const SurfaceShading&) = delete;
    SurfaceShading& operator=(const SurfaceShading&) = delete;

    const WorldFrame& frame() const { return frame_; }
    /// The layers that are drawn.
    const std::vector<SurfaceLayer>& layers() const { return layers_; }
    /// Distance along the ray to a point.
    double along(glm::dvec3 world) const;
    glm::dvec3 toViewer(glm::dvec3 world) const; ///< direction
    /// nullopt: nothing is seen there, for a clip, a lens or a look.
    std::optional<SurfaceColor> operator()(const SurfaceLayer& layer, bool line, const SurfaceSpot& spot,
                                           glm::vec4 tint = kNoTint) const;

private:
    glm::dvec3 ownColor(const SurfaceLayer& layer, double value) const;
    LookSample lookSample(const GeometryLayer& layer, const SurfaceSpot& spot,
                          const std::array<glm::dvec3, 3>& normals) const;
    glm::dvec3 lit(glm::dvec3 albedo, glm::dvec3 normal, glm::dvec3 world) const;

    const Scene& scene_;
    WorldFrame frame_;
    Ray middle_; ///< through the centre of the picture
    Illumination light_;
    ShadedBy by_;
    packet::SceneLight around_;
    std::vector<PlacedClip> clips_;
    std::vector<PlacedLens> lenses_;
    LookView look_;
    std::vector<SurfaceLayer> layers_;
};

} // namespace tessera::vis
