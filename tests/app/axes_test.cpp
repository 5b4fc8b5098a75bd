#include "app/pane/axes3d.h"
#include "app/ui/theme.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"

#include <algorithm>
#include <array>

/// Axes and the triad of pictures in space, and the lines of the cross-hair.
namespace tessera::app {
namespace {

const volume::Box kBox{{0, 0, 0}, {4, 4, 4}};
const AxisLabels kLabels{AxisLabel{.name = "x", .unit = {"mm", 1}}, AxisLabel{.name = "y", .unit = {"mm", 1}},
                         AxisLabel{.name = "z", .unit = {"mm", 1}}};

class AxesTest : public FedImGui {
protected:
    AxesTest() : FedImGui({800, 600}) {}
    void SetUp() override {
        loadFonts(1);
        applyTheme(Theme::Dark, 1);
    }
    static std::vector<DrawnText> called(const std::string& text) {
        std::vector<DrawnText> out = drawnTexts();
        std::erase_if(out, [&](const DrawnText& each) { return each.text != text; });
        return out;
    }
};

TEST_F(AxesTest, AnAxisWithoutRoomBesideItHasItsTitleBeyondItsEnd) {
    vis::Camera camera = vis::planeCamera(0, 1, vis::worldFrame(kBox, glm::dvec3(1)));
    camera.distance *= 1.08f; // it nearly fills the height
    const auto draw = [&](ImVec2 max, const std::vector<std::pair<ImVec2, ImVec2>>& taken) {
        feedWindow([&] {
            const SpaceFrame frame = spaceFrame({0, 0}, max, camera, kBox, glm::dvec3(1));
            drawAxes3d(*ImGui::GetWindowDrawList(), frame, camera, kLabels, taken);
        });
    };
    const float em = ImGui::GetIO().Fonts->Fonts[0]->FontSize;
    draw({800, 500}, {}); // the box from 169 to 631 and 19 to 481: nothing below, room at both sides
    const auto titles = called("x [mm]");
    ASSERT_EQ(titles.size(), 1u);
    EXPECT_GT(titles[0].min.x, 631);
    EXPECT_LT(titles[0].min.x, 631 + 2 * em);
    EXPECT_NEAR(titles[0].middle().y, 481, em / 2);
    const auto upright = called("y [mm]");
    ASSERT_EQ(upright.size(), 1u);
    EXPECT_LT(upright[0].max.x, 169) << "there is room beside it";
    EXPECT_NEAR(upright[0].middle().y, 250, em);
    camera.distance *= 1.08f;                                           // from 186 to 614 and 36 to 464
    draw({800, 500}, {{{0, 40}, {185, 500}}, {{615, 40}, {800, 500}}}); // none beside it on either side
    const auto above = called("y [mm]");
    ASSERT_EQ(above.size(), 1u);
    EXPECT_LT(above[0].max.y, 36) << "beyond its end";
    EXPECT_NEAR(above[0].middle().x, 186, em / 2);
}

// At an end where it has no room it would be moved over the edge of the box.
TEST_F(AxesTest, ATitleGoesToTheEndOfItsAxisThatHasRoom) {
    vis::Camera camera = vis::planeCamera(0, 1, vis::worldFrame(kBox, glm::dvec3(1)));
    camera.distance *= 1.08f; // nothing below it
    for (const float side : {1.0f, -1.0f}) {
        camera.target.x = -0.1f * side;
        std::array<float, 2> box{};
        feedWindow([&] {
            const SpaceFrame frame = spaceFrame({0, 0}, {560, 500}, camera, kBox, glm::dvec3(1));
            box = {frame.pixel({0, 0, 2})->x, frame.pixel({4, 0, 2})->x};
            drawAxes3d(*ImGui::GetWindowDrawList(), frame, camera, kLabels, {});
        });
        const auto titles = called("x [mm]");
        ASSERT_EQ(titles.size(), 1u);
        EXPECT_LT(side > 0 ? 560 - box[1] : box[0], titles[0].max.x - titles[0].min.x) << "no room here";
        if (side > 0)
            EXPECT_LT(titles[0].max.x, box[0]);
        else
            EXPECT_GT(titles[0].min.x, box[1]);
    }
}

// A legend in a small picture may lie where the numbers of an axis would be: they go to another edge of the box.
TEST_F(AxesTest, AnAxisIsLabelledAtAnEdgeThatHasRoom) {
    vis::Camera camera = vis::planeCamera(0, 1, vis::worldFrame(kBox, glm::dvec3(1)));
    camera.distance *= 1.5f; // from 233 to 567 and 83 to 417
    const auto numbers = [&](const Rectangles& taken) {
        feedWindow([&] {
            const SpaceFrame frame = spaceFrame({0, 0}, {800, 500}, camera, kBox, glm::dvec3(1));
            drawAxes3d(*ImGui::GetWindowDrawList(), frame, camera, kLabels, taken);
        });
        std::array<int, 4> beside{}; // below, above, left, right
        for (const DrawnText& text : drawnTexts()) {
            if (text.text != "2.0") continue;
            const ImVec2 at = text.middle();
            ++beside[at.y > 417 ? 0 : at.y < 83 ? 1 : at.x < 233 ? 2 : 3];
        }
        return beside;
    };
    EXPECT_EQ(numbers({}), (std::array<int, 4>{1, 0, 1, 0}));
    EXPECT_EQ(numbers({{{300, 420}, {800, 500}}}), (std::array<int, 4>{0, 1, 1, 0})) << "most of the lower edge";
    EXPECT_EQ(numbers({{{0, 60}, {228, 440}}}), (std::array<int, 4>{1, 0, 0, 1}));
    EXPECT_EQ(numbers({{{540, 420}, {800, 500}}}), (std::array<int, 4>{1, 0, 1, 0})) << "little of it";
}

TEST_F(AxesTest, NumbersBesideTheBoxCoverWhatLiesThere) {
    vis::Camera camera = vis::planeCamera(0, 1, vis::worldFrame(kBox, glm::dvec3(1)));
    camera.distance *= 1.5f; // from 233 to 567 and 83 to 417
    feedWindow([&] {
        const SpaceFrame frame = spaceFrame({0, 0}, {800, 500}, camera, kBox, glm::dvec3(1));
        EXPECT_EQ(coveredByAxes(frame, camera, {300, 420}, {500, 420 + em()}), 1) << "those of x";
        EXPECT_EQ(coveredByAxes(frame, camera, {230 - em(), 200}, {230, 300}), 1) << "those of y";
        EXPECT_EQ(coveredByAxes(frame, camera, {300, 100}, {500, 400}), 0) << "the box itself";
        EXPECT_EQ(coveredByAxes(frame, camera, {300, 0}, {800, 80}), 0);
        EXPECT_NEAR(coveredByAxes(frame, camera, {310, 420}, {490, 420 + 10 * em()}), 0.3, 0.06) << "with their title";
    });
}

TEST_F(AxesTest, ACornerIsCoveredAsFarAsTheBoxReachesIntoIt) {
    const vis::Camera camera = vis::planeCamera(0, 1, vis::worldFrame(kBox, glm::dvec3(1)));
    const SpaceFrame frame =
        spaceFrame({0, 0}, {800, 500}, camera, kBox, glm::dvec3(1)); // the whole height: 150 to 650
    EXPECT_EQ(coveredByBox(frame, {0, 0}, {140, 500}), 0);
    EXPECT_EQ(coveredByBox(frame, {200, 100}, {300, 200}), 1);
    EXPECT_NEAR(coveredByBox(frame, {600, 100}, {700, 200}), 0.5, 0.07);
    vis::Camera turned = camera; // a corner up, which hides no corner of the picture
    turned.orientation = glm::normalize(glm::quat(0.92f, 0, 0, 0.38f) * turned.orientation);
    turned.distance *= 1.5f;
    const SpaceFrame diamond = spaceFrame({0, 0}, {500, 500}, turned, kBox, glm::dvec3(1));
    EXPECT_EQ(coveredByBox(diamond, {0, 0}, {120, 120}), 0) << "the box, not the rectangle around it";
    EXPECT_EQ(coveredByBox(diamond, {220, 220}, {280, 280}), 1);
    vis::Camera inside;
    inside.distance = 0.01f;
    EXPECT_EQ(coveredByBox(spaceFrame({0, 0}, {500, 500}, inside, kBox, glm::dvec3(1)), {0, 0}, {10, 10}), 1);
}

TEST_F(AxesTest, TheTriadNamesTheEndsAndAClickLooksAgainstThem) {
    const ImVec2 center{300, 300};
    const float radius = 80;
    vis::Camera camera;
    std::optional<vis::StandardView> chosen;
    const auto draw = [&](const ImVec2* at, bool clicked) {
        feedWindow(
            [&] { chosen = drawTriad(*ImGui::GetWindowDrawList(), center, radius, camera, kLabels, at, clicked); });
    };
    const auto place = [&](int axis, float sign) {
        glm::vec3 direction(0);
        direction[axis] = sign;
        const glm::vec3 eye = camera.orientation * direction;
        return ImVec2{center.x + eye.x * radius * 0.9f, center.y - eye.y * radius * 0.9f};
    };
    for (const vis::StandardView from :
         {vis::StandardView::Isometric, vis::StandardView::Front, vis::StandardView::Top, vis::StandardView::Left}) {
        camera.orientation = vis::standardOrientation(from);
        draw(nullptr, false);
        EXPECT_FALSE(chosen);
        for (int axis = 0; axis < 3; ++axis) {
            const auto names = called(kLabels[std::size_t(axis)].name);
            ASSERT_EQ(names.size(), 1u);
            const ImVec2 at = place(axis, 1);
            EXPECT_NEAR(names[0].middle().x, at.x, 5) << axis;
            EXPECT_NEAR(names[0].middle().y, at.y, 5) << axis;
        }
    }
    camera.orientation = glm::quat(0.9f, 0.25f, 0.3f, 0.1f);
    camera.orientation = glm::normalize(camera.orientation);
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {1.0f, -1.0f}) {
            const ImVec2 at = place(axis, sign);
            draw(&at, false);
            EXPECT_FALSE(chosen) << "only under the mouse";
            draw(&at, true);
            ASSERT_TRUE(chosen);
            const glm::vec3 toViewer = glm::inverse(vis::standardOrientation(*chosen)) * glm::vec3(0, 0, 1);
            EXPECT_NEAR(toViewer[axis], sign, 1e-5) << "the end that was clicked points to the viewer";
        }
    const ImVec2 away{center.x + 2 * radius, center.y};
    draw(&away, true);
    EXPECT_FALSE(chosen);
}

TEST_F(AxesTest, TheCrossHairHasNoLineThatEndsBehindTheEye) {
    const ImU32 ink = (plotColors().cursor & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 90);
    vis::Camera camera;
    camera.orientation = vis::standardOrientation(vis::StandardView::Front);
    const auto lines = [&](float distance) {
        camera.distance = distance;
        feedWindow([&] {
            drawCursor3d(*ImGui::GetWindowDrawList(), spaceFrame({0, 0}, {600, 600}, camera, kBox, glm::dvec3(1)),
                         {1, 1.5, 0.5});
        });
        return drawnIn(ink).size();
    };
    const std::size_t all = lines(3), within = lines(0.2f);
    ASSERT_GT(all, 0u);
    EXPECT_EQ(within * 3, all * 2) << "one of three leads past the eye";
}

} // namespace
} // namespace tessera::app
