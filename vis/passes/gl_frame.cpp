#include "vis/passes/gl_frame.h"

#include "vis/demand/lens_pixels.h"
#include "vis/passes/packet_frame.h"
#include "vis/passes/present.h"
#include "vis/passes/ray_pass.h"
#include "vis/passes/tiles.h"
#include "vis/raycast/ray_uniforms.h"
#include "vis/shapes/proxy.h"

#include <algorithm>

namespace tessera::vis {

namespace {

constexpr double kProbeShrink = 3;

/// Keeps the former picture if a program variant does not compile.
void giveUp(RendererState& shared, ViewTarget& target, const RenderCall& call) {
    target.shown.compiling = false;
    if (!target.state.presented() || call.request.wait) showNothing(shared, target, call.scene);
    target.state.setDone(PictureState::Done::Converged);
}

/// Binds the textures of a plan's fields, and its tables.
void bindPlan(RendererState& shared, ViewTarget& target, const RenderCall& call) {
    const RayPlan& plan = call.plan;
    const RayUnits units = rayUnits(plan);
    for (std::size_t i = 0; i < plan.fields.size(); ++i) {
        const BoundField& field = plan.fields[i];
        glBindTextureUnit(GLuint(i), field.texture);
        if (!field.atlas) continue;
        glBindTextureUnit(GLuint(units.pages) + GLuint(i), field.pages);
        glBindTextureUnit(GLuint(units.atlases) + GLuint(i), field.atlas);
    }
    target.tables.bind(units);
    if (std::ranges::any_of(plan.layers,
                            [](const RayLayer& layer) { return layer.look & bitOf(LookFeature::Charcoal); }))
        glBindTextureUnit(GLuint(units.grain), shared.tools.grain.get());
    glBindTextureUnit(GLuint(units.lassos), shared.tools.brushes.update(plan.brushes));
    glBindTextureUnit(GLuint(RayUnits::kStrokes), target.strokes.update(plan, call.scene));
}

/// Prepares the program of `own`, which is all or part of the call, for drawing; false while it is not ready.
bool readyToDraw(RendererState& shared, ViewTarget& target, const RenderCall& call, const RenderCall& own,
                 const ProgramAnswer& answer, const ProgramRecipe& recipe) {
    if (!answer.program) return false;
    const bool linked = answer.stage == ProgramStage::Linked;
    if (!shared.tools.driver.compilesAtFirstDraw) return true;
    if (!linked && !shared.tools.programs.firstUse(*answer.program)) return true;
    const glm::ivec2 size = target.buffers.size;
    setRayUniforms(*answer.program, own.plan, own.scene, own.info(), own.grid(), size, 1);
    rasteriseGeometry(shared, target, call, target.buffers.full, target.buffers.everything());
    if (linked) {
        shared.tools.programs.warmUp(recipe, target.buffers.full.framebuffer);
        return false;
    }
    // The first draw compiles machine code: make it now, before any timing.
    target.buffers.reduced.first = {0, 0};
    castRays(shared, {.program = answer.program, .beyondPlan = {}, .beyondScene = {}}, call, target.buffers.reduced,
             {.size = size, .tile = {size / 2, size / 2 + 1}});
    glFinish();
    target.state.dropReduced();
    return true;
}

/// Adds a program without lenses for pixels outside all lenses, once it is ready.
void addBeyond(RendererState& shared, RayPrograms& programs, ViewTarget& target, const RenderCall& call) {
    programs.beyondPlan = beyondLenses(call.plan);
    if (programs.beyondPlan.empty() || drawnByProxy(call.scene) ||
        lensTiles(call.plan.lenses, call.scene, target.buffers.size).value_or(std::vector<Tile>()).empty())
        return;
    programs.beyondScene = call.scene;
    programs.beyondScene.lenses.clear();
    const ProgramRecipe recipe = rayVariant(shared, target, programs.beyondScene, programs.beyondPlan);
    const ProgramAnswer answer = call.request.wait
                                     ? ProgramAnswer{shared.tools.programs.find(recipe), ProgramStage::Ready}
                                     : shared.tools.programs.request(recipe, 0);
    const RenderCall beyond{programs.beyondScene, call.request, call.source, programs.beyondPlan};
    if (readyToDraw(shared, target, call, beyond, answer, recipe)) programs.beyond = answer.program;
}

} // namespace

void refineByOpenGl(RendererState& shared, ViewTarget& target, const RenderCall& call, Clock::time_point start) {
    const Scene& scene = call.scene;
    const FrameRequest& request = call.request;
    const PictureState& state = target.state;
    const bool probing = target.demand.probing();
    const bool done = state.full() ? state.converged() || request.moving : state.reduced() && request.moving;
    // What is occluded is known to pictures of OpenGL alone.
    if (done && !probing && !(target.meanwhile && findsHidden(shared, scene))) return;
    if (!target.pace().beginCall() && !request.wait) return;
    target.tables.update(call, shared.residency.revision(), target.demand.frames());
    const bool presents = request.wait || presentable(shared, target, scene); // its small programs are compiled first
    const ProgramRecipe recipe = rayVariant(shared, target, scene, call.plan);
    target.shown.compiling = true;
    const ProgramAnswer answer =
        request.wait ? ProgramAnswer{shared.tools.programs.find(recipe), ProgramStage::Ready}
                     : shared.tools.programs.request(recipe, target.meanwhile ? 0 : request.budgetMs / 4);
    if (!answer.program && (answer.stage == ProgramStage::Failed || request.wait)) return giveUp(shared, target, call);
    if (!answer.program && (probing || !drawWhileCompiling(shared, target, call, start)))
        return postpone(shared, target, scene);
    if (!answer.program) return;
    bindPlan(shared, target, call);
    ViewLight::Progress light;
    if (!probing) {
        sayLimits(shared, call, call.plan.limit);
        light = target.light.bind(shared.tools, call,
                                  {shared.residency.revision(), target.demand.time().value_or(0), false});
        if (light.changed) target.redraw(target.buffers.everything());
    }
    if (!readyToDraw(shared, target, call, call, answer, recipe) || !presents) return postpone(shared, target, scene);
    target.shown.compiling = false;
    handOverToGl(shared, target);
    RayPrograms programs{.program = answer.program, .beyondPlan = {}, .beyondScene = {}};
    addBeyond(shared, programs, target, call);
    if (probing) return drawReduced(shared, target, call, programs, {kProbeShrink, 1});
    drawWithin(shared, target, call, programs, start, light.done);
}

} // namespace tessera::vis
