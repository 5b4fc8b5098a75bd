#pragma once

#include "vis/gl/handles.h"
#include "vis/raycast/ray_plan.h"

/// From the brush tests of a plan to what lib/doi.glsl reads.
namespace tessera::vis {

/// Which kinds of tests the program needs, and how many it has room for.
std::vector<std::pair<std::string, std::string>> brushDefines(const BrushTests& brushes, const Selection& selection);

/// Whether what is not brushed is shown out of focus (vis/optics/context_blur.h); proxy geometry does not.
bool blursContext(const Scene& scene);

/// Sets the brushes of a plan whose fields are bound, and how what they leave out is drawn.
void setBrushUniforms(const Program& program, const RayPlan& plan, const Selection& selection);

/// The tables of lassos, stacked vertically, rebuilt when they change; reports dropped brushes.
class BrushTables {
public:
    /// The texture of the tests' lassos; 0 when there are none.
    GLuint update(const BrushTests& brushes);
    std::vector<std::string> takeMessages() { return std::exchange(messages_, {}); }

private:
    Texture texture_;
    std::vector<LassoRegion> shown_;
    int dropped_ = 0;
    std::vector<std::string> messages_;
};

} // namespace tessera::vis
