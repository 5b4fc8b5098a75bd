#pragma once

#include "vis/gl/driver.h"
#include "vis/gl/headless.h"
#include "vis/passes/renderer.h"

#include <cstdlib>
#include <epoxy/gl.h>
#include <gtest/gtest.h>

/// What the tests that need GL share: a context whose every error fails the test, and shorthands.
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
        // What the shader compiler says comes back as an exception already.
        glDebugMessageControl(GL_DEBUG_SOURCE_SHADER_COMPILER, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
        // A driver that is not there is replaced by another without a word.
        const char* const wanted = std::getenv("TESSERA_TEST_DRIVER");
        const std::string renderer = vis::currentDriver().renderer;
        if (wanted && renderer.find(wanted) == renderer.npos)
            ADD_FAILURE() << "drawn by " << renderer << ", not " << wanted;
    }
    vis::HeadlessContext context{true};
};

/// A camera that looks along -z with parallel rays at the whole box, whose largest extent in x and y is `extent`.
vis::Camera frontCamera(double extent = 1);

/// Renders until complete.
vis::FrameStatus renderAll(vis::Renderer& renderer, vis::ViewTarget& target, const vis::Scene& scene, glm::ivec2 size);

/// The complete picture of a scene by a renderer of its own, whose every message fails the test.
std::vector<glm::vec4> picture(std::shared_ptr<const volume::BrickSource> source, const vis::RendererOptions& options,
                               const vis::Scene& scene, glm::ivec2 size = {64, 48});

/// Largest absolute difference of any component.
double maxDifference(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b);

} // namespace tessera::test
