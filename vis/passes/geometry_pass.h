#pragma once

#include "vis/gl/handles.h"
#include "vis/gl/program.h"
#include "vis/raycast/look_uniforms.h"
#include "vis/raycast/tile.h"
#include "vis/scene/scene.h"
#include "volume/field/dataset.h"

#include <map>

namespace tessera::vis {

/// Rasterised geometry at each pixel: surfaces by distance along the ray, nearest in layer 0 of both arrays.
struct GeometryBuffer {
    Texture color;    ///< linear light, premultiplied
    Texture distance; ///< world units from the ray's origin, kNoGeometry: nothing; BrushEffect of the layer
    Texture depth;
    std::vector<Framebuffer> framebuffers; ///< one per layer
    std::vector<Query> shown;              ///< whether a layer has anything
    glm::ivec2 size{0};
    int peels = 0;
    void resize(glm::ivec2 wanted, int wantedPeels);
};
inline constexpr float kNoGeometry = 1e9f;

/// Draws Scene::geometry by depth peeling (Everitt 2001): each further pass keeps what lies behind the former one.
/// Keeps what it uploaded for as long as someone holds the geometry.
class GeometryPass {
public:
    /// Fills a tile of a picture of `size` pixels, whose lower left one is texel `first` of the buffer; every pixel's
    /// centre is moved by `jitter` pixels. Light is looked up in the texture units from `lightUnit` on
    /// (light_uniforms.h). Nothing is drawn, and no layer made, when the scene has no geometry. `pictureSize`: of the
    /// picture at rest, for what looks measure in pixels; `most`: surfaces behind one another that are drawn, further
    /// layers stay empty; `grain`: called where one draws with it.
    void draw(GeometryBuffer& buffer, const Scene& scene, const volume::DatasetInfo& info, glm::ivec2 size,
              glm::ivec2 first, const Tile& tile, glm::ivec2 pictureSize, int most, int lightUnit, GrainTexture& grain,
              glm::dvec2 jitter = glm::dvec2(0));

private:
    struct Uploaded {
        std::weak_ptr<const Geometry> of;
        Buffer vertices, indices, segments;
        VertexArray mesh, lines;
        GLsizei indexCount = 0, segmentCount = 0;
    };
    const Uploaded& upload(const std::shared_ptr<const Geometry>& geometry);
    void table(const Scene& scene, const volume::DatasetInfo& info);

    const Program& program(const Scene& scene, bool lines, int look);

    std::map<std::string, Program> programs_; ///< by recipe: variants of light, clips and looks
    std::map<const Geometry*, Uploaded> uploaded_;
    Texture table_;
    int tableRows_ = 0;
    std::vector<glm::vec2> maps_; ///< of each layer: place in its table row = scalar * x + y
};

} // namespace tessera::vis
