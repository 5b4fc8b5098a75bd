#include "app/data/apply_layout.h"
#include "tests/app/workbench_fixture.h"

#include <epoxy/gl.h>

/// Windows in which hardly anything has room: areas without height or width must not end the program.
namespace tessera::app {
namespace {

class TinyWindows : public DrawnWorkbench {
protected:
    void show(const std::string& layout) {
        OpenRequest request;
        request.layout = layout;
        request.data.emplace();
        request.data->model = "fuel-cell";
        request.data->settings = {{"nx", 5}, {"ny", 7}, {"nz", 9}, {"times", 2}};
        workbench.install(open(request));
        workbench.session().render.samples = 1;
    }
    void drawNarrowAndLow() {
        settle();
        for (int size = 1; size < kWide; size += 7)
            for (const glm::ivec2 window : {glm::ivec2(size, kLow), glm::ivec2(kWide, size)}) {
                OffscreenFrames(window).draw(workbench, 1, {});
                ASSERT_EQ(glGetError(), GLenum(GL_NO_ERROR)) << window.x << ' ' << window.y;
            }
    }
    static constexpr int kWide = 420, kLow = 150;
};

TEST_F(TinyWindows, AreDrawnInEveryLayout) {
    for (const std::string& layout : layoutNames()) {
        SCOPED_TRACE(layout);
        show(layout);
        drawNarrowAndLow();
    }
}

TEST_F(TinyWindows, AreDrawnOfEveryViewAlone) {
    show("overview");
    const auto showAlone = [&](const ViewState& view) {
        SCOPED_TRACE(traitsOf(view).title);
        Session& session = workbench.session();
        session.views = {{"pane", view}};
        repair(session.dock, paneKeys(session));
        drawNarrowAndLow();
    };
    forEachViewKind([&](const auto& kind) { showAlone(typename std::decay_t<decltype(kind)>::State()); });
}

} // namespace
} // namespace tessera::app
