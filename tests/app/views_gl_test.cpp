#include "app/queries/geometry_query.h"
#include "app/views/compare/compare_questions.h"
#include "app/views/curves/section_data.h"
#include "app/views/tesseract/tesseract_wire.h"
#include "tests/app/drawn_text.h"
#include "tests/app/views_fixture.h"
#include "volume/base/error.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <thread>

namespace tessera::app {
namespace {

using volume::BrickSource;

class Views : public ViewsTest {};

/// A data set of one scalar whose sample i is `value(i)`; NaN is absent.
std::shared_ptr<const BrickSource> scalar(glm::ivec3 size, const std::function<float(std::size_t)>& value,
                                          std::vector<Range> ranges) {
    volume::Dataset data;
    data.info.lattice.size = size;
    data.info.bounds = {glm::dvec3(0), glm::dvec3(size - 1)};
    data.info.parameters.resize(1);
    data.info.parameters[0].name = "a";
    data.info.parameters[0].unit = "K";
    data.info.parameters[0].ranges = std::move(ranges);
    data.read = [lattice = data.info.lattice, value](int, int, int) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::F32);
        auto mask = std::make_shared<volume::Mask>(field.count(), std::uint8_t(1));
        for (std::size_t i = 0; i < field.count(); ++i) {
            const float v = value(i);
            if (std::isnan(v))
                (*mask)[i] = 0;
            else
                field.as<float>()[i] = v;
        }
        field.mask = mask;
        return field;
    };
    return volume::makeMemorySource(std::move(data), {});
}

TEST_F(Views, WithoutDataHintsAreShown) {
    show(nullptr);
    drawAllSizes();
    EXPECT_FALSE(busy);
}

TEST_F(Views, FuelCellOnBothLattices) {
    for (const volume::LatticeKind lattice : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
        show(fuelCell(lattice));
        drawAllSizes();
        EXPECT_FALSE(busy) << "headless, everything is finished within the frame";
        EXPECT_TRUE(messages.empty());
        EXPECT_TRUE(renderer.takeMessages().empty());
    }
}

TEST_F(Views, TinyConstantAndEmptyData) {
    const auto rising = [](std::size_t i) { return static_cast<float>(i); };
    const auto absent = [](std::size_t) { return std::numeric_limits<float>::quiet_NaN(); };
    const auto constant = [](std::size_t) { return 3.0f; };
    show(scalar({1, 1, 5}, rising, {{0, 4}}));
    drawAllSizes();
    show(scalar({1, 1, 1}, constant, {{3, 3}}));
    drawAllSizes();
    show(scalar({4, 1, 3}, constant, {{3, 3}}));
    drawAllSizes();
    show(scalar({3, 3, 3}, absent, {}));
    drawAllSizes();
    show(scalar({3, 3, 3}, absent, {{std::numeric_limits<double>::quiet_NaN(), 1}}));
    drawAllSizes();
}

TEST_F(Views, ASessionThatDoesNotFitTheData) {
    show(fuelCell(volume::LatticeKind::BCC));
    session.layers.push_back({"gone", true, vis::IsoLayer{.channel = "no such thing"}});
    session.selection.brushes.push_back(vis::rangeBrush({{"no such thing", 0, 1, 0.1}}, "gone"));
    session.selection.brushes.push_back({.name = "empty lasso", .region = vis::LassoRegion{"T", "nothing", {}, 0.1}});
    session.time = 1e9;
    session.cursor = {1e9, -1e9, 0};
    scatterView.channels = {"nothing", "T", "T"};
    slicesView.channel = transferView.channel = "nothing";
    layersView.selected = 77;
    session.transfer["T"].opacity.clear();
    drawAllSizes();
}

