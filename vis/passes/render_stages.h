#pragma once

#include "vis/bricks/residency.h"
#include "vis/demand/box_lines.h"
#include "vis/passes/render_tools.h"
#include "vis/passes/view_target.h"

/// The stages of drawing a picture, for the renderer alone: render_stages.cpp asks for data and says what changed,
/// frame.cpp schedules drawing within the budget, ray_pass.cpp draws tiles, packet_pass.cpp those that the processor
/// draws, present.cpp presents them. Stages with a state of their own for each view (ViewDemand, ViewTables, ViewLight,
/// ViewHidden) have their own files.
namespace tessera::vis {

/// What casts the rays of one picture: program variants, or packets.
struct RayPrograms {
    PacketView* packets = nullptr;            ///< instead of programs: the processor casts the rays
    const GeometryBuffer* geometry = nullptr; ///< for these: what they meet, rasterised; null: nothing
    const Program* program = nullptr;
    const Program* beyond = nullptr; ///< for pixels outside all lenses; null: same as `program`
    RayPlan beyondPlan;              ///< the plan of `beyond`
    Scene beyondScene;
};

/// The part of a picture to cast rays for.
struct RayTile {
    glm::ivec2 size{0}; ///< of the whole picture
    Tile tile;
    const std::vector<Tile>* parts = nullptr; ///< draw only what lies in one of these parts of the tile; null: all
    double stepFactor = 1;
    int pass = 0; ///< of a supersampled frame
};

/// What all pictures of a renderer share, and the stages that draw them.
struct RenderStages {
    RendererOptions options;
    Residency residency;
    std::shared_ptr<const volume::BrickSource> source;
    /// Samples of `source` for the processor, and those of a coarse level; null: it reads all as soon as these.
    std::shared_ptr<packet::PacketVolumes> volumes, coarseVolumes;
    const volume::BrickSource* formerSource =
        nullptr; ///< the source that `source` replaced with shared samples: its pictures stay until new ones are drawn
    RenderTools tools;
    EngineUse engine;    ///< of the last picture with a volume or surface
    std::string limits;  ///< last message about exceeded limits
    std::string refusal; ///< last message about refused memory

    RenderStages(const RendererOptions& given, const Driver& driver)
        : options(given), residency(given, driver), tools(driver) {}

    // render_stages.cpp
    bool resize(ViewTarget& target, const FrameRequest& request);
    void beginFrame(ViewTarget& target, const Scene& scene, const FrameRequest& request);
    bool bind(ViewTarget& target, const RenderCall& call, FrameStatus& status);
    void show(ViewTarget& target, const Scene& scene, std::uint64_t resident);
    bool draw(ViewTarget& target, const RenderCall& call, Clock::time_point start, FrameStatus& status);
    void drawAll(ViewTarget& target, const RenderCall& call, Clock::time_point start, FrameStatus& status);
    bool findsHidden(const Scene& scene) const;
    const HiddenInView* hiddenIn(const ViewTarget& target, const Scene& scene) const;
    void takeHidden(ViewTarget& target, bool wait);
    void probe(ViewTarget& target, const RenderCall& call);
    bool reveals(ViewTarget& target, const RenderCall& call);

    // frame.cpp
    void refine(ViewTarget& target, const RenderCall& call, Clock::time_point start);
    void drawWithin(ViewTarget& target, const RenderCall& call, const RayPrograms& programs, Clock::time_point start,
                    bool lit);
    void postpone(ViewTarget& target, const Scene& scene);
    void giveUp(ViewTarget& target, const RenderCall& call);
    void sayLimits(const RenderCall& call, const std::string& ofEngine);
    void bindPlan(const ViewTarget& target, const RenderCall& call);
    bool ready(ViewTarget& target, const RenderCall& call, const RenderCall& own, const ProgramAnswer& answer,
               const ProgramRecipe& recipe);
    void addBeyond(RayPrograms& programs, ViewTarget& target, const RenderCall& call);
    void setUniforms(const RayPrograms& programs, const ViewTarget& target, const RenderCall& call, double stepFactor);
    void drawReduced(ViewTarget& target, const RenderCall& call, const RayPrograms& programs, Pace::Reduction how);
    void drawHalf(ViewTarget& target, const RenderCall& call, const RayPrograms& programs, Clock::time_point start);
    void castTile(ViewTarget& target, const RenderCall& call, const RayPrograms& programs, const Tile& tile, int pass);
    void drawTile(ViewTarget& target, const RenderCall& call, const RayPrograms& programs, const Tile& tile, int pass);
    void drawTiles(ViewTarget& target, const RenderCall& call, const RayPrograms& programs, Clock::time_point start,
                   bool lit);

    // ray_pass.cpp
    ProgramRecipe variant(const ViewTarget& target, const Scene& scene, const RayPlan& plan) const;
    void geometry(ViewTarget& target, const RenderCall& call, const RayBuffer& buffer, const Tile& tile, int pass = 0);
    void rays(const RayPrograms& programs, const RenderCall& call, RayBuffer& buffer, const RayTile& what);
    void proxies(const Program& program, const RenderCall& call, const RayBuffer& buffer, double stepFactor);
    void accumulate(ViewTarget& target, const RenderCall& call, const RayPrograms& programs, const RayTile& what);

    // packet_pass.cpp
    void setVolumes();
    std::string refusalOfPackets(const ViewTarget& target, const RenderCall& call) const;
    bool chooseEngine(ViewTarget& target, const RenderCall& call, FrameStatus& status);
    void useSamples(ViewTarget& target, bool coarse);
    bool findSamples(ViewTarget& target, const RenderCall& call);
    bool drawByPackets(ViewTarget& target, const RenderCall& call, Clock::time_point start, FrameStatus& status);
    bool drawMeanwhile(ViewTarget& target, const RenderCall& call, Clock::time_point start);
    void endMeanwhile(ViewTarget& target);
    void refineByPackets(ViewTarget& target, const RenderCall& call, Clock::time_point start);
    void prefetchTime(PacketView& packets, const RenderCall& call);
    void castPackets(const RayPrograms& programs, const RenderCall& call, const RayBuffer& buffer, const RayTile& what);

    // present.cpp
    BoxLines box(const ViewTarget& target, const Scene& scene) const;
    void setPresented(const Program& resolve, const ViewTarget& target, const Scene& scene, const BoxLines& lines,
                      const RayBuffer& from);
    void present(ViewTarget& target, const Scene& scene, const RayBuffer& from, const Tile& tile);
    void presentPackets(ViewTarget& target, const Scene& scene, const Tile& tile);
    bool presentable(const ViewTarget& target, const Scene& scene);
    void blank(ViewTarget& target, const Scene& scene);
    void nothing(ViewTarget& target, const Scene& scene);
};

} // namespace tessera::vis
