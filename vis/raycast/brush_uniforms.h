#pragma once

#include "vis/gl/handles.h"
#include "vis/raycast/ray_plan.h"

/// Uniforms and constants of lib/layers/doi.glsl from the brush tests of a plan.
namespace tessera::vis {

/// Constants: which kinds of tests the program needs, and its capacity for tests.
std::vector<std::pair<std::string, std::string>> brushDefines(const BrushTests& brushes, const Selection& selection);

/// Whether unselected samples are blurred (vis/formulas/context_blur.h); not supported by proxy geometry.
bool blursContext(const Scene& scene);

/// Sets the brush uniforms of a plan with bound fields, and the appearance of the context.
void setBrushUniforms(const Program& program, const RayPlan& plan, const Selection& selection);

/// The lasso tables, stacked vertically in a texture that is rebuilt when they change; reports dropped brushes.
class BrushTables {
public:
    /// The texture of the lasso tables; 0 if there are none.
    GLuint update(const BrushTests& brushes);
    std::vector<std::string> takeMessages() { return std::exchange(messages_, {}); }

private:
    Texture texture_;
    std::vector<LassoRegion> shown_;
    int dropped_ = 0;
    std::vector<std::string> messages_;
};

} // namespace tessera::vis
