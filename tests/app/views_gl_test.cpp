#include "app/ui/theme.h"
#include "app/views/flow_feed.h"
#include "app/views/scatter_layout.h"
#include "app/views/statistics_feed.h"
#include "app/views/view_context.h"
#include "app/views/view_parts.h"
#include "tests/app/fed_imgui.h"
#include "vis/gl/headless.h"
#include "volume/error.h"
#include "volume/memory_source.h"
#include "volume/synthetic/models.h"

#include <cmath>
#include <limits>
#include <thread>

namespace tessera::app {
namespace {

using volume::BrickSource;

/// Every view in a window of its own size, without a window system: ImGui fed by hand, pictures by EGL.
class Views : public FedImGui {
protected:
    Views() : FedImGui({1280, 800}) {}
    void SetUp() override {
        fonts = loadFonts(1);
        applyTheme(Theme::Dark, 1);
    }

    void show(std::shared_ptr<const BrickSource> data) {
        source = std::move(data);
        caches.clear();
        renderer.setSource(source);
        session = source ? defaultSession(source->info(), {}) : Session{};
    }

    template <class View>
    void draw(const char* pane, View& view, void (*function)(ViewContext&, const std::string&, View&), ImVec2 size) {
        ViewContext context{session, source, renderer, jobs, caches};
        context.iconFont = fonts.icons;
        context.headless = headless;
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize(size);
        ImGui::Begin(pane, nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
        function(context, pane, view);
        ImGui::End();
        busy = busy || context.busy;
    }
    void frame(const std::function<void()>& body) {
        busy = false;
        feed(body);
        messages = jobs.collect();
    }
    void drawAll(ImVec2 size) {
        draw("volume", volumeView, drawVolumeView, size);
        draw("slices", slicesView, drawSlicesView, size);
        draw("scatterMatrix", scatterView, drawScatterMatrixView, size);
        draw("transfer", transferView, drawTransferView, size);
        draw("layers", layersView, drawLayersView, size);
        draw("timeline", timelineView, drawTimelineView, size);
        draw("data", dataView, drawDataView, size);
        draw("statistics", statisticsView, drawStatisticsView, size);
        draw("histogram", histogramView, drawHistogramView, size);
        draw("profile", profileView, drawProfileView, size);
        draw("sliceMatrix", sliceMatrixView, drawSliceMatrixView, size);
        draw("shadowCube", shadowCubeView, drawShadowCubeView, size);
        draw("tesseract", tesseractView, drawTesseractView, size);
    }
    void drawAllSizes() {
        for (const ImVec2 size : {ImVec2{640, 480}, ImVec2{200, 120}, ImVec2{40, 30}})
            for (int i = 0; i < 2; ++i) frame([&] { drawAll(size); });
    }

    vis::HeadlessContext gl;
    Fonts fonts;
    vis::Renderer renderer;
    Jobs jobs;
    std::map<std::string, std::unique_ptr<ViewCache>> caches;
    std::shared_ptr<const BrickSource> source;
    Session session;
    bool headless = true, busy = false;
    std::vector<std::string> messages;
    VolumeView volumeView;
    SlicesView slicesView;
    ScatterMatrixView scatterView;
    TransferView transferView;
    LayersView layersView;
    TimelineView timelineView;
    DataView dataView;
    StatisticsView statisticsView;
    HistogramView histogramView;
    ProfileView profileView;
    SliceMatrixView sliceMatrixView;
    ShadowCubeView shadowCubeView;
    TesseractView tesseractView;
};

std::shared_ptr<const BrickSource> fuelCell(volume::LatticeKind lattice) {
    volume::Dataset cell = volume::makeModel("fuel-cell", {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 2}});
    return volume::makeMemorySource(std::move(cell), {.lattice = lattice});
}

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
    data.load = [lattice = data.info.lattice, value](int, int, int) {
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
    for (int i = 0; i < 400 && (i < 3 || busy); ++i) {
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
    FlowFeed atOnce, later;
    const std::vector<vis::GeometryLayer> whole = atOnce.get(context, "a");
    ASSERT_EQ(whole.size(), 1u);
    EXPECT_FALSE(whole[0].geometry->mesh.triangles.empty());
    EXPECT_EQ(whole[0].channel, "O2");
    EXPECT_EQ(atOnce.get(context, "a"), whole) << "kept";
    std::get<vis::FlowLayer>(session.layers[0].technique).opacity = 0.5f;
    EXPECT_EQ(atOnce.get(context, "a")[0].geometry, whole[0].geometry) << "only drawn otherwise";

    context.headless = false;
    EXPECT_TRUE(later.get(context, "b").empty());
    EXPECT_TRUE(context.busy);
    jobs.wait();
    jobs.collect();
    const std::vector<vis::GeometryLayer> made = later.get(context, "b");
    ASSERT_EQ(made.size(), 1u);
    EXPECT_EQ(made[0].geometry->mesh.positions, whole[0].geometry->mesh.positions);
    // While another is made the last one stays, with the colours it was made for.
    std::get<vis::FlowLayer>(session.layers[0].technique).channel = "T";
    ASSERT_EQ(later.get(context, "b").size(), 1u);
    EXPECT_EQ(later.get(context, "b")[0].channel, "O2");
    jobs.wait();
    jobs.collect();
    EXPECT_EQ(later.get(context, "b")[0].channel, "T");
    session.layers[0].visible = false;
    EXPECT_TRUE(later.get(context, "b").empty());
}

/// Values of two channels at every sample, straight from the bricks.
void forEachSample(const BrickSource& data, int a, int b, int time, const std::function<void(float, float)>& visit) {
    const glm::ivec3 count = data.grid().count();
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) {
                const auto read = [&](int channel) { return data.read({channel, time, 0, {x, y, z}}); };
                const volume::BrickSamples first = read(a), second = read(b);
                const auto at = [](const volume::BrickSamples& samples, std::size_t i) {
                    const bool present = samples.present.empty() || samples.present[i];
                    return present ? samples.values[i] : std::numeric_limits<float>::quiet_NaN();
                };
                for (std::size_t i = 0; i < first.values.size(); ++i) visit(at(first, i), at(second, i));
            }
}

// The promise of the program: brush the hot, oxygen-poor points with the mouse, and exactly those are selected.
TEST_F(Views, BrushingHotAndOxygenPoorSelectsWhatBruteForceSelects) {
    show(fuelCell(volume::LatticeKind::BCC));
    session.time = source->info().times.back();
    scatterView.softness = 0;
    const auto matrix = [&] { draw("scatterMatrix", scatterView, drawScatterMatrixView, {900, 700}); };
    frame(matrix);
    frame(matrix);
    const auto* cache = dynamic_cast<const ScatterLayoutCache*>(caches.at("scatterMatrix").get());
    ASSERT_NE(cache, nullptr);
    const ScatterLayout layout = cache->layout;
    std::size_t oxygen = 99, heat = 99;
    for (std::size_t i = 0; i < layout.size(); ++i) {
        if (layout.infos[i].name == "O2") oxygen = i;
        if (layout.infos[i].name == "T") heat = i;
    }
    ASSERT_LT(oxygen, heat);
    const PlotFrame plot = layout.cell(oxygen, heat);
    // Medians of the samples that have both: about a quarter or so will be hot and poor.
    const int o2 = layout.channels[oxygen], t = layout.channels[heat];
    const int time = source->info().nearestTime(session.time);
    std::vector<float> allO2, allT;
    forEachSample(*source, o2, t, time, [&](float a, float b) {
        if (std::isnan(a) || std::isnan(b)) return;
        allO2.push_back(a);
        allT.push_back(b);
    });
    ASSERT_GT(allO2.size(), 20u);
    std::nth_element(allO2.begin(), allO2.begin() + static_cast<std::ptrdiff_t>(allO2.size() / 2), allO2.end());
    std::nth_element(allT.begin(), allT.begin() + static_cast<std::ptrdiff_t>(allT.size() / 4), allT.end());
    const double poor = static_cast<double>(allO2[allO2.size() / 2]), hot = static_cast<double>(allT[allT.size() / 4]);

    const ImVec2 from = plot.pixel(poor, hot), to{plot.min.x - 20, plot.min.y - 20};
    mouse = from;
    frame(matrix);
    ImGui::GetIO().MouseDown[0] = true;
    frame(matrix);
    for (float share : {0.3f, 0.7f, 1.0f}) {
        mouse = {from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share};
        frame(matrix);
    }
    ImGui::GetIO().MouseDown[0] = false;
    frame(matrix);
    ASSERT_EQ(session.selection.brushes.size(), 1u);
    const auto& brush = std::get<vis::RangeRegion>(session.selection.brushes[0].region);
    ASSERT_EQ(brush.intervals.size(), 2u);
    EXPECT_EQ(brush.intervals[0].channel, "O2");
    EXPECT_EQ(brush.intervals[1].channel, "T");
    EXPECT_NEAR(brush.intervals[0].hi, poor, plot.perPixelX());
    EXPECT_NEAR(brush.intervals[1].lo, hot, plot.perPixelY());
    EXPECT_EQ(brush.intervals[1].hi, plot.y.hi) << "dragged beyond the plot, it ends at its edge";

    std::uint64_t expected = 0, total = 0;
    double hottest = 0;
    forEachSample(*source, o2, t, time, [&](float a, float b) {
        total += !std::isnan(b);
        const double x = static_cast<double>(a), y = static_cast<double>(b);
        const bool in = x >= brush.intervals[0].lo && x <= brush.intervals[0].hi && y >= brush.intervals[1].lo &&
                        y <= brush.intervals[1].hi;
        expected += in;
        if (in) hottest = std::max(hottest, y);
    });
    EXPECT_GT(expected, 0u);
    EXPECT_LT(expected, total);
    ViewContext context{session, source, renderer, jobs, caches};
    context.headless = true;
    StatisticsFeed feed;
    const auto result =
        feed.get(context, "test", makeWish(session, source->info(), {o2, t}, {plot.x, plot.y}, 32, true));
    ASSERT_NE(result, nullptr);
    EXPECT_TRUE(result->brushed);
    EXPECT_EQ(result->statistics.channels[0].inside.samples, static_cast<double>(expected));
    EXPECT_EQ(result->statistics.channels[1].inside.samples, static_cast<double>(expected));
    EXPECT_EQ(result->statistics.channels[1].inside.max, hottest);
    double focus = 0;
    for (double f : result->statistics.joint[0].focus) focus += f;
    EXPECT_NEAR(focus, static_cast<double>(expected), 1e-3);

    // Esc over the view clears it everywhere.
    ImGui::GetIO().KeysDown[256] = true;
    frame(matrix);
    EXPECT_TRUE(session.selection.brushes.empty());
    ImGui::GetIO().KeysDown[256] = false;
}

// Drags turn the tesseract in the planes they say, the angles stay those of a rotation, R turns back.
TEST_F(Views, ATesseractTurnsByHand) {
    show(fuelCell(volume::LatticeKind::BCC));
    const auto view = [&] { draw("tesseract", tesseractView, drawTesseractView, {700, 600}); };
    const auto drag = [&](int mouseButton, bool shift) {
        mouse = {300, 250};
        ImGui::GetIO().KeyShift = shift;
        frame(view);
        ImGui::GetIO().MouseDown[mouseButton] = true;
        frame(view);
        mouse = {360, 280};
        frame(view);
        ImGui::GetIO().MouseDown[mouseButton] = false;
        frame(view);
        ImGui::GetIO().KeyShift = false;
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
    frame(view);
    EXPECT_TRUE(busy) << "a tour goes on";
    headless = true;
    ImGui::GetIO().KeysDown['R'] = true;
    frame(view);
    ImGui::GetIO().KeysDown['R'] = false;
    frame(view);
    EXPECT_EQ(tesseractView.turn, start.turn);
    EXPECT_EQ(tesseractView.turn4, start.turn4);
    EXPECT_FALSE(tesseractView.tour);
}

// A click enlarges a plot; a drag in the large one brushes by its own pixels, not by those of the small one.
TEST_F(Views, AClickEnlargesAPlotThatCanBeBrushed) {
    show(fuelCell(volume::LatticeKind::BCC));
    const auto matrix = [&] { draw("scatterMatrix", scatterView, drawScatterMatrixView, {900, 700}); };
    const auto button = [&](bool down) {
        ImGui::GetIO().MouseDown[0] = down;
        frame(matrix);
    };
    frame(matrix);
    frame(matrix);
    const ScatterLayout layout = dynamic_cast<const ScatterLayoutCache*>(caches.at("scatterMatrix").get())->layout;
    ASSERT_GE(layout.size(), 4u);
    const PlotFrame small = layout.cell(0, 2);
    mouse = {(small.min.x + small.max.x) / 2, (small.min.y + small.max.y) / 2};
    frame(matrix);
    button(true);
    button(false);
    const std::vector<std::string> wanted{layout.infos[0].name, layout.infos[2].name};
    EXPECT_EQ(scatterView.enlarged, wanted);
    EXPECT_TRUE(session.selection.brushes.empty());

    const PlotFrame corner = layout.cell(layout.size() - 1, 0);
    mouse = {corner.max.x - 10, corner.min.y + 10};
    frame(matrix);
    button(true);
    mouse = {corner.max.x - 60, corner.min.y + 40};
    frame(matrix);
    button(false);
    ASSERT_EQ(session.selection.brushes.size(), 1u);
    const vis::BrushInterval& x = std::get<vis::RangeRegion>(session.selection.brushes[0].region).intervals[0];
    EXPECT_EQ(x.channel, wanted[0]);
    // 50 pixels of a plot more than two cells wide.
    EXPECT_LT(x.hi - x.lo, 50 * small.perPixelX());
    EXPECT_GT(x.hi - x.lo, 10 * small.perPixelX());

    mouse = {small.max.x - 3, small.max.y - 3};
    frame(matrix);
    button(true);
    button(false);
    EXPECT_TRUE(scatterView.enlarged.empty()) << "another click puts it away";
}

// A selection with a channel that is not shown, soft edges and an inverted brush: the feed's compiled function of the
// values agrees with the definition.
TEST_F(Views, FeedCountsWhatTheSelectionDefines) {
    show(fuelCell(volume::LatticeKind::CC));
    const volume::DatasetInfo& info = source->info();
    const auto channelOf = [&](const char* name) { return *info.findChannel(name); };
    const Range heat = info.channelRange(info.channels()[static_cast<std::size_t>(channelOf("T"))]);
    const Range water = info.channelRange(info.channels()[static_cast<std::size_t>(channelOf("H2O"))]);
    const double width = water.hi - water.lo;
    session.selection.brushes = {
        vis::rangeBrush({{"H2O", water.lo, water.lo + width * 0.4, width * 0.2}}, "water"),
        vis::rangeBrush({{"T", heat.lo, (heat.lo + heat.hi) / 2, 0}}, "heat"),
        vis::rangeBrush({{"T", 0, 1, 0}}, "off"),
    };
    session.selection.brushes[1].inverted = true;
    session.selection.brushes[2].enabled = false;
    for (const vis::BrushCombine combine : {vis::BrushCombine::And, vis::BrushCombine::Or, vis::BrushCombine::Minus}) {
        session.selection.brushes[1].combine = combine;
        ViewContext context{session, source, renderer, jobs, caches};
        context.headless = true;
        StatisticsFeed feed;
        const auto result = feed.get(context, "test", makeWish(session, info, {channelOf("p")}, {{0, 2e5}}, 8, false));
        ASSERT_NE(result, nullptr);
        double expected = 0;
        std::vector<std::pair<float, float>> values;
        forEachSample(*source, channelOf("H2O"), channelOf("T"), 0, [&](float a, float b) {
            values.push_back({a, b});
        });
        std::size_t i = 0;
        forEachSample(*source, channelOf("p"), channelOf("p"), 0, [&](float p, float) {
            const auto [h2o, t] = values[i++];
            if (std::isnan(p)) return;
            const double doi = vis::degreeOfInterest(
                session.selection, [&](const std::string& name) { return static_cast<double>(name == "T" ? t : h2o); });
            expected += doi;
        });
        double focus = 0;
        for (double f : result->statistics.channels[0].histogram.focus) focus += f;
        EXPECT_NEAR(focus, expected, 1e-3 * (1 + expected));
        EXPECT_NEAR(result->statistics.channels[0].inside.samples, expected, 1e-3 * (1 + expected));
    }
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
    data.load = [](int, int, int) -> volume::Field { throw Error("damaged"); };
    show(volume::makeMemorySource(std::move(data), {}));
    int reported = 0;
    for (int i = 0; i < 60; ++i) {
        frame([&] { draw("scatterMatrix", scatterView, drawScatterMatrixView, {640, 480}); });
        for (const std::string& message : messages) reported += message.find("damaged") != std::string::npos;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    EXPECT_GE(reported, 1);
    EXPECT_LE(reported, 2) << "once for the plots, once for the values at the cursor";
}

} // namespace
} // namespace tessera::app
