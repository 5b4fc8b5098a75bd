#include "app/pane/view_parts.h"
#include "app/queries/derivative_query.h"
#include "app/session/own_functions.h"
#include "app/ui/theme.h"
#include "app/views/transfer/color_edit.h"
#include "app/views/transfer/transfer_controls.h"
#include "tests/app/fed_imgui.h"
#include "tests/volume/regions.h"
#include "vis/gl/headless.h"
#include "vis/transfer/boundary_opacity.h"
#include "volume/sources/memory_source.h"
#include "volume/synthetic/models.h"

namespace tessera::app {
namespace {

TEST(RegionEdit, TheSelectedThenTheLastMadeLiesOnTop) {
    std::vector<vis::TransferRegion> regions(2);
    regions[0].centre = regions[1].centre = {0.5f, 0.5f};
    regions[0].size = regions[1].size = {0.4f, 0.4f};
    const glm::vec2 reach{0.02f, 0.02f};
    EXPECT_EQ(hitRegion(regions, {0.5f, 0.5f}, reach, -1), (RegionHit{1, 0}));
    EXPECT_EQ(hitRegion(regions, {0.5f, 0.5f}, reach, 0), (RegionHit{0, 0}));
    EXPECT_EQ(hitRegion(regions, {0.301f, 0.5f}, reach, -1), (RegionHit{1, kRegionLeft}));
    EXPECT_EQ(hitRegion(regions, {0.701f, 0.699f}, reach, -1), (RegionHit{1, kRegionRight | kRegionHigh}));
    EXPECT_EQ(hitRegion(regions, {0.75f, 0.5f}, reach, 0), RegionHit{});
}

TEST(RegionEdit, AHeldEdgeMovesAndTheOtherStays) {
    vis::TransferRegion region;
    region.centre = {0.5f, 0.5f};
    region.size = {0.4f, 0.2f};
    const vis::TransferRegion wider = draggedRegion(region, kRegionRight, {0.1f, 0.3f});
    EXPECT_NEAR(wider.centre.x - wider.size.x / 2, 0.3f, 1e-6f);
    EXPECT_NEAR(wider.centre.x + wider.size.x / 2, 0.8f, 1e-6f);
    EXPECT_EQ(wider.centre.y, region.centre.y);
    EXPECT_NEAR(wider.size.y, region.size.y, 1e-6f);
    const vis::TransferRegion thin = draggedRegion(region, kRegionLow, {0, 5});
    EXPECT_NEAR(thin.size.y, 0.01f, 1e-6f);
    EXPECT_NEAR(thin.centre.y + thin.size.y / 2, 0.6f, 1e-6f) << "an edge does not pass the other one";
    const vis::TransferRegion moved = draggedRegion(region, 0, {9, -9});
    EXPECT_EQ(moved.centre, glm::vec2(1, 0));
    EXPECT_EQ(moved.size, region.size);
}

TEST(DerivativeImage, RowsRunDownAndMoreSamplesStandOutMore) {
    volume::DerivativeHistogram histogram;
    histogram.valueBins = 2;
    histogram.gradientBins = 2;
    histogram.count = {1000, 0, 0, 1}; // many of low value and gradient, one of high value and gradient
    for (const bool dark : {true, false}) {
        const std::vector<std::uint8_t> rgba = derivativeImage(histogram, dark);
        ASSERT_EQ(rgba.size(), 16u);
        EXPECT_EQ(rgba[3], 0) << "top left: no sample";
        EXPECT_EQ(rgba[7], 255) << "top right: the large gradient";
        EXPECT_EQ(rgba[11], 255) << "bottom left";
        const int many = rgba[8], one = rgba[4], ground = dark ? 0 : 255;
        EXPECT_GT(std::abs(many - ground), std::abs(one - ground));
    }
}

TEST(ColorEdit, OwnColorsBeginAsTheMapThatWasInUse) {
    for (const bool reversed : {false, true})
        for (const char* map : {"viridis", "gray", "magma"}) {
            vis::TransferFunction function;
            function.colormap = map;
            function.reversed = reversed;
            vis::TransferFunction own;
            own.colors = ownColors(function);
            ASSERT_GE(own.colors.size(), 2u);
            EXPECT_LE(own.colors.size(), 12u) << map;
            for (int i = 0; i <= 100; ++i) {
                const glm::dvec4 a = vis::evaluate(function, {0, 1}, i / 100.0),
                                 b = vis::evaluate(own, {0, 1}, i / 100.0);
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], kStopsAlike + 0.001) << map;
            }
        }
    vis::TransferFunction gray;
    gray.colormap = "gray";
    EXPECT_EQ(ownColors(gray).size(), 2u) << "as few as do";
}

