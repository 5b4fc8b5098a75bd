#include "app/data/open.h"
#include "app/drawing/panels.h"
#include "app/platform/headless.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>

/// Every kind of view as SVG and PDF in the forms that users ask for: the size of the page, its texts, its ground.
namespace tessera::app {
namespace {

Opened cellOfPages() {
    OpenRequest request;
    request.data.emplace();
    request.data->model = "fuel-cell";
    request.data->settings = {{"nx", 7}, {"ny", 9}, {"nz", 13}, {"times", 3}};
    Opened opened = open(request);
    opened.document.session.render.samples = 1;
    return opened;
}

PictureForm paperForm(const char* preset, double text, PictureGround ground) {
    PictureForm form;
    form.size = *PictureSize::preset(preset);
    form.size.dpi = 100; // soon drawn
    form.size.textPt = text;
    form.ground = ground;
    return form;
}

const PictureForm kPageForms[] = {
    paperForm("oneColumn", 8, PictureGround::Shown), paperForm("twoColumns", 8, PictureGround::Shown),
    paperForm("oneColumn", 14, PictureGround::Shown), paperForm("oneColumn", 8, PictureGround::White)};

/// Kinds whose pages are drawn as their panes are, with lenses, brushes and true proportions (drawn_page_gl_test.cpp).
const std::set<std::string_view> kDrawn{"slices", "oblique", "sliceMatrix", "scatterMatrix", "hyperSlice", "hierarchy"};

template <class Shape> std::vector<Shape> shapesOn(const VectorPage& page) {
    std::vector<Shape> out;
    for (const shapes::Mark& mark : page.marks)
        if (const auto* shape = std::get_if<Shape>(&mark.shape)) out.push_back(*shape);
    return out;
}

glm::dvec2 paperPoints(const PictureForm& form) {
    return glm::dvec2(form.size.pixels()) * 72.0 / form.size.dpi;
}

void expectPageTexts(const VectorPage& page, double size) {
    static const std::set<std::string> kControls{"Export",    "Clear",         "More",       "log",
                                                 "soft 15 %", "drag to brush", "everywhere", "along the line"};
    const auto words = shapesOn<shapes::Words>(page);
    EXPECT_GT(words.size(), 3u);
    for (const shapes::Words& each : words) {
        EXPECT_NEAR(each.size, size, size * 0.02) << each.text;
        EXPECT_FALSE(kControls.contains(each.text)) << each.text << " is of a control";
    }
}

class ViewPages : public testing::Test {
protected:
    static void SetUpTestSuite() {
        opened = new Opened(cellOfPages());
        Session& session = opened->document.session;
        session.probes = {{.name = "a", .position = session.cursor}, {.name = "b", .position = {1e-3, 3e-4, 5e-3}}};
        forEachViewKind([&]<class Kind>(const Kind&) {
            panes.emplace_back(Kind::State::kType, addView(opened->document.session, typename Kind::State{}));
        });
        opened->document.history.reset(opened->document.session);
        maker = new PictureMaker({.openGl = false});
    }
    static void TearDownTestSuite() {
        delete maker;
        delete opened;
    }
    static VectorPage page(const PictureRequest& request) {
        return maker->page(opened->document, opened->sources(), request);
    }
    static const ViewTraits& traits(const std::string& pane) {
        return traitsOf(opened->document.session.views.at(pane));
    }
    static inline Opened* opened = nullptr;
    static inline PictureMaker* maker = nullptr;
    static inline std::vector<std::pair<std::string_view, std::string>> panes; ///< kind and pane
};

TEST_F(ViewPages, HaveTheSizeAndTheTextThatWereAskedFor) {
    for (const auto& [kind, pane] : panes)
        for (const PictureForm& form : kPageForms) {
            SCOPED_TRACE(std::string(kind) + " " + std::to_string(form.size.widthMm) + " mm, text " +
                         std::to_string(form.size.textPt));
            const VectorPage made = page(pictureRequest(form, pane));
            EXPECT_NEAR(made.size.x, paperPoints(form).x, 0.5);
            const bool sentences = kind == "worthSeeing"; // a table of them is drawn smaller where it has no room
            if (kind != "statistics" && kind != "probes" && !sentences) { // a table is as high as its rows take
                EXPECT_NEAR(made.size.y, paperPoints(form).y, 0.5);
            }
            const auto grounds = shapesOn<shapes::Rect>(made);
            ASSERT_FALSE(grounds.empty());
            const bool white = form.ground == PictureGround::White;
            if (traits(pane).figure && !kDrawn.contains(kind)) {
                EXPECT_EQ(grounds[0].color.r == 1, white);
                if (!sentences) expectPageTexts(made, form.size.textPt);
                for (const shapes::Words& each : shapesOn<shapes::Words>(made))
                    EXPECT_EQ(each.color.r < 0.5f, white) << each.text << " is not seen on this ground";
            }
        }
}

TEST_F(ViewPages, ArePagesOfFilesTooAndPanelsOfFigures) {
    for (const auto& [kind, pane] : panes) {
        if (!traits(pane).figure || kDrawn.contains(kind)) continue;
        SCOPED_TRACE(kind);
        PictureRequest request = pictureRequest(kPageForms[1], "");
        const std::string curves = std::ranges::find(panes, "curves", &decltype(panes)::value_type::first)->second;
        request.panels = {pane, curves};
        const VectorPage both = page(request);
        EXPECT_EQ(both.size, paperPoints(kPageForms[1]));
        expectPageTexts(both, 8);
        const auto has = [&](const std::string& text) {
            return std::ranges::any_of(shapesOn<shapes::Words>(both),
                                       [&](const auto& each) { return each.text == text; });
        };
        EXPECT_TRUE(has("a"));
        EXPECT_TRUE(has("b"));
        char box[64];
        const glm::dvec2 size = paperPoints(kPageForms[0]);
        const VectorPage alone = page(pictureRequest(kPageForms[0], pane));
        std::snprintf(box, sizeof box, "width=\"%.2fpt\" height=\"%.2fpt\"", size.x, alone.size.y);
        EXPECT_NE(svgOf(alone).find(box), std::string::npos) << box;
        EXPECT_NE(pdfOf(alone).find("/MediaBox [ 0 0 " + std::to_string(int(size.x))), std::string::npos);
    }
}

TEST_F(ViewPages, TablesAreThereForEveryViewThatHasOne) {
    for (const auto& [kind, pane] : panes) {
        if (!traits(pane).csv) continue;
        const std::string csv = maker->table(opened->document, opened->sources(), pictureRequest(kPageForms[0], pane));
        EXPECT_TRUE(csv.starts_with("# numbers: ")) << kind;
        EXPECT_GT(std::ranges::count(csv, '\n'), 2) << kind;
    }
}

TEST_F(ViewPages, TheSameCurvesAloneAndAsAPanelAreTheSameStrokes) {
    const std::string curves = std::ranges::find(panes, "curves", &decltype(panes)::value_type::first)->second;
    const auto strokes = [](const VectorPage& made) {
        std::multiset<std::pair<float, double>> out; // colour and width of lines of data
        for (const shapes::Stroke& each : shapesOn<shapes::Stroke>(made))
            if (each.points.size() > 2) out.insert({each.color.g, std::round(each.width * 1000)});
        return out;
    };
    PictureRequest request = pictureRequest(kPageForms[1], "");
    request.panels = {curves, curves};
    auto twice = strokes(page(pictureRequest(kPageForms[0], curves)));
    ASSERT_FALSE(twice.empty());
    const auto once = twice;
    twice.insert(once.begin(), once.end());
    EXPECT_EQ(strokes(page(request)), twice);
}

TEST_F(ViewPages, ATimelineSaysItsTimeWithoutItsButtons) {
    const std::string timeline = std::ranges::find(panes, "timeline", &decltype(panes)::value_type::first)->second;
    PictureForm form;
    form.size.width = 700, form.size.height = 160;
    int times = 0;
    for (const shapes::Words& each : shapesOn<shapes::Words>(page(pictureRequest(form, timeline)))) {
        times += each.text.starts_with("t = ");
        EXPECT_EQ(each.text.find("fps"), std::string::npos) << each.text;
        EXPECT_EQ(each.text.find("Keyframe"), std::string::npos) << each.text;
    }
    EXPECT_EQ(times, 1);
}

} // namespace
} // namespace tessera::app
