#include "app/data/open.h"
#include "app/drawing/panels.h"
#include "app/platform/gui.h"
#include "app/platform/headless.h"
#include "tests/app/drawn_text.h"
#include "vis/gl/headless.h"

#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>

/// Views and the window as vector graphics, beside the pictures of them.
namespace tessera::app {
namespace {

Opened plantedData() {
    OpenRequest request;
    request.data.emplace();
    request.data->model = "planted";
    request.data->settings = {{"nx", 9}, {"ny", 9}, {"nz", 21}, {"times", 2}};
    Opened opened = open(request);
    opened.document.session.render.samples = 1;
    return opened;
}

/// Share of the pixels of which a channel differs by more than `most`.
double differing(const vis::Image& a, const vis::Image& b, int most) {
    EXPECT_EQ(a.size, b.size);
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
        bool apart = false;
        for (std::size_t c = i; c < i + 3; ++c) apart = apart || std::abs(int(a.rgba[c]) - int(b.rgba[c])) > most;
        count += apart ? 1 : 0;
    }
    return double(count) / (double(a.rgba.size()) / 4);
}

class DrawnPageGl : public testing::TestWithParam<const char*> {};

// Edges of letters and lines differ, since another program draws them.
TEST_P(DrawnPageGl, ShowsWhatThePictureShows) {
    Opened opened = plantedData();
    Session& session = opened.document.session;
    const std::string kind = GetParam();
    PictureRequest request;
    request.size = {640, 480};
    if (!kind.empty()) request.pane = addView(session, *viewOfKind(kind));
    opened.document.history.reset(session);
    PictureMaker maker;
    const vis::Image picture = maker.render(opened.document, opened.sources(), request);
    const VectorPage page = maker.page(opened.document, opened.sources(), request);
    EXPECT_EQ(page.size, glm::dvec2(480, 360)) << "points at 96 pixels an inch";
    const vis::Image drawn = imageOf(page, request.size);
    EXPECT_LT(differing(picture, drawn, 96), kind.empty() ? 0.04 : 0.025);
    EXPECT_LT(differing(picture, drawn, 24), kind.empty() ? 0.09 : 0.06);
    int words = 0;
    for (const shapes::Mark& mark : page.marks) words += std::holds_alternative<shapes::Words>(mark.shape) ? 1 : 0;
    EXPECT_GT(words, 2) << "texts are texts";
}

// Views with figures of their own are in view_pages_test.cpp.
INSTANTIATE_TEST_SUITE_P(Views, DrawnPageGl,
                         testing::Values("", "volume", "slices", "shadowCube", "tesseract", "scatterMatrix", "compare"),
                         [](const auto& made) { return *made.param ? std::string(made.param) : "window"; });

// Read by another reader of ImGui's triangles.
TEST(DrawnPageGl, HasEveryTextOfTheFrameAtItsPlace) {
    const vis::HeadlessContext context;
    const Gui gui;
    Workbench workbench({.headless = true, .onlyPane = {}});
    Opened opened = plantedData();
    opened.document.history.reset(opened.document.session);
    workbench.install(std::move(opened));
    OffscreenFrames frames({900, 700}, false);
    for (int i = 0; i < 200 && (i < 4 || workbench.busy()); ++i) frames.draw(workbench, 1);
    const std::vector<DrawnText> texts = drawnTexts();
    const VectorPage page = frames.page(workbench, 1);
    std::size_t found = 0, wanted = 0;
    std::string missing;
    for (const DrawnText& text : texts) {
        const bool icon = text.text.find("\xef") != std::string::npos;
        if (icon || text.text.empty()) continue;
        ++wanted;
        const std::size_t before = found;
        for (const shapes::Mark& mark : page.marks) {
            const auto* words = std::get_if<shapes::Words>(&mark.shape);
            if (!words || words->text.find(text.text) == std::string::npos) continue;
            const bool begins = words->text.starts_with(text.text);
            if (std::abs(words->angle) < 1 &&
                ((begins && std::abs(words->at.x - double(text.min.x)) > 2) || words->at.y < double(text.min.y) ||
                 words->at.y > double(text.max.y) + 1))
                continue;
            ++found;
            break;
        }
        if (found == before) missing += "\n" + text.text;
    }
    EXPECT_GT(wanted, 30u);
    EXPECT_GE(found, wanted * 9 / 10) << "others are cut off by their pane:" << missing;
}

TEST(DrawnPageGl, AFigureHasThePanelsOfItsViewsInTheirOrder) {
    Opened opened = plantedData();
    opened.document.history.reset(opened.document.session);
    PictureMaker maker;
    PictureRequest request;
    request.size = {640, 300};
    request.ground = PictureGround::White;
    const std::string volume = "volume", slices = addView(opened.document.session, *viewOfKind("slices"));
    request.panels = {slices, volume};
    const vis::Image both = maker.render(opened.document, opened.sources(), request);
    ASSERT_EQ(both.size, request.size);
    const std::vector<PanelPlace> places = panelPlaces(request.size, 2, 2, textPixels(request.scale));
    for (std::size_t i = 0; i < 2; ++i) {
        PictureRequest one = request;
        one.panels.clear();
        one.pane = request.panels[i];
        one.size = places[i].hi - places[i].lo;
        const vis::Image alone = maker.render(opened.document, opened.sources(), one);
        vis::Image part;
        part.size = one.size;
        for (int y = places[i].lo.y; y < places[i].hi.y; ++y) {
            const auto row = both.rgba.begin() + (std::ptrdiff_t(y) * both.size.x + places[i].lo.x) * 4;
            part.rgba.insert(part.rgba.end(), row, row + std::ptrdiff_t(one.size.x) * 4);
        }
        EXPECT_EQ(differing(alone, part, 1), 0) << i << ": panels are pictures of their views, pixel by pixel";
    }
    // Between the panels there is the ground that was asked for.
    ASSERT_EQ(opened.document.session.appearance.theme, Theme::Dark);
    EXPECT_EQ(both.rgba[0], 255);
    PictureRequest shown = request;
    shown.ground = PictureGround::Shown;
    EXPECT_LT(maker.render(opened.document, opened.sources(), shown).rgba[0], 64);
    const std::string path = testing::TempDir() + "figure_of_panels.svg";
    maker.write(opened.document, opened.sources(), request, path);
    std::string svg(std::filesystem::file_size(path), ' ');
    std::FILE* const file = std::fopen(path.c_str(), "rb");
    EXPECT_EQ(std::fread(svg.data(), 1, svg.size(), file), svg.size());
    std::fclose(file);
    std::filesystem::remove(path);
    const std::size_t a = svg.find(">a</text>"), b = svg.find(">b</text>"), x = svg.find("x [");
    EXPECT_NE(a, std::string::npos);
    EXPECT_LT(a, b);
    EXPECT_NE(x, std::string::npos);
}

} // namespace
} // namespace tessera::app
