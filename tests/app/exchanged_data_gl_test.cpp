#include "tests/app/workbench_fixture.h"

#include <epoxy/gl.h>

/// Variants of a comparison whose data are exchanged while they are drawn.
namespace tessera::app {
namespace {

using ExchangedData = DrawnWorkbench;

// The picture of the former data has been deleted then; its name may be that of any other.
TEST_F(ExchangedData, BeforePicturesAreCompleteAreNotShown) {
    workbench.install(smallData(40));
    Session& session = workbench.session();
    session.layers = {{"rho", true, vis::VolumeLayer{.channel = "rho"}}};
    CompareView compare;
    const std::map<std::string, std::string> grid{{"/data/lattice", "grid"}};
    compare.variants = {
        {"grid", grid}, {"too", grid}, {"third", grid}, {"centred", {{"/data/lattice", "bodyCentred"}}}};
    session.views = {{"pane", compare}};
    repair(session.dock, paneKeys(session));
    session.render.samples = 4;
    session.render.limits.frameTime = 5; // no picture is complete at once
    OffscreenFrames window({1200, 900});
    bool unfinished = false;
    for (int count = 1; count < 4; ++count)
        for (const PictureLattice lattice : {PictureLattice::Grid, PictureLattice::BodyCentred}) {
            tessera::app::settle(workbench, window);
            workbench.session().camera.distance *= 1.01f;
            for (int i = 0; i < 2 * count; ++i) {
                if (i == count) workbench.session().data.lattice = lattice;
                if (i == count) unfinished = unfinished || workbench.busy();
                window.draw(workbench, 1, {});
                ASSERT_EQ(glGetError(), GLenum(GL_NO_ERROR)) << count << " frames, frame " << i;
            }
        }
    EXPECT_TRUE(unfinished);
}

} // namespace
} // namespace tessera::app
