#include "app/data/apply_layout.h"
#include "app/data/open.h"
#include "app/pane/view_parts.h"
#include "app/platform/headless.h"
#include "app/ui/ticks.h"

#include "vis/image/image_metrics.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <ostream>
#include <set>

/// What the layouts that ship show of the built-in data: which views, what the legends say, and how much of a picture
/// has which colours. Measured once on a small cell; a share may be a quarter more or less.
namespace tessera::app {
namespace {

enum class Hue { Orange, Warm, Cold, Green, Light, Dark };

struct Share {
    const char* pane;
    Hue hue;
    double measured; ///< of the pixels; 0: none at all
};

struct Shipped {
    const char* name;
    const char* views;
    const char* legends;
    std::vector<Share> shares;
    bool brushed = false;     ///< what its brushes hold is orange in the scatterplots, and nothing is without them
    const char* refusal = ""; ///< why the processor does not cast the rays of its 3D view
};

void PrintTo(const Shipped& layout, std::ostream* out) {
    *out << layout.name;
}

constexpr const char* kTemperature = "T [K] 353.17 .. 356.60";

const std::vector<Shipped>& shipped() {
    using enum Hue;
    static const std::vector<Shipped> layouts = {
        {"animation",
         "data layers slices timeline transfer volume",
         "O2 [mol/m³] = 2.5; T [K] 353.17 .. 356.60",
         {{"volume", Orange, 0.0588}, {"volume", Cold, 0.0292}, {"slices", Green, 0.0381}}},
        {"branchingPulse",
         "data layers tesseract timeline transfer volume",
         "tracer [mol/m³] 0.00 .. 8.00",
         {{"volume", Cold, 0.0507},
          {"volume", Green, 0.0352},
          {"tesseract", Cold, 0.0541},
          {"tesseract", Warm, 0.0375}}},
        {"charcoal",
         "data layers timeline transfer volume",
         "",
         {{"volume", Light, 0.86}, {"volume", Warm, 0}, {"volume", Cold, 0}}},
        {"callouts",
         "data layers timeline transfer volume",
         "T [K] 353.17 .. 356.60; O2 [mol/m³] 0.02 .. 6.22",
         {{"volume", Warm, 0.0679}, {"volume", Orange, 0.027}}},
        // Several pictures beside each other are under test with the view itself.
        {"compareCompression", "compare data layers transfer", "O2 [mol/m³] = 2.5; T [K] 353.17 .. 356.60", {}},
        {"compareLattice", "compare data layers transfer", "rho = 0.5", {}},
        {"compareTechniques",
         "compare data layers scatterMatrix transfer",
         kTemperature,
         {{"scatterMatrix", Orange, 0.02}},
         true},
        {"compressionError",
         "data histogram history layers log scatterMatrix slices timeline transfer volume",
         "T error [K] -0.0343 .. 0.0343",
         {{"volume", Cold, 0.0459},
          {"volume", Warm, 0.0391},
          {"slices", Warm, 0.0306},
          {"slices", Cold, 0.0287},
          {"histogram", Orange, 0},
          {"scatterMatrix", Orange, 0}}},
        {"evening",
         "data layers transfer volume",
         "rho = 0.5",
         {{"volume", Warm, 0.132}, {"volume", Dark, 0.556}, {"volume", Cold, 0}}},
        {"flow",
         "data layers slices timeline transfer volume",
         "O2 [mol/m³] 0.02 .. 6.22; H2 [mol/m³] 24.37 .. 29.51; T [K] 353.17 .. 356.60",
         {{"volume", Cold, 0.0755}, {"volume", Green, 0.0679}}},
        {"focus",
         "data history layers log scatterMatrix slices timeline transfer volume",
         "T [K] 353.17 .. 356.60; T [K] = 354.3",
         {{"volume", Warm, 0.0527}, {"scatterMatrix", Orange, 0.0168}},
         true},
        {"gases",
         "data layers slices timeline transfer volume",
         "O2 [mol/m³] = 2.5; H2 [mol/m³] = 26.5; T [K] 353.17 .. 356.60",
         {{"volume", Orange, 0.0708}, {"volume", Cold, 0.0263}}},
        {"glyphs",
         "data layers slices timeline transfer volume",
         "six values per place 0.00 .. 1.00; T [K] 353.17 .. 356.60",
         {{"volume", Cold, 0.0153}, {"volume", Orange, 0.00371}}},
        {"hyperplane",
         "data layers profile slices timeline transfer volume volume-2",
         "H2 [mol/m³] 24.48 .. 33.11",
         {{"volume", Warm, 0.0159}, {"slices", Warm, 0.0156}}},
        {"hyperslice",
         "data hyperSlice layers timeline transfer volume",
         "H2 [mol/m³] 24.48 .. 33.11",
         {{"hyperSlice", Cold, 0.103}, {"hyperSlice", Green, 0.0515}}},
        {"illustration",
         "data layers timeline transfer volume",
         "O2 [mol/m³] = 2.5; T [K] 353.17 .. 356.60",
         {{"volume", Light, 0.825}, {"volume", Orange, 0.11}}},
        {"lens",
         "data history layers scatterMatrix slices statistics timeline transfer volume",
         "T [K] 353.17 .. 356.60; O2 [mol/m³] 0.02 .. 6.22; O2 [mol/m³] = 2.2; |U| [m/s] 0.00 .. 2.83",
         {{"volume", Cold, 0.0303}, {"volume", Warm, 0.0799}, {"scatterMatrix", Orange, 0}}},
        {"lic",
         "data layers slices timeline transfer volume",
         "T [K] 353.17 .. 356.60; O2 [mol/m³] 0.02 .. 6.22",
         {{"volume", Warm, 0.123}, {"volume", Orange, 0.0431}, {"volume", Cold, 0.0371}}},
        {"overTime",
         "data layers profile profile-2 slices timeline transfer volume",
         "H2 [mol/m³] 24.48 .. 33.11",
         {{"profile", Cold, 0.0111},
          {"profile", Orange, 0.00443},
          {"profile-2", Cold, 0.139},
          {"profile-2", Green, 0.0574}}},
        {"overview",
         "data history layers log scatterMatrix slices timeline transfer volume",
         kTemperature,
         {{"volume", Warm, 0.0875}, {"slices", Warm, 0.0396}, {"scatterMatrix", Orange, 0}}},
        {"parallel",
         "data history layers log parallelCoordinates slices timeline transfer volume",
         kTemperature,
         {{"parallelCoordinates", Orange, 0.0136}}},
        {"pieces",
         "data layers pieces slices timeline transfer volume",
         "gas 0.00 .. 1.00",
         {{"volume", Cold, 0.0305}, {"volume", Green, 0.0418}, {"pieces", Cold, 0.0913}}},
        {"shadowCube",
         "data layers shadowCube slices timeline transfer",
         kTemperature,
         {{"shadowCube", Warm, 0.0788}, {"shadowCube", Green, 0.0311}}},
        {"speedlines",
         "data layers slices timeline transfer volume",
         "O2 [mol/m³] 0.02 .. 6.22; H2 [mol/m³] 24.37 .. 29.51; T [K] 353.17 .. 356.60",
         {{"volume", Cold, 0.0414}, {"volume", Green, 0.0357}}},
        {"starved",
         "data history layers log scatterMatrix slices timeline transfer volume",
         kTemperature,
         {{"volume", Warm, 0.051}, {"slices", Warm, 0.0125}, {"scatterMatrix", Orange, 0.0168}},
         true},
        {"statistics",
         "data histogram history layers log profile scatterMatrix sliceMatrix statistics timeline transfer volume",
         kTemperature,
         {{"histogram", Orange, 0.0893}, {"scatterMatrix", Orange, 0.0337}, {"sliceMatrix", Cold, 0.0252}},
         true},
        {"tesseract",
         "data layers tesseract timeline transfer volume",
         "H2O [mol/m³] 4.9 .. 14.9",
         {{"tesseract", Green, 0.114},
          {"tesseract", Cold, 0.0945},
          {"tesseract", Warm, 0.0615},
          {"volume", Green, 0.149}}},
        {"timelines",
         "data layers slices timeline transfer volume",
         "O2 [mol/m³] 0.02 .. 6.22; H2 [mol/m³] 24.37 .. 29.51; T [K] 353.17 .. 356.60",
         {{"volume", Cold, 0.0483}, {"volume", Green, 0.0444}}},
        {"worlds",
         "data hierarchy history layers log statistics timeline transfer volume",
         kTemperature,
         {{"volume", Warm, 0.0855}, {"hierarchy", Orange, 0.00493}, {"hierarchy", Cold, 0.0194}}},
        {"worthSeeing", "data layers slices timeline transfer volume whatElse when worthSeeing", kTemperature, {}},
    };
    return layouts;
}

bool has(Hue hue, int r, int g, int b) {
    switch (hue) {
    case Hue::Orange:
        return r > 190 && g > 110 && g < 210 && b < 130;
    case Hue::Warm:
        return r > b + 40;
    case Hue::Cold:
        return b > r + 40;
    case Hue::Green:
        return g > r + 30;
    case Hue::Light:
        return r + g + b > 630;
    case Hue::Dark:
        return r + g + b < 150;
    }
    return false;
}

double shareOf(const vis::Image& image, Hue hue) {
    double count = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4)
        count += has(hue, image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]);
    return count / (double(image.size.x) * image.size.y);
}

