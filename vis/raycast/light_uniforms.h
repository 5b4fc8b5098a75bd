#pragma once

#include "vis/gl/handles.h"
#include "vis/gl/program.h"
#include "vis/optics/light_maps.h"
#include "vis/scene/scene.h"

#include <functional>
#include <future>
#include <optional>

/// Variant and uniforms for light (vis/shaders/lib/bindings.glsl).
namespace tessera::vis {

void addLighting(ProgramRecipe& recipe, const Scene& scene);
/// Texture units of the diffuse and specular maps and of the visible and scattered light: `firstUnit` and on.
void setLightUniforms(const Program& program, const Scene& scene, const WorldFrame& frame, int firstUnit);

/// The cube maps of a picture as textures.
class LightMapTextures {
public:
    /// Makes what has changed; the environment's part only when that has. A picture of the surroundings is read by a
    /// thread of its own, until then the former maps show. `wait`: until it is there. False while something is on its
    /// way. A picture that cannot be read gives no light; `say` is told why, once.
    bool update(const Lighting& lighting, const Camera& camera, bool wait,
                const std::function<void(const std::string&)>& say);
    /// Counts the changes of the maps.
    std::uint64_t version() const { return version_; }
    GLuint diffuse() const { return diffuse_.name(); }
    GLuint specular() const { return specular_.name(); }

private:
    bool readPicture(const Lighting& lighting, bool wait, const std::function<void(const std::string&)>& say);

    std::string path_;               ///< of what `picture_` is or will be
    std::future<CubeMap> reading_;   ///< valid while the file is being read
    std::optional<CubeMap> picture_; ///< nullopt: none, or it cannot be read
    std::optional<Lighting> madeFor_;
    std::uint64_t version_ = 0;
    Camera camera_;
    LightMaps environment_;
    Texture diffuse_, specular_;
};

} // namespace tessera::vis
