#include "app/platform/gui.h"
#include "tests/app/workbench_fixture.h"
#include "vis/gl/handles.h"
#include "vis/gl/program.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>

namespace tessera::app {
namespace {

class DeletedProgram : public DrawnWorkbench {};

// As after a view has gone, or the cache of programs has dropped the last one that was used.
TEST_F(DeletedProgram, IsNotBoundAgainAfterAFrame) {
    workbench.install(smallData());
    settle();
    const vis::Texture color = vis::makeTexture2D({8, 8}, GL_RGBA8, GL_NEAREST, "frame");
    const vis::Framebuffer target = vis::makeFramebuffer({color.name()}, "frame");
    glBindFramebuffer(GL_FRAMEBUFFER, target.name());
    {
        const vis::Program bound = vis::makeProgram({"points.vert.glsl", "points.frag.glsl", {}, {}});
        glUseProgram(bound.name());
    }
    Gui::draw({8, 8}, Theme::Dark);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

} // namespace
} // namespace tessera::app
