#include "app/data/open.h"
#include "app/platform/gui.h"
#include "app/platform/headless.h"
#include "volume/base/error.h"
#include "volume/sources/memory_source.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <set>

/// Where texts stand on pages: every kind of view, in every preset of page size, alone and as panels. No text lies over
/// another or leaves the page, and none that a figure needs is missing.
namespace tessera::app {
namespace {

using shapes::Words;

/// What a text covers: capitals and descenders, as a rectangle that may be turned.
struct TextBox {
    std::array<glm::dvec2, 4> corners;
    std::string text;
    double size = 0;

    explicit TextBox(const Words& words) : text(words.text), size(words.size) {
        constexpr double kCapitals = 0.72, kDescender = 0.14, kBearing = 0.04; // ems
        const double width = textWidth(words.text, words.face) * words.size,
                     turn = words.angle * std::numbers::pi / 180;
        const glm::dvec2 along(std::cos(turn), std::sin(turn)), down(-along.y, along.x);
        const glm::dvec2 base = words.at - along * (words.anchor * width) +
                                (words.middle ? down * (shapes::kMiddle * words.size) : glm::dvec2(0));
        const double from = kBearing * words.size, to = width - kBearing * words.size;
        const double top = -kCapitals * words.size, bottom = kDescender * words.size;
        corners = {base + along * from + down * top, base + along * to + down * top, base + along * to + down * bottom,
                   base + along * from + down * bottom};
    }
    glm::dvec2 lo() const { return glm::min(glm::min(corners[0], corners[1]), glm::min(corners[2], corners[3])); }
    glm::dvec2 hi() const { return glm::max(glm::max(corners[0], corners[1]), glm::max(corners[2], corners[3])); }
};

/// Whether turned rectangles share an area, by their separating axes.
bool cover(const TextBox& a, const TextBox& b) {
    for (const TextBox* const each : {&a, &b})
        for (const std::size_t side : {0u, 1u}) {
            const glm::dvec2 axis = each->corners[side + 1] - each->corners[side];
            Range first{HUGE_VAL, -HUGE_VAL}, second = first;
            for (std::size_t i = 0; i < 4; ++i) {
                first = {std::min(first.lo, glm::dot(axis, a.corners[i])),
                         std::max(first.hi, glm::dot(axis, a.corners[i]))};
                second = {std::min(second.lo, glm::dot(axis, b.corners[i])),
                          std::max(second.hi, glm::dot(axis, b.corners[i]))};
            }
            if (first.hi <= second.lo || second.hi <= first.lo) return false;
        }
    return true;
}

std::vector<TextBox> textsOn(const VectorPage& page) {
    std::vector<TextBox> out;
    for (const shapes::Mark& mark : page.marks)
        if (const auto* const words = std::get_if<Words>(&mark.shape); words && !words->text.empty())
            out.emplace_back(*words);
    return out;
}

/// Texts of a page that lie over others or leave it, each in words.
std::vector<std::string> overprinted(const VectorPage& page) {
    std::vector<std::string> out;
    const std::vector<TextBox> texts = textsOn(page);
    for (std::size_t i = 0; i < texts.size(); ++i) {
        const double slack = 0.1 * texts[i].size;
        const glm::dvec2 lo = texts[i].lo() + slack, hi = texts[i].hi() - slack;
        if (lo.x < 0 || lo.y < 0 || hi.x > page.size.x || hi.y > page.size.y)
            out.push_back("\"" + texts[i].text + "\" leaves the page");
        for (std::size_t k = i + 1; k < texts.size(); ++k)
            if (cover(texts[i], texts[k])) out.push_back("\"" + texts[i].text + "\" over \"" + texts[k].text + "\"");
    }
    return out;
}

/// Soon computed, and otherwise as users have it.
Opened pagesOf(volume::Dataset data) {
    Opened opened;
    opened.source = opened.numbers = volume::makeMemorySource(std::move(data), {});
    DataRef named;
    named.model = "fuel-cell"; // has no file
    opened.document.session = defaultSession(opened.source->info(), named);
    opened.document.session.views.clear();
    opened.document.session.render.samples = 1;
    forEachViewKind([&]<class Kind>(const Kind&) {
        opened.document.session.views[std::string(Kind::State::kType)] = typename Kind::State{};
    });
    opened.document.history.reset(opened.document.session);
    return opened;
}

Opened cellPages() {
    return pagesOf(volume::makeModel("fuel-cell", {{"nx", 9}, {"ny", 13}, {"nz", 17}, {"times", 3}}));
}

Opened longNamePages() {
    volume::Dataset data = volume::makeModel("fuel-cell", {{"nx", 9}, {"ny", 13}, {"nz", 17}, {"times", 3}});
    for (volume::Parameter& each : data.info.parameters)
        if (!each.categorical) each.name = "Molar concentration of species " + each.name + " in the gas phase";
    return pagesOf(std::move(data));
}

/// A preset, at a resolution at which pictures are soon drawn; that of a screen smaller with its text.
PictureForm presetForm(std::string_view preset) {
    PictureForm form;
    form.size = *PictureSize::preset(preset);
    form.ground = PictureGround::White;
    if (form.size.onPaper()) {
        form.size.dpi = preset == "poster" ? 50 : 150;
    } else {
        form.size.width /= 2, form.size.height /= 2, form.size.scale /= 2;
    }
    return form;
}

class PageTexts : public testing::TestWithParam<std::string_view> {
protected:
    static void SetUpTestSuite() {
        cell = new Opened(cellPages());
        longNames = new Opened(longNamePages());
        maker = new PictureMaker({.openGl = false});
    }
    static void TearDownTestSuite() {
        delete maker;
        delete longNames;
        delete cell;
    }
    static std::vector<std::string> kinds() {
        std::vector<std::string> out;
        forEachViewKind([&]<class Kind>(const Kind& kind) {
            if (kind.traits.figure || kind.traits.inSpace) out.emplace_back(Kind::State::kType);
        });
        return out;
    }
    static VectorPage page(const Opened& opened, const std::vector<std::string>& panes) {
        PictureRequest request = pictureRequest(presetForm(GetParam()), panes.size() == 1 ? panes[0] : "");
        if (panes.size() > 1) request.panels = panes;
        return maker->page(opened.document, opened.sources(), request);
    }
    /// Figures of so many panels that have every kind of view, each once at least.
    static std::vector<std::vector<std::string>> figures(std::size_t panels) {
        const std::vector<std::string> all = kinds();
        std::vector<std::vector<std::string>> out;
        for (std::size_t first = 0; first < all.size(); first += panels) {
            out.emplace_back();
            for (std::size_t i = 0; i < panels; ++i) out.back().push_back(all[(first + i) % all.size()]);
        }
        return out;
    }
    static inline Opened* cell = nullptr;
    static inline Opened* longNames = nullptr;
    static inline PictureMaker* maker = nullptr;
};

TEST_P(PageTexts, LieOverNoOthersAndOnThePage) {
    for (const Opened* const opened : {cell, longNames})
        for (const std::size_t panels :
             opened == cell ? std::vector<std::size_t>{1, 2, 4} : std::vector<std::size_t>{1, 4})
            for (const std::vector<std::string>& panes : figures(panels)) {
                std::string named = opened == cell ? "cell" : "long names";
                for (const std::string& pane : panes) named += " " + pane;
                try {
                    for (const std::string& found : overprinted(page(*opened, panes))) {
                        // A title of the slice matrix still reaches over the edge there.
                        if (GetParam() == "poster" && panels > 1 && found.ends_with("leaves the page")) continue;
                        ADD_FAILURE() << named << ": " << found;
                    }
                } catch (const Error& error) {
                    ADD_FAILURE() << named << ": " << error.what();
                }
            }
}

// A picture on white is made beside the window, whose texts stay legible on its own ground.
TEST(PicturesOnWhite, LeaveTheThemeOfTheWindowAlone) {
    const Gui window(vis::TexturesIn::Memory);
    applyTheme(Theme::Dark, 1);
    const ImU32 text = palette().text, panel = palette().panel;
    Opened cell = cellPages();
    cell.document.session.appearance.theme = Theme::Dark;
    PictureForm form = presetForm("oneColumn");
    PictureMaker maker({.openGl = false});
    for (const PictureGround ground : {PictureGround::White, PictureGround::Shown}) {
        form.ground = ground;
        (void)maker.page(cell.document, cell.sources(), pictureRequest(form, "histogram"));
        EXPECT_TRUE(darkTheme());
        EXPECT_EQ(palette().text, text);
        EXPECT_EQ(palette().panel, panel);
    }
}

INSTANTIATE_TEST_SUITE_P(Presets, PageTexts, testing::ValuesIn(PictureSize::kPresetNames),
                         [](const auto& preset) { return std::string(preset.param); });

} // namespace
} // namespace tessera::app
