#include "vis/passes/present.h"

#include "vis/demand/box_lines.h"
#include "vis/formulas/context_blur.h"
#include "vis/formulas/depth_mask.h"
#include "vis/optics/grain.h"
#include "vis/processor/presented.h"
#include "vis/raycast/look_uniforms.h"
#include "vis/raycast/ray_uniforms.h"
#include "volume/base/error.h"

#include <cmath>

namespace tessera::vis {

namespace {

constexpr int kSeenUnit = 44; ///< beyond the units of any plan

bool isRough(const std::optional<Paper>& paper) {
    return paper && paper->tooth > 0;
}

/// `whole`: every pixel of the picture has one of its own in the source.
ProgramRecipe resolveRecipe(const Scene& scene, bool lines, bool whole) {
    const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
    return {"screen.vert.glsl",
            "resolve.frag.glsl",
            {},
            {{"BLUR", flag(blursContext(scene))},
             {"DEPTH_MASK", flag(scene.depthMask.any())},
             {"LINES", flag(lines)},
             {"WHOLE", flag(whole)},
             {"TONE", flag(scene.tone.curve != ToneCurve::None)},
             {"PAPER", flag(isRough(paperOf(scene)))},
             {"GROUND", flag(scene.showGround)}}};
}

void setDepthMask(const RendererState& shared, const Program& resolve, const ViewTarget& target, const Scene& scene) {
    if (!scene.depthMask.any()) return;
    const WorldFrame frame = shared.source ? worldFrame(shared.source->info(), scene.stretch) : WorldFrame{};
    const DepthSpan span = depthSpan(scene.camera, frame);
    resolve.set("depthSpan", glm::vec2(span.near, span.perDistance));
    resolve.set("depthRadius", scene.depthMask.width * float(target.buffers.size.y));
    resolve.set("depthMask", glm::vec2(scene.depthMask.strength, scene.depthMask.lighten ? 1 : 0));
    resolve.set("depthTaps", kDepthTaps);
}

/// Sets all uniforms and textures of the presenting program, except its viewport.
void setPresented(RendererState& shared, const Program& resolve, const ViewTarget& target, const Scene& scene,
                  const BoxLines& lines, const RayBuffer& from) {
    const std::optional<Paper> paper = paperOf(scene);
    const glm::vec2 used(from.used), whole(from.size), first(from.first);
    resolve.set("source", 0);
    resolve.set("sourceScale", used / glm::vec2(target.buffers.size) / whole);
    resolve.set("sourceFirst", first / whole);
    resolve.set("sourceLimit", (first + used - 0.5f) / whole);
    resolve.set("background", glm::vec3(linearFromSrgb(glm::dvec3(groundColor(scene)))));
    if (isRough(paper)) {
        resolve.set("paper", glm::vec2(paper->tooth, kGrainTexels / double(paper->grain)));
        resolve.set("grainTile", RayUnits::kPaper);
        glBindTextureUnit(GLuint(RayUnits::kPaper), shared.tools.grain.get());
    }
    resolve.set("boxColor", glm::vec3(linearFromSrgb(glm::dvec3(scene.boxColor))));
    resolve.set("lineWidth", float(kBoxLineWidth));
    resolve.set("toneCurve", int(scene.tone.curve));
    resolve.set("seen", kSeenUnit);
    resolve.set("blurRadius", scene.selection.contextBlur * float(target.buffers.size.y));
    resolve.set("blurTaps", kBlurTaps);
    if (blursContext(scene) || scene.depthMask.any()) glBindTextureUnit(GLuint(kSeenUnit), from.pick.name());
    setDepthMask(shared, resolve, target, scene);
    resolve.set("tone", glm::vec2(std::exp2(scene.tone.exposure), scene.tone.white));
    resolve.set("edgeCount", int(lines.edges.size()));
    resolve.set("frontCount", lines.front);
    resolve.set("edges", lines.edges);
    glBindTextureUnit(0, from.color.name());
}

BoxLines boxOf(const RendererState& shared, const ViewTarget& target, const Scene& scene) {
    if (!scene.showBox || !shared.source) return {};
    return boxLines(scene.camera, worldFrame(shared.source->info(), scene.stretch).halfSize, target.buffers.size);
}

} // namespace

void postpone(RendererState& shared, ViewTarget& target, const Scene& scene) {
    if (!target.state.presented()) showBlank(shared, target, scene);
    target.state.setDone(PictureState::Done::Nothing);
}

void present(RendererState& shared, ViewTarget& target, const Scene& scene, const RayBuffer& from, const Tile& tile) {
    const BoxLines lines = boxOf(shared, target, scene);
    const bool whole = from.first == glm::ivec2(0) && from.used == target.buffers.size;
    const Program* resolve = shared.tools.programs.find(resolveRecipe(scene, !lines.edges.empty(), whole));
    if (!resolve) throw Error("the shader that presents pictures does not compile");
    setPresented(shared, *resolve, target, scene, lines, from);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.buffers.outputFramebuffer.name());
    glViewport(0, 0, target.buffers.size.x, target.buffers.size.y);
    glEnable(GL_SCISSOR_TEST);
    glScissor(tile.begin.x, tile.begin.y, tile.end.x - tile.begin.x, tile.end.y - tile.begin.y);
    glUseProgram(resolve->name());
    glBindVertexArray(shared.tools.vertices.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    target.state.setPresented(true);
}

void presentPackets(RendererState& shared, ViewTarget& target, const Scene& scene, const Tile& tile) {
    const std::vector<std::uint8_t> pixels =
        presented(target.packets.picture, {tile.begin, tile.end}, scene, boxOf(shared, target, scene));
    const glm::ivec2 extent = tile.end - tile.begin;
    glTextureSubImage2D(target.buffers.output.name(), 0, tile.begin.x, tile.begin.y, extent.x, extent.y, GL_RGBA,
                        GL_UNSIGNED_BYTE, pixels.data());
    target.state.setPresented(true);
}

bool presentable(RendererState& shared, const ViewTarget& target, const Scene& scene) {
    const BoxLines lines = boxOf(shared, target, scene);
    bool ready = true;
    for (const bool whole : {true, false}) {
        const ProgramRecipe recipe = resolveRecipe(scene, !lines.edges.empty(), whole);
        const ProgramAnswer answer = shared.tools.programs.request(recipe, 0);
        if (answer.stage == ProgramStage::Linked) {
            setPresented(shared, *answer.program, target, scene, lines, target.buffers.full);
            shared.tools.programs.warmUp(recipe, target.buffers.outputFramebuffer);
        }
        // present() handles both
        ready = (answer.stage == ProgramStage::Ready || answer.stage == ProgramStage::Failed) && ready;
    }
    return ready;
}

void showBlank(RendererState& shared, ViewTarget& target, const Scene& scene) {
    if (presentable(shared, target, scene)) return showNothing(shared, target, scene);
    const glm::vec4 ground(groundColor(scene), scene.showGround ? 1 : 0);
    glDisable(GL_SCISSOR_TEST);
    glClearNamedFramebufferfv(target.buffers.outputFramebuffer.name(), GL_COLOR, 0, &ground.x);
}

void showNothing(RendererState& shared, ViewTarget& target, const Scene& scene) {
    target.buffers.full.clear();
    present(shared, target, scene, target.buffers.full, target.buffers.everything());
    target.state.setDone(PictureState::Done::Converged);
}

} // namespace tessera::vis
