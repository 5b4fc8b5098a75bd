#include "app/workbench/pane_host.h"
#include "tests/app/fed_imgui.h"

namespace tessera::app {
namespace {

/// A window of 1500 x 950: volume and slices side by side over a low timeline.
class OpenedViews : public FedImGui {
protected:
    OpenedViews() : FedImGui({1500, 950}) {
        session.views["volume"] = VolumeView{};
        session.views["slices"] = SlicesView{};
        session.views["timeline"] = TimelineView{};
        DockNode& root = session.dock.root;
        root.id = 1, root.kind = DockKind::Column, root.ratio = 0.8f;
        DockNode above, volume, slices, low;
        above.id = 2, above.kind = DockKind::Row, above.ratio = 0.6f;
        volume.id = 3, volume.tabs = {"volume"};
        slices.id = 4, slices.tabs = {"slices"};
        low.id = 5, low.tabs = {"timeline"};
        above.children = {volume, slices};
        root.children = {above, low};
        repair(session.dock, paneKeys(session));
        feed([] {});
    }
    /// The pane that has a view opened from `active` in its stack.
    std::string openedBeside(const std::string& active, const ViewState& view) {
        session.dock.maximised = active; // the active one
        PaneHost host;
        host.open(session, view, 1);
        EXPECT_TRUE(session.dock.maximised.empty());
        for (const std::string& pane : tabsBeside(session.dock, std::string(TesseractView::kType)))
            if (pane != TesseractView::kType) return pane;
        return "";
    }
    Session session;
};

TEST_F(OpenedViews, OpenAsATabOfTheActivePane) {
    EXPECT_EQ(openedBeside("slices", TesseractView{}), "slices");
}

TEST_F(OpenedViews, AreNotPutIntoALowPane) {
    EXPECT_EQ(openedBeside("timeline", TesseractView{}), "slices") << "nor over the volume, which is larger";
}

} // namespace
} // namespace tessera::app
