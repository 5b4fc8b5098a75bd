#pragma once

#include "vis/gl/handles.h"
#include "vis/raycast/ray_plan.h"

/// From the selection of a scene to what lib/doi.glsl reads: every brush becomes tests in a row, one per interval or
/// one for another shape.
namespace tessera::vis {

inline constexpr int kMaxBrushTests = 128;

struct BrushTests {
    std::vector<glm::ivec4> meanings; ///< kind (0 always, 1 range, 2 ellipse, 3 lasso, 4 sphere, 5 box, 6 lens), first
                                      ///< (of a lens: bits of the lenses) and second brush field (-1: unknown), flags
                                      ///< (1 first of its brush, 2 last, 4 inverted, 8 or)
    std::vector<glm::vec4> shapes;    ///< two each; see brush_uniforms.cpp
    std::vector<glm::vec4> colors;    ///< of the test's brush, linear; 1, or 0 where it holds nothing
    std::vector<LassoRegion> lassos;  ///< whose tables the tests look up, in order
    float start = 1;                  ///< what the first brush meets
    int dropped = 0;                  ///< brushes beyond kMaxBrushTests, from the last one on
};
BrushTests brushTests(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info);

/// Which kinds of tests the program needs, and how many it has room for.
std::vector<std::pair<std::string, std::string>> brushDefines(const BrushTests& tests, const Scene& scene);

/// Whether what is not brushed is shown out of focus (vis/optics/context_blur.h); proxy geometry does not.
bool blursContext(const Scene& scene);

/// Sets the brushes and how what they leave out is drawn.
void setBrushUniforms(const Program& program, const BrushTests& tests, const Scene& scene);

/// The tables of lassos, one below the other, made when they change; says when brushes had to be dropped.
class BrushTables {
public:
    /// The texture of the tests' lassos; 0 when there are none.
    GLuint update(const BrushTests& tests);
    std::vector<std::string> takeMessages() { return std::exchange(messages_, {}); }

private:
    Texture texture_;
    std::vector<LassoRegion> shown_;
    int dropped_ = 0;
    std::vector<std::string> messages_;
};

} // namespace tessera::vis
