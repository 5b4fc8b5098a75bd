#pragma once

#include "vis/bricks/residency.h"
#include "vis/demand/box_lines.h"
#include "vis/gl/program_cache.h"
#include "vis/passes/renderer.h"
#include "vis/passes/view_target.h"
#include "vis/raycast/brush_uniforms.h"
#include "vis/raycast/look_uniforms.h"
#include "vis/raycast/ray_plan.h"
#include "vis/raycast/ray_tables.h"

/// Inside the renderer: renderer.cpp has what is public, binding.cpp asks for textures, light_binding.cpp for light,
/// ray_pass.cpp draws with them, occlusion.cpp finds what is hidden, present.cpp shows it, frame.cpp does as much of
/// all this as there is time for.
namespace tessera::vis {

using Clock = std::chrono::steady_clock;

inline double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// The variants of the ray caster that one picture is drawn with.
struct RayPrograms {
    const Program* program = nullptr;
    const Program* beyond = nullptr; ///< beyond all lenses; null: that of the whole picture
};

struct Renderer::Impl {
    RendererOptions options;
    Residency residency;
    std::shared_ptr<const volume::BrickSource> source;
    const volume::BrickSource* formerSource =
        nullptr; ///< what `source` goes on with: its pictures stay until there are new
    VertexArray vertices = makeVertexArray("no vertices");
    ProgramCache programs;
    BrushTables brushes;
    GeometryPass geometryPass;
    GrainTexture grain;
    std::string limits;  ///< said last about what there is too much of
    std::string refusal; ///< said last about a picture that the driver has no memory for
    std::vector<std::string> messages;
    Texture noShadow = makeUniform3D(glm::vec4(1), "no shadow"), noLight = makeUniform3D(glm::vec4(0), "no light");

    explicit Impl(const RendererOptions& given) : options(given), residency(given) {}

    // binding.cpp
    bool demandBricks(ViewTarget& target, const Scene& scene, const FrameRequest& request, const RayPlan& plan,
                      const std::vector<ChannelKey>& keys);
    bool bindField(BoundField& field, const ChannelKey& key);
    void bindRanges(ViewTarget& target, RayPlan& plan, const std::vector<ChannelKey>& keys);
    bool bind(ViewTarget& target, const Scene& scene, const FrameRequest& request, RayPlan& plan, FrameStatus& status);

    // ray_pass.cpp
    double workLeft(const BlockDistances& blocks, const std::vector<std::uint8_t>& steps, const Scene& scene) const;
    ProgramRecipe variant(const ViewTarget& target, const Scene& scene, const RayPlan& plan) const;
    ProgramRecipe prepare(ViewTarget& target, const Scene& scene, RayPlan& plan);
    void geometry(ViewTarget& target, const Scene& scene, const RayPlan& plan, glm::ivec2 size, const Tile& tile,
                  int pass = 0);
    const std::vector<Tile>* covered(ViewTarget& target, const Scene& scene, const RayPlan& plan, glm::ivec2 size);
    void rays(const RayPrograms& rayPrograms, const Scene& scene, const RayBuffer& buffer, glm::ivec2 size,
              const Tile& tile, const std::vector<Tile>* parts, double stepFactor = 1, int pass = 0);
    void proxies(const Program& program, const Scene& scene, const RayBuffer& buffer, double stepFactor);
    void accumulate(const RayPrograms& rayPrograms, ViewTarget& target, const Scene& scene, const Tile& tile,
                    const std::vector<Tile>* parts, int pass);

    // occlusion.cpp
    bool findsHidden(const Scene& scene) const;
    void startReach(ViewTarget& target, const Scene& scene);
    void takeReach(ViewTarget& target, bool wait);
    void probe(ViewTarget& target, const Scene& scene, const FrameRequest& request, RayPlan& plan);
    bool reveals(ViewTarget& target, const Scene& scene, const FrameRequest& request, const RayPlan& plan);

    // present.cpp
    BoxLines box(const ViewTarget& target, const Scene& scene) const;
    void setPresented(const Program& resolve, const ViewTarget& target, const Scene& scene, const BoxLines& lines,
                      bool reduced);
    void present(ViewTarget& target, const Scene& scene, bool reduced, const Tile& tile);
    bool presentable(const ViewTarget& target, const Scene& scene);
    void blank(ViewTarget& target, const Scene& scene);
    void nothing(ViewTarget& target, const Scene& scene);

    // light_binding.cpp
    void sayLimits(const Scene& scene, const RayPlan& plan);
    bool bindLight(ViewTarget& target, const Scene& scene, const FrameRequest& request, const RayPlan& plan);

    // renderer.cpp
    bool draw(ViewTarget& target, const Scene& scene, const FrameRequest& request, RayPlan& plan,
              Clock::time_point start, FrameStatus& status);

    // frame.cpp
    void refine(ViewTarget& target, const Scene& scene, const FrameRequest& request, RayPlan& plan,
                Clock::time_point start);
};

} // namespace tessera::vis
