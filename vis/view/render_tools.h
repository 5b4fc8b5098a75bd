#pragma once

#include "vis/gl/driver.h"
#include "vis/gl/program_cache.h"
#include "vis/raycast/brush_uniforms.h"
#include "vis/raycast/clock.h"
#include "vis/raycast/look_uniforms.h"
#include "vis/raycast/ray_plan.h"
#include "vis/view/frame_request.h"
#include "vis/view/geometry_pass.h"

/// What the passes of a picture are given.
namespace tessera::vis {

/// Input of one call of Renderer::render(). ViewDemand::bind() binds `plan` to resident data.
struct RenderCall {
    const Scene& scene;
    const FrameRequest& request;
    const volume::BrickSource& source;
    RayPlan& plan;

    const volume::DatasetInfo& info() const { return source.info(); }
    const volume::BrickGrid& grid() const { return source.grid(); }
    WorldFrame frame() const { return worldFrame(info(), scene.stretch); }
};

/// Resources shared by all pictures of a context.
struct RenderTools {
    explicit RenderTools(const Driver& given) : driver(given) {}

    Driver driver;
    VertexArray vertices = makeVertexArray("no vertices");
    ProgramCache programs{driver.compilesAtFirstDraw};
    BrushTables brushes;
    GeometryPass geometryPass{driver};
    GrainTexture grain;
    Texture noShadow = makeUniform3D(glm::vec4(1), "no shadow"), noLight = makeUniform3D(glm::vec4(0), "no light");
    std::vector<std::string> messages;
};

} // namespace tessera::vis
