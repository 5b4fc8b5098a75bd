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

/// What of a scene's geometry is rasterised.
struct GeometryJob {
    const Scene& scene;
    const volume::DatasetInfo& info;
    const std::vector<PlacedLens>& lenses; ///< of the scene
    glm::ivec2 size{0};                    ///< of the picture drawn, in pixels
    glm::ivec2 first{0};                   ///< texel of the buffer for its lower left pixel
    Tile tile;                             ///< of it, that is filled
    glm::ivec2 pictureSize{0};             ///< of the picture at rest, for what looks measure in pixels
    int most = 0;                          ///< surfaces behind one another that are drawn, further layers stay empty
    int lightUnit = 0;                     ///< texture units from here on have the light (light_uniforms.h)
    glm::dvec2 jitter{0};                  ///< pixels by which every pixel's centre is moved
};

/// Draws Scene::geometry by depth peeling (Everitt 2001): each further pass keeps what lies behind the former one.
/// Keeps what it uploaded for as long as someone holds the geometry.
class GeometryPass {
public:
    /// Nothing is drawn, and no layer made, when the scene has no geometry. `grain`: called where one draws with it.
    void draw(GeometryBuffer& buffer, const GeometryJob& job, GrainTexture& grain);

private:
    struct Uploaded {
        std::weak_ptr<const Geometry> of;
        Buffer vertices, indices, segments;
        VertexArray mesh, lines;
        GLsizei indexCount = 0, segmentCount = 0;
    };
    const Uploaded& upload(const std::shared_ptr<const Geometry>& geometry);
    void table(const Scene& scene, const volume::DatasetInfo& info);

    /// A layer's mesh or lines, with the variant that draws them.
    struct Draw {
        std::size_t layer;
        int lens;
        bool lines;
        const Uploaded* up;
        const Program* program;
    };
    const Program& program(const GeometryJob& job, bool lines, int look);
    std::vector<Draw> collect(const GeometryJob& job, GrainTexture& grain);
    void drawOne(const Draw& each, const GeometryJob& job, int peel) const;

    std::map<std::string, Program> programs_; ///< by recipe: variants of light, clips and looks
    std::map<const Geometry*, Uploaded> uploaded_;
    Texture table_;
    int tableRows_ = 0;
    std::vector<glm::vec2> maps_; ///< of each layer: place in its table row = scalar * x + y
};

} // namespace tessera::vis
