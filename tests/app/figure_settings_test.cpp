#include "app/drawing/panels.h"
#include "app/pages/plot_page.h"
#include "app/platform/fitted_camera.h"
#include "app/session/session_json.h"
#include "app/ui/ticks.h"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// What users set of figures: captions and numbers of axes, a title, what fills the picture.
namespace tessera::app {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Not;

std::vector<std::string> wordsOn(const VectorPage& page) {
    std::vector<std::string> out;
    for (const shapes::Mark& mark : page.marks)
        if (const auto* const words = std::get_if<shapes::Words>(&mark.shape)) out.push_back(words->text);
    return out;
}

TEST(FigureSettings, CaptionsStandInPlaceOfNames) {
    const FigureSettings settings{.title = "", .captions = " z = along the channel; T=temperature ;O2 ="};
    EXPECT_EQ(captionOf(settings, "z"), "along the channel");
    EXPECT_EQ(captionOf(settings, "T"), "temperature");
    EXPECT_EQ(captionOf(settings, "O2"), "O2") << "an empty caption is none";
    EXPECT_EQ(captionOf(settings, "x"), "x");
    Plot plot;
    plot.x = {"z", {0, 4}, true, "mm"};
    plot.y = {"T", {300, 400}, true, "K"};
    const auto words = wordsOn(plotPage({plot}, 1, {.size = {300, 200}, .figure = settings}));
    EXPECT_THAT(words, Contains("along the channel [mm]"));
    EXPECT_THAT(words, Contains("temperature [K]"));
    EXPECT_THAT(words, Not(Contains("z [mm]")));
}

TEST(FigureSettings, NumbersOfAxesAreFewerAndWrittenAsAsked) {
    const Range range{0, 0.001};
    EXPECT_THAT(styledTickLabels(range, 2, true, {}).note, Not(testing::IsEmpty()));
    const TickLabels decimals = styledTickLabels(range, 2, true, {.numbers = TickNumbers::Decimals, .decimals = 4});
    EXPECT_THAT(decimals.texts, ElementsAre("0.0000", "0.0005", "0.0010"));
    EXPECT_EQ(decimals.note, "") << "they are in full";
    EXPECT_THAT(styledTickLabels(range, 2, true, {.numbers = TickNumbers::Exponents, .decimals = 1}).texts,
                ElementsAre("0.0e0", "5.0e-4", "1.0e-3"));
    const auto narrow = [](const std::string&) { return 1.0; };
    EXPECT_GT(fittingTicks({0, 10}, 1000, 1, true, narrow).values.size(), 5u);
    EXPECT_EQ(fittingTicks({0, 10}, 1000, 1, true, narrow, {.most = 2}).values.size(), 3u);
}

TEST(FigureSettings, AreInTheSession) {
    Session session;
    session.figure = {
        .title = "Least O2", .captions = "z = channel", .ticks = {3, TickNumbers::Exponents, 1}, .fit = true};
    EXPECT_EQ(sessionFromJson(toJson(session), "test").figure, session.figure);
}

TEST(FigureSettings, ATitleTakesItsOwnRoom) {
    VectorPage page;
    page.size = {100, 50};
    page.marks.push_back({shapes::Words{.text = "below", .at = {10, 9}}});
    const std::string title = "Oxygen at the membrane under load";
    const VectorPage titled = titledPage(page, title, 10, glm::vec4(1), glm::vec4(0, 0, 0, 1));
    EXPECT_DOUBLE_EQ(titled.size.y, 50 + titleHeight(title, 100, 10));
    double lowest = 0, below = 0;
    std::string read;
    for (const shapes::Mark& mark : titled.marks)
        if (const auto* const words = std::get_if<shapes::Words>(&mark.shape)) {
            if (words->text == "below") {
                below = words->at.y;
                continue;
            }
            read += (read.empty() ? "" : " ") + words->text;
            lowest = std::max(lowest, words->at.y);
            EXPECT_LE(textWidth(words->text, words->face) * words->size, 100);
        }
    EXPECT_EQ(read, title) << "nothing is cut off";
    EXPECT_GT(below - 10, lowest);
}

TEST(FigureSettings, TheCameraMovesToWhatIsSeen) {
    vis::Image image{{80, 40}, std::vector<std::uint8_t>(80 * 40 * 4, 255)};
    EXPECT_FALSE(seenExtent(image));
    for (int y = 10; y < 20; ++y)
        for (int x = 60; x < 80; ++x) image.rgba[std::size_t(y * 80 + x) * 4] = 0;
    const auto seen = seenExtent(image);
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->lo, glm::dvec2(0.5, 0));
    EXPECT_EQ(seen->hi, glm::dvec2(1, 0.5));
    // A quarter of the width in a corner fills nine tenths of the picture, in parallel projection exactly.
    vis::Camera camera;
    camera.projection = vis::Projection::Orthographic;
    const auto placeOf = [&](const vis::Camera& of, glm::dvec3 world) {
        const glm::dvec4 clip = vis::projectionMatrix(of, 2) * vis::viewMatrix(of) * glm::dvec4(world, 1);
        return glm::dvec2(clip) / clip.w;
    };
    const glm::dvec3 corner = vis::cameraRay(camera, 2, {1, 0.5}).origin,
                     middle = vis::cameraRay(camera, 2, {0.75, 0.25}).origin;
    fitToSeen(camera, *seen, 2);
    EXPECT_NEAR(placeOf(camera, middle).x, 0, 1e-5);
    EXPECT_NEAR(placeOf(camera, middle).y, 0, 1e-5);
    EXPECT_NEAR(placeOf(camera, corner).x, 0.9, 1e-5);
    EXPECT_NEAR(placeOf(camera, corner).y, 0.9, 1e-5);
}

} // namespace
} // namespace tessera::app