TEST(FunctionName, IsTheOwnOneOfALayerOrFaceThatHasIt) {
    Session session;
    session.layers = {{"a", true, vis::VolumeLayer{.channel = "T"}},
                      {"b", true, vis::VolumeLayer{.channel = "T"}, "", "own"}};
    EXPECT_EQ(functionName(session, {.channel = "own"}, "T"), "own");
    EXPECT_EQ(ownFunction(session, "own")->channel, "T");
    EXPECT_EQ(functionName(session, {.channel = "O2"}, "T"), "T") << "a channel, or nothing that is there";
    EXPECT_EQ(functionName(session, {}, "T"), "T");
    EXPECT_FALSE(ownFunction(session, "O2"));
    EXPECT_FALSE(ownFunction(session, ""));
    ShadowCubeView cube;
    cube.front = {.channel = "O2", .transfer = "far"};
    session.views["cube"] = cube;
    EXPECT_EQ(functionName(session, {.channel = "far"}, "T"), "far");
    EXPECT_EQ(ownFunction(session, "far")->channel, "O2");
    EXPECT_EQ(ownFunctions(session).size(), 2u);
}

/// The transfer function view in a window of its own, without a window system.
class TransferPages : public FedImGui {
protected:
    TransferPages() : FedImGui({1280, 800}) {}
    void SetUp() override {
        loadFonts(1);
        applyTheme(Theme::Dark, 1);
        volume::Dataset model = volume::makeModel("fuel-cell", {{"nx", 9}, {"ny", 9}, {"nz", 21}, {"times", 2}});
        source = volume::makeMemorySource(std::move(model), {});
        renderer.setSource(source);
        session = defaultSession(source->info(), {});
        channel = source->info().channel(resolveChannel(source->info(), session, "").value()).name;
    }
    void frame(ImVec2 size = {900, 500}) {
        ImGui::GetIO().DisplaySize = size;
        feedWindow([&] {
            ViewContext context{session, source, renderer, jobs, caches};
            context.headless = true;
            drawTransferView(context, "transfer", view);
        });
        EXPECT_TRUE(jobs.collect().empty());
    }

    vis::HeadlessContext gl;
    vis::Renderer renderer;
    Jobs jobs;
    std::map<std::string, std::unique_ptr<ViewCache>> caches;
    std::shared_ptr<const volume::BrickSource> source;
    Session session;
    TransferView view;
    std::string channel;
};

