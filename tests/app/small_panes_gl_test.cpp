#include "app/pane/plot.h"
#include "tests/app/drawn_text.h"
#include "tests/app/views_fixture.h"

#include <gmock/gmock.h>

/// What views show in the smallest panes that a layout leaves them.
namespace tessera::app {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The part of a pane of this size that plots (by their frames) and pictures (by textures that are not the font's)
/// span; what has to be scrolled to does not count.
ImVec2 shownExtent(ImVec2 size) {
    ImVec2 lo{1e6f, 1e6f}, hi{-1e6f, -1e6f};
    const auto add = [&](ImVec2 at) {
        at = {std::clamp(at.x, 0.0f, size.x), std::clamp(at.y, 0.0f, size.y)};
        lo = {std::min(lo.x, at.x), std::min(lo.y, at.y)};
        hi = {std::max(hi.x, at.x), std::max(hi.y, at.y)};
    };
    for (const ImVec2 corner : drawnIn(plotColors().frame)) add(corner);
    const ImTextureID letters = ImGui::GetIO().Fonts->TexID;
    const ImDrawData* data = ImGui::GetDrawData();
    for (int list = 0; list < data->CmdListsCount; ++list)
        for (const ImDrawCmd& command : data->CmdLists[list]->CmdBuffer) {
            if (command.GetTexID() == letters) continue;
            for (unsigned i = 0; i < command.ElemCount; ++i) {
                const ImDrawIdx at = data->CmdLists[list]->IdxBuffer[int(command.IdxOffset + i)];
                add(data->CmdLists[list]->VtxBuffer[int(command.VtxOffset + at)].pos);
            }
        }
    return {std::max(0.0f, hi.x - lo.x), std::max(0.0f, hi.y - lo.y)};
}

class SmallPanes : public ViewsTest {
protected:
    void SetUp() override {
        ViewsTest::SetUp();
        show(fuelCell(volume::LatticeKind::CC));
    }
    /// Draws the view in a pane of this size, its tab not counted, until it is settled. Returns what its widgets say.
    template <class View>
    std::string drawIn(ImVec2 size, View& view, void (*function)(ViewContext&, const std::string&, View&)) {
        const auto body = [&] { draw("pane", view, function, size); };
        for (int i = 0; i < 3 || (busy && i < 200); ++i) {
            jobs.wait();
            frame(body);
        }
        return said(body);
    }
    /// The view at the least size of its kind: `width` and `height` are the parts of the pane that plots or pictures
    /// span at least.
    template <class View>
    void expectMain(View& view, void (*function)(ViewContext&, const std::string&, View&), float width, float height) {
        constexpr float kTab = 26;
        const ViewState state(view);
        const ViewTraits& traits = traitsOf(state);
        const ImVec2 size{traits.leastWidth, traits.leastHeight - kTab};
        SCOPED_TRACE(std::string(traits.title));
        EXPECT_THAT(drawIn(size, view, function), Not(HasSubstr("Not enough room")));
        const ImVec2 shown = shownExtent(size);
        EXPECT_GE(shown.x, size.x * width);
        EXPECT_GE(shown.y, size.y * height);
    }
};

TEST_F(SmallPanes, EachViewShowsWhatItIsAbout) {
    expectMain(volumeView, drawVolumeView, 0.8f, 0.8f);
    expectMain(slicesView, drawSlicesView, 0.5f, 0.4f);
    expectMain(scatterView, drawScatterMatrixView, 0.6f, 0.5f);
    expectMain(histogramView, drawHistogramView, 0.6f, 0.3f);
    expectMain(profileView, drawProfileView, 0.6f, 0.3f);
    profileView.over = ProfileOver::Sections;
    expectMain(profileView, drawProfileView, 0.6f, 0.3f);
    expectMain(sliceMatrixView, drawSliceMatrixView, 0.4f, 0.2f);
    HyperSliceView hyperSlice;
    expectMain(hyperSlice, drawHyperSliceView, 0.8f, 0.6f);
    EXPECT_THAT(drawIn({80, 60}, hyperSlice, drawHyperSliceView), HasSubstr("Not enough room"));
    expectMain(shadowCubeView, drawShadowCubeView, 0.8f, 0.6f);
    expectMain(tesseractView, drawTesseractView, 0.7f, 0.5f);
}

TEST_F(SmallPanes, EveryEditorOfTransferFunctionsFits) {
    const std::string channel = source->info().channel(resolveChannel(source->info(), session, "").value()).name;
    for (const vis::TransferKind kind : {vis::TransferKind::Curve, vis::TransferKind::Regions})
        for (const bool boundaries : {false, true}) {
            SCOPED_TRACE("kind " + std::to_string(int(kind)) + ", boundaries " + std::to_string(boundaries));
            session.transfer[channel].kind = kind;
            transferView.boundaries = boundaries;
            expectMain(transferView, drawTransferView, 0.6f, 0.3f);
        }
}

TEST_F(SmallPanes, ToolsWithoutRoomAreInAMenu) {
    const auto text = [&](ImVec2 size) { return drawIn(size, histogramView, drawHistogramView); };
    EXPECT_THAT(text({600, 400}), HasSubstr("Export"));
    EXPECT_THAT(text({180, 110}), Not(HasSubstr("Export")));
    // The button of the menu is the last of the row.
    mouse = {0, 0};
    for (const DrawnText& each : drawnTexts())
        if (each.text == "..." || each.text == "\uf141") mouse = each.middle();
    ASSERT_GT(mouse.x, 0) << "no button";
    const auto body = [&] { draw("pane", histogramView, drawHistogramView, {180, 110}); };
    for (const bool down : {false, true, false}) {
        ImGui::GetIO().MouseDown[0] = down;
        frame(body);
    }
    frame(body);
    EXPECT_THAT(said(body), HasSubstr("Export"));
}

} // namespace
} // namespace tessera::app
