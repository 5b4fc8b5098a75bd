#pragma once

#include "vis/gl/headless.h"
#include "vis/renderer.h"
#include "volume/memory_source.h"

#include <epoxy/gl.h>
#include <functional>
#include <gtest/gtest.h>

/// What the tests that need GL share: a context whose every error fails the test, and data sets from formulas.
namespace tessera::test {

class GlTest : public ::testing::Test {
protected:
    GlTest() {
        glEnable(GL_DEBUG_OUTPUT);
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        glDebugMessageCallback(
            [](GLenum, GLenum type, GLuint, GLenum severity, GLsizei, const GLchar* text, const void*) {
                if (type == GL_DEBUG_TYPE_ERROR || severity == GL_DEBUG_SEVERITY_HIGH) ADD_FAILURE() << "GL: " << text;
            },
            nullptr);
    }
    vis::HeadlessContext context{true};
};

/// One parameter, or several, of a formula of the position in cells of a CC grid (index space).
struct Formula {
    std::string name;
    std::function<double(glm::dvec3)> value;
    std::function<bool(glm::dvec3)> present = {};
    bool categorical = false;
};

struct GridOptions {
    volume::LatticeKind lattice = volume::LatticeKind::CC;
    int brickSize = 32;
    glm::dvec3 spacing{1};
    int times = 1; ///< time t adds t to every value
};

/// Samples of formulas on a CC lattice of `size`, or on the BCC lattice that takes its place (sampled exactly there).
std::shared_ptr<const volume::BrickSource> makeSource(glm::ivec3 size, const std::vector<Formula>& formulas,
                                                      const GridOptions& options = {});

/// A camera that looks along -z with parallel rays at the whole box, whose largest extent in x and y is `extent`.
vis::Camera frontCamera(double extent = 1);

/// Renders until complete.
vis::FrameStatus renderAll(vis::Renderer& renderer, vis::ViewTarget& target, const vis::Scene& scene, glm::ivec2 size);

/// Largest absolute difference of any component.
double maxDifference(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b);

} // namespace tessera::test
