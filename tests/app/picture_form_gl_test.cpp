#include "app/command/picture_options.h"
#include "app/data/open.h"
#include "app/dialogs/picture_request.h"
#include "app/platform/headless.h"
#include "tests/app/drawn_text.h"
#include "vis/gl/headless.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <set>

/// Pictures for print: the size of their text, their ground, and their decoration part by part.
namespace tessera::app {
namespace {

/// Two times, so that a picture has a title; nothing that is measured with a cursor moves.
Opened plantedData() {
    OpenRequest request;
    request.data.emplace();
    request.data->model = "planted";
    request.data->settings = {{"nx", 9}, {"ny", 9}, {"nz", 21}, {"times", 2}};
    Opened opened = open(request);
    opened.document.session.render.samples = 1;
    opened.document.history.reset(opened.document.session);
    return opened;
}

vis::Image drawn(PictureMaker& maker, const Opened& opened, const PictureRequest& request) {
    return maker.render(opened.document, opened.sources(), request);
}

/// Pixels around something, none where min > max.
struct Pixels {
    glm::ivec2 min{1 << 30}, max{-1};
    std::size_t count = 0;
    void add(glm::ivec2 at) {
        min = glm::min(min, at);
        max = glm::max(max, at);
        ++count;
    }
    bool contains(glm::ivec2 at) const { return at.x >= min.x && at.x <= max.x && at.y >= min.y && at.y <= max.y; }
};

template <class Picks> std::vector<glm::ivec2> where(const vis::Image& image, const Picks& picks) {
    std::vector<glm::ivec2> out;
    for (int y = 0; y < image.size.y; ++y)
        for (int x = 0; x < image.size.x; ++x)
            if (picks(std::size_t(y * image.size.x + x) * 4)) out.push_back({x, y});
    return out;
}

std::vector<glm::ivec2> differing(const vis::Image& a, const vis::Image& b) {
    EXPECT_EQ(a.size, b.size);
    return where(a, [&](std::size_t i) {
        return a.rgba[i] != b.rgba[i] || a.rgba[i + 1] != b.rgba[i + 1] || a.rgba[i + 2] != b.rgba[i + 2];
    });
}

Pixels around(const std::vector<glm::ivec2>& pixels) {
    Pixels out;
    for (const glm::ivec2 at : pixels) out.add(at);
    return out;
}

Decoration only(bool Decoration::*part) {
    Decoration shown = *Decoration::preset("none");
    shown.*part = true;
    return shown;
}

Decoration without(bool Decoration::*part) {
    Decoration shown;
    shown.*part = false;
    return shown;
}

PictureRequest onPaper(double textPt, double dpi) {
    PictureForm form;
    form.size.measure = PictureMeasure::Millimetres;
    form.size.widthMm = 50;
    form.size.heightMm = 30;
    form.size.dpi = dpi;
    form.size.textPt = textPt;
    form.ground = PictureGround::White;
    form.decoration = only(&Decoration::title);
    return pictureRequest(form, "volume");
}

// The title "t = 0 s" on white, and nothing else: the digit is its highest letter, 0.71 em and its overshoots high.
TEST(PictureFormGl, TextIsAsHighAsItsPointsAtTheResolution) {
    Opened opened = plantedData();
    opened.document.session.layers.clear();
    PictureMaker maker;
    const auto rows = [&](double textPt, double dpi) {
        const vis::Image image = drawn(maker, opened, onPaper(textPt, dpi));
        EXPECT_EQ(image.size, glm::ivec2(int(std::lround(50 / 25.4 * dpi)), int(std::lround(30 / 25.4 * dpi))));
        EXPECT_EQ(image.dpi, dpi);
        // Of the first word; quantities over time would follow.
        const int most = int(textPt / 72 * dpi * 0.8 * 3);
        const Pixels text = around(
            where(image, [&](std::size_t i) { return image.rgba[i] < 128 && int(i / 4) % image.size.x < most; }));
        return text.max.y - text.min.y + 1;
    };
    for (const auto& [textPt, dpi] : {std::pair{8.0, 300.0}, {16.0, 300.0}, {8.0, 600.0}, {6.0, 150.0}}) {
        const double em = textPt / 72 * dpi;
        EXPECT_NEAR(rows(textPt, dpi), 0.73 * em, 1.5 + 0.02 * em) << textPt << " pt at " << dpi << " dpi";
    }
    const int before = rows(8, 300);
    opened.document.session.appearance.scale = 2;
    opened.document.history.reset(opened.document.session);
    EXPECT_EQ(rows(8, 300), before) << "the window's scale changes no text in print";
}

// Each part changes pixels of its own; nothing else changes where those in the corners stand.
TEST(PictureFormGl, EachPartOfTheDecorationChangesOnlyItsOwnArea) {
    const Opened opened = plantedData();
    PictureMaker maker;
    PictureRequest request{.pane = "volume", .size = {900, 600}, .scale = 1};
    const vis::Image whole = drawn(maker, opened, request);
    std::map<std::string, std::vector<glm::ivec2>> changed;
    for (const auto& [name, part] : {std::pair{"legend", &Decoration::legend},
                                     {"axes", &Decoration::axes},
                                     {"box", &Decoration::box},
                                     {"gizmo", &Decoration::gizmo},
                                     {"cursor", &Decoration::cursor},
                                     {"scaleBar", &Decoration::scaleBar},
                                     {"title", &Decoration::title}}) {
        request.decoration = without(part);
        changed[name] = differing(whole, drawn(maker, opened, request));
        EXPECT_GT(changed[name].size(), 20u) << name << " changes nothing";
        EXPECT_LT(changed[name].size(), whole.rgba.size() / 4 / 5) << name << " changes the picture";
    }
    for (const char* corner : {"legend", "gizmo", "scaleBar", "title"}) {
        const Pixels area = around(changed[corner]);
        for (const auto& [other, pixels] : changed) {
            if (other == corner) continue;
            const auto inside =
                std::count_if(pixels.begin(), pixels.end(), [&](glm::ivec2 at) { return area.contains(at); });
            EXPECT_EQ(inside, 0) << other << " changes pixels of the " << corner;
        }
    }
    // Outlines: there are none until something is brushed.
    request.decoration = without(&Decoration::outlines);
    EXPECT_TRUE(differing(whole, drawn(maker, opened, request)).empty());
}

TEST(PictureFormGl, WithoutDecorationAPictureIsTheBareScene) {
    const Opened opened = plantedData();
    PictureMaker maker;
    PictureRequest request{.pane = "volume", .size = {400, 300}, .scale = 1};
    request.decoration = *Decoration::preset("none");
    const vis::Image picture = drawn(maker, opened, request);
    const vis::HeadlessContext gl;
    vis::Renderer renderer(vis::quickestOptions());
    renderer.setSource(opened.source);
    vis::Scene scene = sceneOf(opened.document.session);
    scene.showBox = false;
    const auto target = renderer.makeTarget();
    while (!renderer.render(*target, scene, {.size = {400, 300}, .wait = true}).complete) {
    }
    vis::Image bare;
    bare.rgba = renderer.readPixels(*target, bare.size);
    EXPECT_TRUE(differing(picture, bare).empty());
    EXPECT_GT(around(where(bare, [&](std::size_t i) { return std::abs(bare.rgba[i] - bare.rgba[0]) > 10; })).count,
              500u)
        << "nothing is drawn";
}

TEST(PictureFormGl, SlicesAndComparisonsLeaveOutThePartsToo) {
    Opened opened = plantedData();
    addView(opened.document.session, CompareView{});
    opened.document.history.reset(opened.document.session);
    PictureMaker maker;
    for (const char* pane : {"slices", "compare"}) {
        PictureRequest request{.pane = pane, .size = {900, 600}, .scale = 1};
        const vis::Image whole = drawn(maker, opened, request);
        request.decoration = *Decoration::preset("none");
        const std::vector<glm::ivec2> all = differing(whole, drawn(maker, opened, request));
        EXPECT_GT(all.size(), 1000u) << pane;
        for (const auto part : {&Decoration::legend, &Decoration::cursor, &Decoration::title}) {
            request.decoration = without(part);
            const std::size_t count = differing(whole, drawn(maker, opened, request)).size();
            EXPECT_GT(count, 20u) << pane;
            EXPECT_LT(count, all.size()) << pane;
        }
    }
}

TEST(PictureFormGl, AWhiteGroundIsWhiteToTheEdges) {
    Opened opened = plantedData();
    opened.document.session.layers.clear();
    opened.document.history.reset(opened.document.session);
    PictureMaker maker;
    for (const char* pane : {"volume", "slices"}) {
        PictureRequest request{.pane = pane, .size = {500, 400}, .scale = 1, .ground = PictureGround::White};
        const vis::Image image = drawn(maker, opened, request);
        std::size_t edge = 0;
        for (const glm::ivec2 at :
             where(image, [&](std::size_t i) { return image.rgba[i] + image.rgba[i + 1] + image.rgba[i + 2] == 765; }))
            edge += at.x == 0 || at.y == 0 || at.x == 499 || at.y == 399;
        EXPECT_EQ(edge, 2u * (500 + 400) - 4) << pane;
    }
}

// Four legends, which cover some of the picture wherever they are.
TEST(PictureFormGl, ASmallFigureKeepsTheNumbersOfItsAxes) {
    PictureMaker maker;
    std::vector<DrawnText> texts;
    const auto draw = [&](const std::vector<std::string>& settings) {
        PictureOptions options;
        options.layout = "lens";
        options.settings = settings;
        Opened opened = openForPicture(options, {});
        opened.document.session.layers.resize(3); // without flow, which takes long
        maker.render(opened.document, opened.sources(), {.pane = "volume", .size = {320, 240}, .scale = 1},
                     [&](const Workbench&) { texts = drawnTexts(); });
    };
    const auto has = [&](const std::string& word) {
        return std::ranges::any_of(texts, [&](const DrawnText& each) { return each.text == word; });
    };
    const auto rows = [&] {
        std::set<int> at;
        for (const DrawnText& each : texts) at.insert(int(each.max.y));
        return at.size();
    };
    draw({});
    for (const char* word : {"y [mm]", "z [mm]", "10", "20", "30"}) EXPECT_TRUE(has(word)) << word;
    EXPECT_TRUE(has("353.2") && !has("355")) << "the ends of the bar are beside it";
    const std::size_t lines = rows();
    draw({"/appearance/legends=whole"});
    EXPECT_TRUE(has("355")) << "numbers below each bar";
    draw({"/appearance/legends=lines"});
    EXPECT_FALSE(has("355"));
    EXPECT_EQ(rows(), lines);
}

} // namespace
} // namespace tessera::app
