#include "vis/renderer_impl.h"

#include "vis/model/context_blur.h"
#include "vis/model/grain.h"
#include "vis/technique/box_lines.h"
#include "vis/technique/look_uniforms.h"
#include "vis/technique/ray_uniforms.h"
#include "volume/error.h"

#include <cmath>

namespace tessera::vis {

namespace {

constexpr int kSeenUnit = 44; ///< beyond those of any plan

} // namespace

void Renderer::Impl::present(ViewTarget& target, const Scene& scene, bool reduced, const Tile& tile) {
    const bool blurs = blursContext(scene), toned = scene.tone.curve != ToneCurve::None;
    const std::optional<Paper> paper = paperOf(scene);
    const bool rough = paper && paper->tooth > 0;
    BoxLines lines;
    if (scene.showBox && source)
        lines = boxLines(scene.camera, worldFrame(source->info().bounds, scene.stretch).halfSize, target.size);
    const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
    const Program* found = programs.find({"screen.vert.glsl",
                                          "resolve.frag.glsl",
                                          {},
                                          {{"BLUR", flag(blurs)},
                                           {"LINES", flag(!lines.edges.empty())},
                                           {"TONE", flag(toned)},
                                           {"PAPER", flag(rough)},
                                           {"GROUND", flag(scene.showGround)}}});
    if (!found) throw Error("the program that presents pictures does not compile");
    const Program& resolve = *found;
    const RayBuffer& from = reduced ? target.reduced : target.full;
    const glm::vec2 used(reduced ? target.reducedSize : target.size), whole(from.size), first(from.first);
    resolve.set("source", 0);
    resolve.set("sourceScale", used / glm::vec2(target.size) / whole);
    resolve.set("sourceFirst", first / whole);
    resolve.set("sourceLimit", (first + used - 0.5f) / whole);
    resolve.set("background", glm::vec3(linearFromSrgb(glm::dvec3(groundColor(scene)))));
    if (rough) {
        resolve.set("paper", glm::vec2(paper->tooth, kGrainTexels / double(paper->grain)));
        resolve.set("grainTile", RayUnits::kPaper);
        glBindTextureUnit(GLuint(RayUnits::kPaper), grain.get());
    }
    resolve.set("boxColor", glm::vec3(linearFromSrgb(glm::dvec3(scene.boxColor))));
    resolve.set("lineWidth", 1.3f);
    resolve.set("toneCurve", int(scene.tone.curve));
    resolve.set("seen", kSeenUnit);
    resolve.set("blurRadius", scene.selection.contextBlur * float(target.size.y));
    resolve.set("blurTaps", kBlurTaps);
    if (blurs) glBindTextureUnit(GLuint(kSeenUnit), from.pick.name());
    resolve.set("tone", glm::vec2(std::exp2(scene.tone.exposure), scene.tone.white));
    resolve.set("edgeCount", int(lines.edges.size()));
    resolve.set("frontCount", lines.front);
    resolve.set("edges", lines.edges);
    glBindTextureUnit(0, from.color.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.outputFramebuffer.name());
    glViewport(0, 0, target.size.x, target.size.y);
    glEnable(GL_SCISSOR_TEST);
    glScissor(tile.begin.x, tile.begin.y, tile.end.x - tile.begin.x, tile.end.y - tile.begin.y);
    glUseProgram(resolve.name());
    glBindVertexArray(vertices.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    target.shows = true;
}

/// The background alone: nothing is loaded, or the program does not compile.
void Renderer::Impl::nothing(ViewTarget& target, const Scene& scene) {
    const float empty[] = {0, 0, 0, 0}, nowhere[] = {-1e9f, 0, 0, 0}, endless[] = {1e9f, 0, 0, 0};
    glDisable(GL_SCISSOR_TEST);
    glClearNamedFramebufferfv(target.full.framebuffer.name(), GL_COLOR, 0, empty);
    glClearNamedFramebufferfv(target.full.framebuffer.name(), GL_COLOR, 1, nowhere);
    glClearNamedFramebufferfv(target.full.framebuffer.name(), GL_COLOR, 2, endless);
    present(target, scene, false, target.everything());
    target.fullValid = target.stillDone = true;
}

} // namespace tessera::vis