class Layouts : public testing::TestWithParam<Shipped> {
protected:
    /// The layout on fewer samples than it comes with.
    void SetUp() override {
        OpenRequest request;
        request.layout = GetParam().name;
        request.data = loadSession(findLayout(request.layout)).session.data;
        std::map<std::string, double>& settings = request.data->settings;
        if (request.data->model == "marschner-lobb")
            settings["nx"] = settings["ny"] = settings["nz"] = 24;
        else if (request.data->model == "branching-pulse")
            settings = {{"nx", 36}, {"ny", 22}, {"nz", 11}, {"times", 20}};
        else if (request.data->model == "bubbles")
            settings = {{"nx", 18}, {"ny", 18}, {"nz", 36}, {"times", 7}};
        else
            settings = {{"nx", 7}, {"ny", 13}, {"nz", 40}};
        opened = open(request);
        session().render.samples = 1;
    }
    Session& session() { return opened.document.session; }
    vis::Image picture(const std::string& pane) {
        opened.document.history.reset(session());
        return maker.render(opened.document, opened.sources(), {.pane = pane, .size = {320, 240}, .scale = 1});
    }
    Opened opened;
    PictureMaker maker;
};

TEST_P(Layouts, ShowWhatTheyAreFor) {
    EXPECT_TRUE(opened.messages.empty()) << opened.messages.front();
    std::string views, legends;
    for (const auto& [pane, state] : session().views) views += (views.empty() ? "" : " ") + pane;
    EXPECT_EQ(views, GetParam().views);
    std::vector<std::string> docked = panesOf(session().dock);
    std::ranges::sort(docked);
    EXPECT_EQ(docked, paneKeys(session())) << "each has its place";
    for (const LegendEntry& each : sceneLegends(session(), opened.source->info())) {
        legends += (legends.empty() ? "" : "; ") + titleWithUnit(each.title, each.unit) + " ";
        const double digits = (each.range.hi - each.range.lo) / 100;
        legends += each.swatch ? "= " + formatNumber(each.value)
                               : formatNumber(each.range.lo, digits) + " .. " + formatNumber(each.range.hi, digits);
    }
    EXPECT_EQ(legends, GetParam().legends);

    std::map<std::string, vis::Image> drawn;
    for (const Share& each : GetParam().shares) {
        SCOPED_TRACE(std::string(each.pane) + ", hue " + std::to_string(int(each.hue)));
        if (!drawn.contains(each.pane)) drawn[each.pane] = picture(each.pane);
        const double share = shareOf(drawn[each.pane], each.hue);
        EXPECT_GE(share, each.measured / 1.25);
        EXPECT_LE(share, each.measured * 1.25);
    }
    EXPECT_EQ(!session().selection.brushes.empty() && session().views.contains("scatterMatrix"), GetParam().brushed);
    if (!GetParam().brushed) return;
    session().selection.brushes.clear();
    EXPECT_EQ(shareOf(picture("scatterMatrix"), Hue::Orange), 0);
}