TEST_F(TransferPages, ADragMakesARegionAndARightClickRemovesIt) {
    session.transfer[channel].kind = vis::TransferKind::Regions;
    frame();
    frame();
    mouse = {250, 200};
    frame();
    ImGui::GetIO().MouseDown[0] = true;
    frame();
    for (float step : {20.0f, 60.0f, 100.0f}) {
        mouse = {250 + step, 200 + step};
        frame();
    }
    ImGui::GetIO().MouseDown[0] = false;
    frame();
    ASSERT_EQ(session.transfer[channel].regions.size(), 1u);
    const vis::TransferRegion made = session.transfer[channel].regions[0];
    EXPECT_GT(made.size.x, 0.05f);
    EXPECT_GT(made.size.y, 0.05f);
    mouse = {300, 250}; // inside of it: a drag moves it
    frame();
    ImGui::GetIO().MouseDown[0] = true;
    frame();
    mouse = {340, 250};
    frame();
    frame();
    ImGui::GetIO().MouseDown[0] = false;
    frame();
    const vis::TransferRegion moved = session.transfer[channel].regions.at(0);
    EXPECT_GT(moved.centre.x, made.centre.x);
    EXPECT_NEAR(moved.centre.y, made.centre.y, 1e-5f);
    EXPECT_EQ(moved.size, made.size);
    ImGui::GetIO().MouseDown[1] = true;
    frame();
    ImGui::GetIO().MouseDown[1] = false;
    frame();
    EXPECT_TRUE(session.transfer[channel].regions.empty());
}

TEST_F(TransferPages, TheCurveFollowsTheEmphasisOfBoundaries) {
    BoundaryPage page;
    page.apply = true;
    const volume::DatasetInfo& info = source->info();
    const int index = *info.findChannel(channel);
    const Range range = info.channelRange(info.channel(index));
    vis::TransferFunction& function = session.transfer[channel];
    const auto result = std::make_shared<const DerivativeResult>(readDerivatives(source, {{.channel = index}, {}}));
    const auto draw = [&] {
        ImGui::NewFrame();
        ViewContext context{session, source, renderer, jobs, caches};
        context.headless = true;
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({900, 500});
        ImGui::Begin("boundary", nullptr, ImGuiWindowFlags_NoDecoration);
        drawBoundaryPage(context, page, function, info, index, result);
        ImGui::End();
        ImGui::Render();
    };
    draw();
    EXPECT_EQ(function.opacity, vis::boundaryOpacity(result->curves, function, range));
    function.emphasis = {{0, 0.2f}, {1, 0.9f}};
    draw();
    const std::vector<glm::vec2> made = vis::boundaryOpacity(result->curves, function, range);
    EXPECT_EQ(function.opacity, made);
    EXPECT_GT(made.size(), 2u);
    function.opacity = {{0, 0}, {1, 1}}; // undone, or edited elsewhere: stays
    draw();
    EXPECT_EQ(function.opacity.size(), 2u);
}

