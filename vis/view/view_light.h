#pragma once

#include "vis/packed/packed_light.h"
#include "vis/raycast/light_baker.h"
#include "vis/raycast/light_uniforms.h"
#include "vis/view/render_tools.h"

namespace tessera::vis {

/// The stage that lights a view: environment maps and the light volume for shadows.
class ViewLight {
public:
    struct Progress {
        bool done = true;     ///< the bound light is that of the scene
        bool changed = false; ///< pictures drawn with the former light are out of date
    };
    /// Updates and binds the cube maps and the light volume. `medium`: inputs of the volume's extinction besides the
    /// scene. `rows`: the processor computes it; else OpenGL draws it.
    Progress bind(RenderTools& tools, const RenderCall& call, const LightBaker::Medium& medium,
                  const LightBaker::Rows& rows = {});
    /// What is bound, as far as the scene uses it.
    packet::SceneLight bound(const Lighting& lighting) const;

private:
    Progress bindMaps(RenderTools& tools, const RenderCall& call, GLuint firstUnit);
    Progress bindVolume(RenderTools& tools, const RenderCall& call, const LightBaker::Medium& medium,
                        const LightBaker::Rows& rows, GLuint firstUnit);
    bool drawVolume(RenderTools& tools, const RenderCall& call, const LightBaker::Medium& medium, Progress& progress);
    void bindTextures(const RenderTools& tools, GLuint firstUnit) const;

    LightMapTextures maps_;
    bool mapsPending_ = false; ///< the picture was drawn before the environment picture was read
    LightBaker baker_;
    std::uint64_t version_ = 0; ///< of the light volume used in the picture
};

} // namespace tessera::vis
