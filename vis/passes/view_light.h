#pragma once

#include "vis/passes/render_tools.h"
#include "vis/raycast/light_baker.h"
#include "vis/raycast/light_uniforms.h"

namespace tessera::vis {

/// The stage that lights a view: maps of its surroundings, and the light volume of shadows.
class ViewLight {
public:
    struct Progress {
        bool done = true;     ///< what is bound shows this scene
        bool changed = false; ///< what was drawn with other light is out of date
    };
    /// Brings cube maps and light volume up to date and binds them. `matter`: what the volume's matter depends on
    /// besides the scene.
    Progress bind(RenderTools& tools, const RenderCall& call, const LightBaker::Matter& matter);

private:
    Progress bindMaps(RenderTools& tools, const RenderCall& call, GLuint firstUnit);
    Progress bindVolume(RenderTools& tools, const RenderCall& call, const LightBaker::Matter& matter, GLuint firstUnit);
    void bindTextures(const RenderTools& tools, GLuint firstUnit) const;

    LightMapTextures maps_;
    bool mapsPending_ = false; ///< what was drawn shows surroundings that are not read yet
    LightBaker baker_;
    std::uint64_t version_ = 0; ///< of the light volume that was drawn with
};

} // namespace tessera::vis
