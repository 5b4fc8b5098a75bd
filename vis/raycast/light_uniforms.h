#pragma once

#include "vis/gl/handles.h"
#include "vis/gl/program.h"
#include "vis/optics/light_maps.h"
#include "vis/scene/scene.h"

#include <functional>
#include <future>
#include <memory>
#include <optional>

/// Program constants and uniforms for lighting (vis/shaders/lib/bindings/light_bindings.glsl).
namespace tessera::vis {

void addLighting(ProgramRecipe& recipe, const Scene& scene);
/// Texture units from `firstUnit` on: diffuse map, specular map, visible and scattered light.
void setLightUniforms(const Program& program, const Scene& scene, const WorldFrame& frame, int firstUnit);

/// The cube maps of a picture as textures.
class LightMapTextures {
public:
    /// Updates changed maps; the expensive environment part only if it changed. An environment picture is read by a
    /// thread, and the former maps are used until then. `wait`: blocks for it. False while something is pending. An
    /// unreadable picture gives no light and one message through `say`.
    bool update(const Lighting& lighting, const Camera& camera, bool wait,
                const std::function<void(const std::string&)>& say);
    /// Number of changes of the maps.
    std::uint64_t version() const { return version_; }
    /// Those of the textures; null: none yet.
    const std::shared_ptr<const LightMaps>& maps() const { return maps_; }
    GLuint diffuse() const { return diffuse_.name(); }
    GLuint specular() const { return specular_.name(); }

private:
    bool readPicture(const Lighting& lighting, bool wait, const std::function<void(const std::string&)>& say);

    std::string path_;               ///< file of `picture_`, read or being read
    std::future<CubeMap> reading_;   ///< valid while the file is being read
    std::optional<CubeMap> picture_; ///< nullopt: none, or unreadable
    std::optional<Lighting> madeFor_;
    std::uint64_t version_ = 0;
    Camera camera_;
    LightMaps environment_;
    std::shared_ptr<const LightMaps> maps_;
    Texture diffuse_, specular_;
};

} // namespace tessera::vis