/// What casts the rays of the 3D view where the processor is asked to.
TEST_P(Layouts, AreDrawnByTheProcessorBut) {
    if (!session().views.contains("volume")) return;
    session().render.engine = vis::Engine::Processor;
    opened.document.history.reset(session());
    vis::EngineUse use;
    maker.render(opened.document, opened.sources(), {.pane = "volume", .size = {160, 120}, .scale = 1},
                 [&](const Workbench& workbench) { use = workbench.renderer()->engine(); });
    EXPECT_EQ(use.refusal, GetParam().refusal);
    const bool rays = !std::ranges::all_of(session().layers, [](const vis::Layer& each) {
        return !each.visible || std::holds_alternative<vis::SliceLayer>(each.technique);
    });
    EXPECT_EQ(use.byProcessor, rays && GetParam().refusal == std::string_view());
}

/// Pictures are the same without OpenGL, but for single pixels at edges: of the 3D views of all layouts, and of each
/// other kind of view once.
TEST_P(Layouts, AreDrawnWithoutOpenGl) {
    const std::string name = GetParam().name;
    std::vector<std::string> panes = {"volume", "tesseract", "shadowCube"};
    if (name == "overview") panes.insert(panes.end(), {"slices", "scatterMatrix"});
    if (name == "compareTechniques") panes.push_back("compare");
    if (name == "hyperslice") panes.push_back("hyperSlice");
    if (name == "parallel") panes.push_back("parallelCoordinates");
    if (name == "worlds") panes.push_back("hierarchy");
    if (name == "worthSeeing") panes.push_back("worthSeeing");
    if (name == "pieces") panes.push_back("pieces");
    PictureMaker without({.openGl = false});
    for (const std::string& pane : panes) {
        if (!session().views.contains(pane)) continue;
        opened.document.history.reset(session());
        const PictureRequest request{.pane = pane, .size = {320, 240}, .scale = 1};
        const vis::Image ours = without.render(opened.document, opened.sources(), request);
        EXPECT_GE(vis::difference(ours, picture(pane)).psnr, 50) << pane;
    }
}

INSTANTIATE_TEST_SUITE_P(Shipped, Layouts, testing::ValuesIn(shipped()),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(LayoutsTable, HasEveryLayout) {
    std::set<std::string> known;
    for (const Shipped& each : shipped()) known.insert(each.name);
    const std::vector<std::string> names = layoutNames();
    EXPECT_EQ(known, std::set<std::string>(names.begin(), names.end()));
}

} // namespace
} // namespace tessera::app
