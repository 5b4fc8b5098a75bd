#include "vis/optics/surface_light.h"
#include "vis/passes/renderer_impl.h"

#include "vis/raycast/ray_uniforms.h"

#include <algorithm>

namespace tessera::vis {

/// Says once when lights or clips are left out, or parts of channels have no room.
void Renderer::Impl::sayLimits(const Scene& scene, const RayPlan& plan) {
    const auto enabled = [](const auto& all) {
        return std::count_if(all.begin(), all.end(), [](const auto& each) { return each.enabled; });
    };
    std::string now;
    if (!scene.lighting.inMaps && enabled(scene.lighting.lights) > kMaxLights)
        now = "the first " + std::to_string(kMaxLights) + " lights are used; light through maps takes any number";
    if (enabled(scene.clips) > kMaxClips)
        now += (now.empty() ? "" : "; ") + ("the first " + std::to_string(kMaxClips)) + " clips are used";
    if (enabled(scene.lenses) > kMaxLenses)
        now += (now.empty() ? "" : "; ") + ("the first " + std::to_string(kMaxLenses)) + " lenses are used";
    if (!plan.limit.empty()) now += (now.empty() ? "" : "; ") + plan.limit;
    if (now != limits && !now.empty()) messages.push_back(now);
    limits = now;
}

/// Brings cube maps and light volume up to date and binds them; false while a light volume is still being made.
bool Renderer::Impl::bindLight(ViewTarget& target, const Scene& scene, const FrameRequest& request,
                               const RayPlan& plan) {
    sayLimits(scene, plan);
    bool surrounded = true;
    const GLuint first = GLuint(rayUnits(plan).light);
    if (usesMaps(scene.lighting)) {
        const std::uint64_t former = target.lightMaps.version();
        surrounded = target.lightMaps.update(scene.lighting, scene.camera, request.wait,
                                             [&](const std::string& message) { messages.push_back(message); });
        if (target.mapsPending && target.lightMaps.version() != former) target.redraw(target.everything());
        target.mapsPending = !surrounded;
        glBindTextureUnit(first, target.lightMaps.diffuse());
        glBindTextureUnit(first + 1, target.lightMaps.specular());
        glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    }
    if (!scene.lighting.shadows.any()) return surrounded;
    if (plan.layers.empty() && (plan.peels == 0 || !scene.lighting.shadows.meshes)) { // slices alone cast no shadow
        glBindTextureUnit(first + 2, noShadow.name());
        glBindTextureUnit(first + 3, noLight.name());
        return surrounded;
    }
    ProgramRecipe recipe = rayRecipe(plan, scene, source->grid(), false);
    recipe.vertex = "screen.vert.glsl";
    recipe.fragment = "light_matter.frag.glsl";
    const ProgramAnswer answer = request.wait ? ProgramAnswer{programs.find(recipe), ProgramStage::Ready}
                                              : programs.request(recipe, request.budgetMs / 4);
    glBindTextureUnit(first + 2, target.light.version() > 0 ? target.light.visible() : noShadow.name());
    glBindTextureUnit(first + 3, target.light.scattered() != 0 ? target.light.scattered() : noLight.name());
    if (!answer.program) return request.wait || answer.stage == ProgramStage::Failed;
    const auto setUniforms = [&](const Program& program) {
        setRayUniforms(program, plan, scene, source->info(), source->grid(), target.size, 1);
    };
    if (answer.stage == ProgramStage::Linked) {
        setUniforms(*answer.program);
        const Texture matter = makeTexture2D({1, 1}, kMatterFormat, GL_NEAREST, "like the light volume's matter");
        programs.warmUp(recipe, makeFramebuffer({matter.name()}, "like the light volume's matter"));
        return false;
    }
    target.light.update(scene, source->info(), {residency.revision(), target.lastTime.value_or(0)}, *answer.program,
                        setUniforms, vertices.name(), request.budgetMs / 3, request.wait);
    if (target.lightVersion != target.light.version()) {
        target.lightVersion = target.light.version();
        target.redraw(target.everything());
    }
    glBindTextureUnit(first + 2, target.light.version() > 0 ? target.light.visible() : noShadow.name());
    glBindTextureUnit(first + 3, target.light.scattered() != 0 ? target.light.scattered() : noLight.name());
    return surrounded && target.light.ready();
}

} // namespace tessera::vis
