#pragma once

#include "vis/gl/driver.h"
#include "vis/gl/handles.h"
#include "vis/gl/program_cache.h"
#include "vis/raycast/look_uniforms.h"
#include "vis/raycast/tile.h"
#include "vis/scene/scene.h"
#include "volume/field/dataset.h"

#include <map>

namespace tessera::vis {

/// Rasterised geometry per pixel: surfaces sorted by distance along the ray, the nearest in layer 0 of both arrays.
struct GeometryBuffer {
    Texture color;    ///< linear light, premultiplied
    Texture distance; ///< world units from the ray origin, kNoGeometry: none; BrushEffect of the layer
    Texture depth;
    std::vector<Framebuffer> framebuffers; ///< one per layer
    std::vector<Query> shown;              ///< occlusion queries: whether a layer has any pixel
    glm::ivec2 size{0};
    int peels = 0;
    void resize(glm::ivec2 wanted, int wantedPeels);
};
inline constexpr float kNoGeometry = 1e9f;

/// The geometry to rasterise, and where to.
struct GeometryJob {
    const Scene& scene;
    const volume::DatasetInfo& info;
    const std::vector<PlacedLens>& lenses; ///< of the scene
    glm::ivec2 size{0};                    ///< of the picture drawn, in pixels; may be reduced
    glm::ivec2 first{0};                   ///< texel of the buffer for its lower left pixel
    Tile tile;                             ///< the part of it to fill
    glm::ivec2 pictureSize{0};             ///< full size of the picture, for looks that measure in pixels
    int most = 0;                          ///< maximal number of peels drawn; further layers stay empty
    int lightUnit = 0;                     ///< first texture unit of the light (light_uniforms.h)
    glm::dvec2 jitter{0};                  ///< offset of the pixel centres, in pixels
};

/// Draws Scene::geometry by depth peeling (Everitt 2001): each pass keeps the nearest surface behind that of the
/// previous pass. Vertex buffers are kept as long as the geometry is referenced elsewhere.
class GeometryPass {
public:
    /// Keeps as many programs as `limit` says: there is one for each combination of lights, clips, lenses and looks.
    explicit GeometryPass(const Driver& driver, ProgramLimit limit = {}) : driver_(driver), limit_(limit) {}

    /// Does nothing, and allocates nothing, if the scene has no geometry. `grain`: used only if a look needs it.
    void draw(GeometryBuffer& buffer, const GeometryJob& job, GrainTexture& grain);
    std::size_t programs() const { return programs_.size(); }

private:
    struct Uploaded {
        std::weak_ptr<const Geometry> of;
        Buffer vertices, tints, strokes, indices, segments;
        VertexArray mesh, lines;
        GLsizei indexCount = 0, segmentCount = 0;
    };
    const Uploaded& upload(const std::shared_ptr<const Geometry>& geometry);
    void table(const Scene& scene, const volume::DatasetInfo& info);

    /// A layer's mesh or lines, and its program variant.
    struct Draw {
        std::size_t layer;
        int lens;
        bool lines;
        const Uploaded* up;
        const Program* program;
    };
    const Program& program(const GeometryJob& job, bool lines, int look);
    void dropUnused();
    std::vector<Draw> collect(const GeometryJob& job, GrainTexture& grain);
    void drawOne(const Draw& each, const GeometryJob& job, int peel) const;

    Driver driver_;
    ProgramLimit limit_;
    using Clock = std::chrono::steady_clock;
    struct Made {
        Program program;
        Clock::time_point used;
    };
    std::map<std::string, Made> programs_; ///< by recipe
    std::map<const Geometry*, Uploaded> uploaded_;
    Texture table_;
    int tableRows_ = 0;
    std::vector<glm::vec2> maps_; ///< per layer: position in its row of the colour table = scalar * x + y
};

} // namespace tessera::vis
