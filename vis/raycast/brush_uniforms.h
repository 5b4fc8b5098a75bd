#pragma once

#include "vis/gl/handles.h"
#include "vis/raycast/ray_plan.h"

/// The selection of a scene as input of lib/doi.glsl: every brush becomes a row of tests, one per interval, or one for
/// another shape.
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

/// Kinds and number of tests that the program must support.
std::vector<std::pair<std::string, std::string>> brushDefines(const BrushTests& tests, const Scene& scene);

/// Whether what is not brushed is shown out of focus (vis/optics/context_blur.h); proxy geometry does not.
bool blursContext(const Scene& scene);

/// Sets the uniforms of brushes and context.
void setBrushUniforms(const Program& program, const BrushTests& tests, const Scene& scene);

/// The tables of lassos, stacked vertically, rebuilt when they change; reports dropped brushes.
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