TEST_F(Views, EditingWhileTheBackgroundWorks) {
    headless = false;
    show(fuelCell(volume::LatticeKind::BCC));
    for (int i = 0; i < 5000 && (i < 3 || busy); ++i) {
        if (i < 20) session.cursor.z = source->info().bounds.hi.z * i / 20;
        frame([&] { drawAll({640, 480}); });
        EXPECT_TRUE(messages.empty());
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    EXPECT_FALSE(busy) << "comes to rest";
}

TEST_F(Views, FlowComesAtOnceOrFromTheBackground) {
    show(fuelCell(volume::LatticeKind::BCC));
    vis::FlowLayer flow{.vector = "U", .channel = "O2"};
    flow.count = 10;
    session.layers = {{"flow", true, flow}};
    ViewContext context{session, source, renderer, jobs, caches};
    context.headless = true;
    AsyncGeometry atOnce, later;
    const std::vector<vis::GeometryLayer> whole = atOnce.get(context, "a", false);
    ASSERT_EQ(whole.size(), 1u);
    EXPECT_FALSE(whole[0].geometry->mesh.triangles.empty());
    EXPECT_EQ(whole[0].channel, "O2");
    EXPECT_EQ(atOnce.get(context, "a", false), whole) << "kept";
    std::get<vis::FlowLayer>(session.layers[0].technique).style.opacity = 0.5f;
    EXPECT_EQ(atOnce.get(context, "a", false)[0].geometry, whole[0].geometry) << "only drawn otherwise";

    context.headless = false;
    EXPECT_TRUE(later.get(context, "b", false).empty());
    EXPECT_TRUE(context.answers.awaiting && !context.answers.busy) << "the job says when another frame is needed";
    jobs.wait();
    jobs.collect();
    const std::vector<vis::GeometryLayer> made = later.get(context, "b", false);
    ASSERT_EQ(made.size(), 1u);
    EXPECT_EQ(made[0].geometry->mesh.positions, whole[0].geometry->mesh.positions);
    // While another is made the last one stays, with the colours it was made for.
    std::get<vis::FlowLayer>(session.layers[0].technique).channel = "T";
    ASSERT_EQ(later.get(context, "b", false).size(), 1u);
    EXPECT_EQ(later.get(context, "b", false)[0].channel, "O2");
    jobs.wait();
    jobs.collect();
    EXPECT_EQ(later.get(context, "b", false)[0].channel, "T");
    session.layers[0].visible = false;
    EXPECT_TRUE(later.get(context, "b", false).empty());
}

/// The place in the list of corners of the first one of a colour, and of the last one; nothing where there is none.
std::optional<std::pair<int, int>> cornersOf(ImU32 color) {
    std::optional<std::pair<int, int>> found;
    for (int list = 0, at = 0; list < ImGui::GetDrawData()->CmdListsCount; ++list)
        for (const ImDrawVert& corner : ImGui::GetDrawData()->CmdLists[list]->VtxBuffer) {
            if (corner.col == color) found = {found ? found->first : at, at};
            ++at;
        }
    return found;
}

// A low plot has no corner that is free of its curve.
TEST_F(Views, ACurveIsDrawnOverTheTitleOfItsPlot) {
    show(fuelCell(volume::LatticeKind::CC));
    profileView.channels = {"T"};
    const glm::vec3 ink = plotInk(0, true);
    const ImU32 curve = toColor({double(ink.r), double(ink.g), double(ink.b)}), backdrop = plotColors().backdrop;
    for (const ProfileOver over : {ProfileOver::Line, ProfileOver::Time}) {
        profileView.over = over;
        for (int i = 0; i < 2; ++i) frame([&] { draw("profile", profileView, drawProfileView, {400, 140}); });
        ASSERT_TRUE(cornersOf(curve) && cornersOf(backdrop));
        EXPECT_GT(cornersOf(curve)->first, cornersOf(backdrop)->second);
    }
    curvesView.y = {"mean(T)"};
    for (int i = 0; i < 2; ++i) frame([&] { draw("curves", curvesView, drawCurvesView, {400, 140}); });
    ASSERT_TRUE(cornersOf(curve) && cornersOf(backdrop));
    EXPECT_GT(cornersOf(curve)->first, cornersOf(backdrop)->first) << "the ring around the time has a rim";
}

/// The places in the list of corners of those of a colour that are no letters.
std::optional<std::pair<int, int>> linesOf(ImU32 color) {
    std::set<std::pair<float, float>> letters; // corners of their pictures
    for (const ImFont* font : ImGui::GetIO().Fonts->Fonts)
        for (const ImFontGlyph& glyph : font->Glyphs)
            for (const float u : {glyph.U0, glyph.U1})
                for (const float v : {glyph.V0, glyph.V1}) letters.insert({u, v});
    std::optional<std::pair<int, int>> found;
    for (int list = 0, at = 0; list < ImGui::GetDrawData()->CmdListsCount; ++list)
        for (const ImDrawVert& corner : ImGui::GetDrawData()->CmdLists[list]->VtxBuffer) {
            if (corner.col == color && !letters.contains({corner.uv.x, corner.uv.y}))
                found = {found ? found->first : at, at};
            ++at;
        }
    return found;
}

TEST_F(Views, CurvesOfSectionAveragesAreDrawnOverTheTitlesOfTheirPlot) {
    show(fuelCell(volume::LatticeKind::CC));
    profileView.channels = {"T"};
    profileView.over = ProfileOver::Sections;
    for (int i = 0; i < 3; ++i) {
        jobs.wait();
        frame([&] { draw("profile", profileView, drawProfileView, {400, 140}); });
    }
    SectionCurvesQuery query;
    query.channels = {source->info().findChannel("T").value()};
    query.label = volume::labelChannel(source->info()).value_or(-1);
    const std::vector<Plot> panels = sectionPanels(source->info(), {readSections(source, query)}, SectionMeasure::Mean);
    ASSERT_EQ(panels.size(), 1u);
    ASSERT_FALSE(panels[0].series.empty());
    const auto backdrop = cornersOf(plotColors().backdrop);
    ASSERT_TRUE(backdrop);
    for (const PlotSeries& series : panels[0].series) {
        const auto curve = linesOf(toColor({series.color.r, series.color.g, series.color.b}));
        ASSERT_TRUE(curve) << series.name;
        EXPECT_GT(curve->first, backdrop->second) << series.name;
    }
}

TEST_F(Views, AQuestionOfAComparisonIsRemovedByItsButton) {
    CompareView compare;
    compare.questions.resize(2);
    compare.questions[0].text = "Which one is hotter, and is it so at the outlet of the channel as well?";
    compare.questions[1].text = "b";
    QuestionClock clock;
    const auto draws = [&] {
        ViewContext context{session, source, renderer, jobs, caches};
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({400, 200});
        ImGui::Begin("questions", nullptr, ImGuiWindowFlags_NoDecoration);
        drawQuestions(context, compare, clock, {"one", "other"});
        ImGui::End();
    };
    for (int i = 0; i < 2; ++i) frame(draws);
    std::vector<DrawnText> crosses = drawnTexts(); // without the font of icons: words
    std::erase_if(crosses, [](const DrawnText& text) { return text.text != "x"; });
    ASSERT_EQ(crosses.size(), 2u);
    mouse = {30, crosses[0].middle().y};
    for (int i = 0; i < 2; ++i) frame(draws);
    const std::vector<std::string> told = drawnWords();
    EXPECT_EQ(
        std::ranges::count_if(told, [](const std::string& word) { return word.find("channel as well?") + 1 > 0; }), 1)
        << "the end of what is cut off";
    mouse = crosses[0].middle();
    for (const bool down : {false, true, false}) {
        ImGui::GetIO().MouseDown[0] = down;
        frame(draws);
    }
    ASSERT_EQ(compare.questions.size(), 1u);
    EXPECT_EQ(compare.questions[0].text, "b");
}

// In a wide pane the body stands at the left, the legends and what is near at the right.
TEST_F(Views, TheTextsOfATesseractStandBesideIt) {
    show(fuelCell(volume::LatticeKind::BCC));
    for (int i = 0; i < 2; ++i) frame([&] { draw("tesseract", tesseractView, drawTesseractView, {800, 400}); });
    int found = 0;
    for (const DrawnText& text : drawnTexts()) {
        if (text.text.find("near in 4D") == std::string::npos) continue;
        ++found;
        EXPECT_GT(text.min.x, 500);
        EXPECT_LT(text.max.y, 120);
    }
    EXPECT_EQ(found, 1);
}

// Drags turn the tesseract in the planes they say, the angles stay those of a rotation, R turns back.
TEST_F(Views, ATesseractTurnsByHand) {
    show(fuelCell(volume::LatticeKind::BCC));
    const auto view = [&] { draw("tesseract", tesseractView, drawTesseractView, {700, 600}); };
    const auto drag = [&](int mouseButton, bool shift) {
        mouse = {300, 250};
        feedModifiers(ImGui::GetIO(), false, shift, false);
        frame(view);
        ImGui::GetIO().MouseDown[mouseButton] = true;
        frame(view);
        mouse = {360, 280};
        frame(view);
        ImGui::GetIO().MouseDown[mouseButton] = false;
        frame(view);
        feedModifiers(ImGui::GetIO(), false, false, false);
    };
    frame(view);
    const TesseractView start = tesseractView;
    drag(0, false);
    EXPECT_NE(tesseractView.turn, start.turn);
    EXPECT_LT(glm::length(tesseractView.turn4 - start.turn4), 1e-3f) << "a turn in space leaves time alone";
    const TesseractView turned = tesseractView;
    drag(1, false);
    EXPECT_GT(glm::length(tesseractView.turn4 - turned.turn4), 5.0f);
    const TesseractView twice = tesseractView;
    drag(0, true);
    EXPECT_GT(glm::length(tesseractView.turn4 - twice.turn4), 5.0f);
    EXPECT_FALSE(busy);
    tesseractView.tour = true;
    headless = false;
    const auto sliders = [] {
        std::string all;
        for (const DrawnText& each : drawnTexts())
            if (each.text.find("\xc2\xb0") != std::string::npos) all += each.text + "; ";
        return all;
    };
    frame(view);
    EXPECT_TRUE(busy) << "a tour goes on";
    const std::string before = sliders();
    EXPECT_FALSE(before.empty());
    const TesseractView saved = tesseractView;
    for (int i = 0; i < 60; ++i) frame(view);
    EXPECT_NE(sliders(), before) << "and moves the sliders";
    EXPECT_EQ(tesseractView.turn, saved.turn) << "the session keeps the angles it starts from";
    headless = true;
    feedKey(ImGui::GetIO(), 'R', true);
    frame(view);
    feedKey(ImGui::GetIO(), 'R', false);
    frame(view);
    EXPECT_EQ(tesseractView.turn, start.turn);
    EXPECT_EQ(tesseractView.turn4, start.turn4);
    EXPECT_FALSE(tesseractView.tour);
}

TEST_F(Views, DamagedDataIsTriedOnce) {
    headless = false;
    volume::Dataset data;
    data.info.lattice.size = {4, 4, 4};
    data.info.bounds = {glm::dvec3(0), glm::dvec3(3)};
    data.info.parameters.resize(2);
    for (volume::Parameter& parameter : data.info.parameters) parameter.ranges = {{0, 1}};
    data.info.parameters[0].name = "a";
    data.info.parameters[1].name = "b";
    data.read = [](int, int, int) -> volume::Field { throw Error("damaged"); };
    show(volume::makeMemorySource(std::move(data), {}));
    int reported = 0, after = 0;
    for (int i = 0; i < 5000 && after < 30; ++i) {
        after += reported > 0 ? 1 : 0;
        frame([&] { draw("scatterMatrix", scatterView, drawScatterMatrixView, {640, 480}); });
        for (const std::string& message : messages) reported += message.find("damaged") != std::string::npos;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    EXPECT_GE(reported, 1);
    EXPECT_LE(reported, 2) << "once for the plots, once for the values at the cursor";
}

TEST_F(Views, ATesseractHasTheProportionsOfTheDataUnlessItIsACube) {
    show(fuelCell(volume::LatticeKind::CC)); // a long box
    const auto lines = [&](bool cube) {
        tesseractView.cube = cube;
        for (int i = 0; i < 2; ++i) frame([&] { draw("tesseract", tesseractView, drawTesseractView, {700, 700}); });
        const vis::TransferFunction colors = fourthColors();
        ImVec2 min{1e9f, 1e9f}, max{-1e9f, -1e9f};
        const ImDrawData& data = *ImGui::GetDrawData();
        for (int list = 0; list < data.CmdListsCount; ++list)
            for (const ImDrawVert& corner : data.CmdLists[list]->VtxBuffer)
                for (const vis::ColorStop& stop : colors.colors)
                    if ((corner.col & ~IM_COL32_A_MASK) ==
                        (toColor({double(stop.color.r), double(stop.color.g), double(stop.color.b)}) &
                         ~IM_COL32_A_MASK)) {
                        min = {std::min(min.x, corner.pos.x), std::min(min.y, corner.pos.y)};
                        max = {std::max(max.x, corner.pos.x), std::max(max.y, corner.pos.y)};
                    }
        EXPECT_GT(max.x, min.x);
        const float wide = max.x - min.x, high = max.y - min.y;
        return std::max(wide, high) / std::min(wide, high);
    };
    const float cube = lines(true), data = lines(false);
    EXPECT_LT(cube, 1.4f);
    EXPECT_GT(data, 1.15f * cube);
}

} // namespace
} // namespace tessera::app