TEST_F(TransferPages, StopsOfOwnColorsAreAddedMovedAndRemoved) {
    std::vector<vis::ColorStop>& stops = session.transfer[channel].colors;
    stops = {{0, {0, 0, 0}}, {1, {1, 0.5f, 0}}};
    ColorDrag drag;
    const auto draw = [&] {
        ImGui::GetIO().MousePos = mouse;
        ImGui::NewFrame();
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({600, 100});
        ImGui::Begin("stops", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
        editColors(drag, stops, {100, 40}, {500, 56});
        ImGui::End();
        ImGui::Render();
    };
    const auto press = [&](int button, ImVec2 at, ImVec2 to) {
        mouse = at;
        draw();
        ImGui::GetIO().MouseDown[button] = true;
        draw();
        mouse = to;
        draw();
        draw();
        ImGui::GetIO().MouseDown[button] = false;
        draw();
    };
    ImGui::GetIO().DeltaTime = 1; // no two clicks make a double click
    draw();
    press(0, {200, 48}, {200, 48});
    ASSERT_EQ(stops.size(), 3u);
    EXPECT_NEAR(stops[1].position, 0.25f, 1e-3f);
    EXPECT_NEAR(stops[1].color.r, 0.25f, 1e-3f) << "the colour that was there";
    press(0, {200, 48}, {300, 48});
    EXPECT_NEAR(stops[1].position, 0.5f, 1e-3f);
    press(0, {300, 48}, {580, 48});
    EXPECT_EQ(stops[1].position, 1.0f) << "no further than its neighbour";
    press(0, {498, 48}, {300, 48});
    const float place = stops[1].position;
    press(0, {300, 80}, {450, 80});
    EXPECT_EQ(stops[1].position, place) << "a drag below them moves none";
    press(1, {300, 48}, {300, 48});
    EXPECT_EQ(stops.size(), 2u);
    press(1, {100, 48}, {100, 48});
    EXPECT_EQ(stops.size(), 2u) << "two always stay";
    reverseColors(stops);
    EXPECT_LE(stops[0].position, stops[1].position);
}

TEST_F(TransferPages, ADraggedPointSnapsUnlessCtrlOrAltIsHeld) {
    std::vector<glm::vec2> curve{{0, 0}, {0.5f, 0.4f}, {1, 0.8f}};
    const PlotFrame plot{{100, 50}, {500, 450}, {0, 10}, {0, 1}}; // 400 pixels for 1 of opacity
    const std::vector<double> peaks{0.25};
    OpacityDrag drag;
    const auto draw = [&] {
        ImGui::GetIO().MousePos = mouse;
        ImGui::NewFrame();
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({600, 500});
        ImGui::Begin("curve", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
        surface(plot.min, plot.max);
        editOpacity(drag, curve, plot, plot.x, peaks);
        ImGui::End();
        ImGui::Render();
    };
    const auto dragTo = [&](ImVec2 from, ImVec2 to, bool ctrl, bool alt) {
        mouse = from;
        draw();
        ImGui::GetIO().MouseDown[0] = true;
        draw();
        mouse = to;
        for (int i = 0; i < 2; ++i) {
            feedModifiers(ImGui::GetIO(), ctrl, false, alt);
            draw();
        }
        ImGui::GetIO().MouseDown[0] = false;
        feedModifiers(ImGui::GetIO(), false, false, false);
        draw();
    };
    ImGui::GetIO().DeltaTime = 1; // no two clicks make a double click
    draw();
    dragTo({300, 290}, {280, 448}, false, false); // 2 pixels above the axis, 0.005
    EXPECT_EQ(curve[1].y, 0);
    EXPECT_EQ(drag.snap.height, 0.0);
    EXPECT_FALSE(drag.snap.position);
    dragTo({280, 449}, {202, 131}, false, false); // near the right neighbour's height and a peak
    EXPECT_EQ(curve[1], glm::vec2(0.25f, 0.8f));
    dragTo({200, 130}, {202, 448}, true, false);
    EXPECT_NEAR(curve[1].x, 0.255f, 1e-4f);
    EXPECT_NEAR(curve[1].y, 0.005f, 1e-4f);
    dragTo({202, 448}, {202, 131}, false, true);
    EXPECT_NEAR(curve[1].y, 0.7975f, 1e-4f);
    dragTo({400, 447}, {400, 447}, false, false); // a new one
    ASSERT_EQ(curve.size(), 4u);
    EXPECT_EQ(curve[2].y, 0);
}

TEST_F(TransferPages, EditorsFitSmallPanes) {
    for (const ImVec2 size : {ImVec2{330, 420}, ImVec2{270, 330}, ImVec2{190, 240}, ImVec2{600, 140}})
        for (const bool regions : {false, true}) {
            if (regions && (size.x < 270 || size.y < 200)) continue; // its controls alone take five rows there
            view.boundaries = !regions;
            session.transfer[channel].kind = regions ? vis::TransferKind::Regions : vis::TransferKind::Curve;
            std::string words;
            for (int i = 0; i < 3; ++i) {
                ImGui::GetIO().DisplaySize = size;
                words = said([&] {
                    ImGui::SetNextWindowPos({0, 0});
                    ImGui::SetNextWindowSize(size);
                    ImGui::Begin("test", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
                    ViewContext context{session, source, renderer, jobs, caches};
                    context.headless = true;
                    drawTransferView(context, "transfer", view);
                    ImGui::End();
                });
            }
            EXPECT_EQ(words.find("Not enough room"), std::string::npos) << size.x << " x " << size.y << " " << regions;
        }
}

TEST_F(TransferPages, TheFirstRegionIsThere) {
    vis::TransferFunction& function = session.transfer[channel];
    function.kind = vis::TransferKind::Regions;
    RegionPage page;
    const int index = *source->info().findChannel(channel);
    const volume::DerivativeQuery all{.channel = index,
                                      .gradientBins = 1024,
                                      .range = source->info().channelRange(source->info().channel(index)),
                                      .gradientTop = source->info().channelRange(source->info().channel(index)).hi -
                                                     source->info().channelRange(source->info().channel(index)).lo};
    const auto everything = std::make_shared<const DerivativeResult>(readDerivatives(source, {all, {}}));
    fitRegions(page, function, everything);
    EXPECT_TRUE(function.regions.empty()) << "not asked";
    page.fit = true;
    fitRegions(page, function, nullptr);
    EXPECT_TRUE(page.fit) << "still to be done";
    fitRegions(page, function, everything);
    ASSERT_EQ(function.regions.size(), 1u);
    EXPECT_EQ(page.drag.selected, 0);
    EXPECT_FALSE(page.fit);
    const float top = function.gradientTop;
    EXPECT_NE(top, 0.1f);
    page.fit = true; // again: nothing is added, what is there stays
    const vis::TransferFunction before = function;
    fitRegions(page, function, everything);
    EXPECT_EQ(function, before);
}

TEST_F(TransferPages, DrawingAloneEditsNothing) {
    session.transfer[channel].kind = vis::TransferKind::Regions;
    session.transfer[channel].regions.emplace_back();
    const vis::TransferFunction before = session.transfer[channel];
    for (const ImVec2 size : {ImVec2{900, 500}, ImVec2{200, 120}, ImVec2{40, 30}})
        for (int i = 0; i < 2; ++i) frame(size);
    EXPECT_EQ(session.transfer[channel], before);
}

TEST_F(TransferPages, ARangeWithoutWidthHasNoGradients) {
    vis::TransferFunction& function = session.transfer[channel];
    function.kind = vis::TransferKind::Regions;
    function.autoRange = false;
    function.range = {5, 5};
    frame();
    EXPECT_EQ(session.transfer[channel].range, (Range{5, 5}));
}

TEST_F(TransferPages, ASingleValueHasTheMiddleColorAsInLegends) {
    volume::Dataset data = volume::test::datasetOf(
        {volume::test::sampled<float>(volume::test::ccLattice({4, 4, 4}), [](glm::dvec3) { return 350; })});
    data.info.parameters[0].ranges = {{350, 350}};
    source = volume::makeMemorySource(std::move(data), {});
    renderer.setSource(source);
    session = defaultSession(source->info(), {});
    const volume::Channel only = source->info().channel(0);
    view.channel = only.name;
    for (int i = 0; i < 3; ++i) frame();
    const auto placeOf = [&](double share) { // on the strip below the curve
        const glm::dvec4 c = vis::evaluate(session.transfer[only.name], {0, 1}, share);
        float x = -1;
        const ImDrawData* drawn = ImGui::GetDrawData();
        for (int list = 0; list < drawn->CmdListsCount; ++list)
            for (const ImDrawVert& corner : drawn->CmdLists[list]->VtxBuffer)
                if (corner.col == toColor({c.r, c.g, c.b}) && corner.pos.y > 400) x = std::max(x, corner.pos.x);
        return x;
    };
    const float quarter = placeOf(0.25), middle = placeOf(0.5);
    EXPECT_GT(quarter, 0);
    EXPECT_GT(middle - quarter, 100);
    EXPECT_NEAR(middle, (quarter + placeOf(0.75)) / 2, 1.5);
}

} // namespace
} // namespace tessera::app
