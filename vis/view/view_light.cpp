#include "vis/view/view_light.h"

#include "vis/raycast/ray_uniforms.h"

namespace tessera::vis {

ViewLight::Progress ViewLight::bind(RenderTools& tools, const RenderCall& call, const LightBaker::Medium& medium,
                                    const LightBaker::Rows& rows) {
    const Lighting& lighting = call.scene.lighting;
    const GLuint first = GLuint(rayUnits(call.plan).light);
    Progress maps, volume;
    if (usesMaps(lighting)) maps = bindMaps(tools, call, first);
    if (lighting.shadows.any()) volume = bindVolume(tools, call, medium, rows, first + 2);
    return {maps.done && volume.done, maps.changed || volume.changed};
}

packet::SceneLight ViewLight::bound(const Lighting& lighting) const {
    packet::SceneLight out;
    if (usesMaps(lighting)) out.maps = maps_.maps();
    if (lighting.shadows.any()) out.volume = baker_.light();
    return out;
}

ViewLight::Progress ViewLight::bindMaps(RenderTools& tools, const RenderCall& call, GLuint firstUnit) {
    const std::uint64_t former = maps_.version();
    const bool here = maps_.update(call.scene.lighting, call.scene.camera, call.request.wait,
                                   [&](const std::string& message) { tools.messages.push_back(message); });
    const bool changed = mapsPending_ && maps_.version() != former;
    mapsPending_ = !here;
    glBindTextureUnit(firstUnit, maps_.diffuse());
    glBindTextureUnit(firstUnit + 1, maps_.specular());
    glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    return {here, changed};
}

/// Binds the last light volume, or unattenuated light if there is none.
void ViewLight::bindTextures(const RenderTools& tools, GLuint firstUnit) const {
    glBindTextureUnit(firstUnit, baker_.version() > 0 ? baker_.visible() : tools.noShadow.name());
    glBindTextureUnit(firstUnit + 1, baker_.scattered() != 0 ? baker_.scattered() : tools.noLight.name());
}

ViewLight::Progress ViewLight::bindVolume(RenderTools& tools, const RenderCall& call, const LightBaker::Medium& medium,
                                          const LightBaker::Rows& rows, GLuint firstUnit) {
    const RayPlan& plan = call.plan;
    const FrameRequest& request = call.request;
    if (plan.layers.empty() && (plan.peels == 0 || !call.scene.lighting.shadows.meshes)) { // slices cast no shadow
        glBindTextureUnit(firstUnit, tools.noShadow.name());
        glBindTextureUnit(firstUnit + 1, tools.noLight.name());
        return {};
    }
    Progress progress;
    bool updated = true;
    if (rows)
        baker_.update(call.scene, call.info(), medium, rows, request.budgetMs / 3, request.wait);
    else
        updated = drawVolume(tools, call, medium, progress);
    bindTextures(tools, firstUnit);
    if (!updated) return progress;
    const bool changed = version_ != baker_.version();
    version_ = baker_.version();
    return {baker_.ready(), changed};
}

/// Continues with extinction that OpenGL draws; false, with `progress`, while its program is not ready.
bool ViewLight::drawVolume(RenderTools& tools, const RenderCall& call, const LightBaker::Medium& medium,
                           Progress& progress) {
    const RayPlan& plan = call.plan;
    const FrameRequest& request = call.request;
    ProgramRecipe recipe = rayRecipe(plan, call.scene, call.grid(), false);
    recipe.vertex = "screen.vert.glsl";
    recipe.fragment = "light_medium.frag.glsl";
    addDriver(recipe, tools.driver);
    const ProgramAnswer answer = request.wait ? ProgramAnswer{tools.programs.find(recipe), ProgramStage::Ready}
                                              : tools.programs.request(recipe, request.budgetMs / 4);
    progress = {request.wait || answer.stage == ProgramStage::Failed, false};
    if (!answer.program) return false;
    const std::function<void(const Program&)> setUniforms = [&](const Program& program) {
        setRayUniforms(program, plan, call.scene, call.info(), call.grid(), request.size, 1);
    };
    if (answer.stage == ProgramStage::Linked) {
        setUniforms(*answer.program);
        const Texture like = makeTexture2D({1, 1}, kMediumFormat, GL_NEAREST, "like the light volume's medium");
        tools.programs.warmUp(recipe, makeFramebuffer({like.name()}, "like the light volume's medium"));
        progress = {false, false};
        return false;
    }
    const LightBaker::Pass pass{*answer.program, setUniforms, tools.vertices.name(), !tools.driver.timerQueries};
    baker_.update(call.scene, call.info(), medium, pass, request.budgetMs / 3, request.wait);
    return true;
}

} // namespace tessera::vis
