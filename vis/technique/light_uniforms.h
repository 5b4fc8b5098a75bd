#pragma once

#include "vis/gl/handles.h"
#include "vis/gl/program.h"
#include "vis/model/light_maps.h"
#include "vis/model/scene.h"

#include <optional>

/// What a program of the ray caster knows of light: its variant and its uniforms (vis/shaders/lib/bindings.glsl).
namespace tessera::vis {

void addLighting(ProgramRecipe& recipe, const Scene& scene);
/// Texture units of the diffuse and specular maps and of the visible and scattered light: `firstUnit` and on.
void setLightUniforms(const Program& program, const Scene& scene, const WorldFrame& frame, int firstUnit);

/// The cube maps of a picture as textures.
class LightMapTextures {
public:
    /// Makes what has changed; the environment's part only when that has.
    void update(const Lighting& lighting, const Camera& camera);
    GLuint diffuse() const { return diffuse_.name(); }
    GLuint specular() const { return specular_.name(); }

private:
    std::optional<Lighting> madeFor_;
    Camera camera_;
    LightMaps environment_;
    Texture diffuse_, specular_;
};

} // namespace tessera::vis
