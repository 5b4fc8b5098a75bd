#include "app/tools/space_handles.h"
#include "app/ui/keys.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace tessera::app {
namespace {

/// A picture of 400 x 300 pixels of a box of 2 x 1 x 1, seen along -z in parallel projection, driven by a fed mouse.
class SpaceHandles : public testing::Test {
protected:
    void SetUp() override {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.DisplaySize = {500, 400};
        io.IniFilename = nullptr;
        setUpKeys(io);
        unsigned char* pixels;
        int width, height;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
        info.bounds = {glm::dvec3(0), {2, 1, 1}};
        session.camera.orientation = glm::quat(1, 0, 0, 0);
        session.camera.projection = vis::Projection::Orthographic;
        session.cursor = {1, 0.5, 0.5};
        frame();
        frame();
    }
    void TearDown() override { ImGui::DestroyContext(); }

    SpaceFrame space() const { return spaceFrame({50, 50}, {450, 350}, session.camera, info.bounds, session.stretch); }
    void frame() {
        ImGuiIO& io = ImGui::GetIO();
        io.DeltaTime = 1.0f / 60;
        io.MousePos = mouse;
        ImGui::NewFrame();
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({500, 400});
        ImGui::Begin("test", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
        ImGui::SetCursorScreenPos({50, 50});
        ImGui::InvisibleButton("picture", {400, 300});
        if (slice) {
            // x to the right, y up; the frame's values are centimetres.
            const PlaneFrame cut{{{50, 50}, {450, 350}, {0, 200}, {0, 100}},
                                 page,
                                 glm::dvec2(100),
                                 vis::worldFrame(info, session.stretch),
                                 info.bounds};
            edited = editHandles(drag, session, info, cut, ImGui::IsItemHovered());
            drawHandles(*ImGui::GetWindowDrawList(), drag, cut, session, info);
        } else {
            edited = editHandles(drag, session, info, space(), ImGui::IsItemHovered());
            drawHandles(*ImGui::GetWindowDrawList(), drag, space(), session, info);
        }
        ImGui::End();
        ImGui::Render();
    }
    void dragBy(ImVec2 from, ImVec2 by, bool escape = false) {
        mouse = from;
        frame();
        ImGui::GetIO().MouseDown[0] = true;
        frame();
        mouse = {from.x + by.x, from.y + by.y};
        frame();
        moved = edited;
        if (escape) {
            feedKey(ImGui::GetIO(), key::kEscape, true);
            frame();
            EXPECT_TRUE(edited) << "the picture is to be drawn anew";
            feedKey(ImGui::GetIO(), key::kEscape, false);
        }
        ImGui::GetIO().MouseDown[0] = false;
        frame();
    }
    ImVec2 pixelOf(glm::dvec3 physical) const { return *space().pixel(physical); }
    /// Pixels of a physical length across the picture.
    double pixels(double length) const { return double(pixelOf({length, 0, 0}).x - pixelOf({0, 0, 0}).x); }
    vis::FlowLayer& rake(volume::SeedShape shape, glm::vec3 from, glm::vec3 to) {
        vis::FlowLayer flow;
        flow.seeds = shape;
        flow.from = from;
        flow.to = to;
        session.layers = {{"rake", true, flow}};
        return std::get<vis::FlowLayer>(session.layers[0].technique);
    }

    Session session;
    volume::DatasetInfo info;
    HandleDrag drag;
    ImVec2 mouse{0, 0};
    PicturePlane page = planeAcross(0, 1, 2, 0.5); ///< of slices
    bool slice = false, edited = false;
    bool moved = false; ///< the drag changed the session, as it said
};

TEST_F(SpaceHandles, EndsOfALineMoveAlone) {
    const vis::FlowLayer& flow = rake(volume::SeedShape::Line, {0.2f, 0.3f, 0.5f}, {0.6f, 0.7f, 0.5f});
    dragBy(pixelOf({1.2, 0.7, 0.5}), {float(pixels(0.2)), 0});
    EXPECT_NEAR(flow.to.x, 0.7f, 0.01f);
    EXPECT_NEAR(flow.to.y, 0.7f, 0.01f);
    EXPECT_EQ(flow.from, glm::vec3(0.2f, 0.3f, 0.5f));
    EXPECT_FALSE(drag.active);
    EXPECT_TRUE(moved) << "the mouse does nothing else meanwhile";
}

TEST_F(SpaceHandles, TheMiddleMovesTheWholeAndStaysInside) {
    const vis::FlowLayer& flow = rake(volume::SeedShape::Random, {0.1f, 0.2f, 0.4f}, {0.3f, 0.6f, 0.6f});
    dragBy(pixelOf({0.4, 0.4, 0.5}), {float(pixels(0.4)), 0});
    EXPECT_NEAR(flow.from.x, 0.3f, 0.01f);
    EXPECT_NEAR(flow.to.x, 0.5f, 0.01f);
    EXPECT_NEAR(flow.to.y - flow.from.y, 0.4f, 1e-4f);
    dragBy(pixelOf({0.8, 0.4, 0.5}), {2000, 0});
    EXPECT_NEAR(flow.to.x, 1, 1e-5f);
    EXPECT_NEAR(flow.from.x, 0.8f, 1e-4f) << "keeps its size at the wall";
}

TEST_F(SpaceHandles, BallsGrowAroundTheirMiddle) {
    const vis::FlowLayer& flow = rake(volume::SeedShape::Sphere, {0.4f, 0.3f, 0.3f}, {0.6f, 0.7f, 0.7f});
    dragBy(pixelOf({1.2, 0.5, 0.5}), {float(pixels(0.2)), 0});
    EXPECT_NEAR(flow.from.x, 0.3f, 0.01f);
    EXPECT_NEAR(flow.to.x, 0.7f, 0.01f);
    EXPECT_EQ(flow.from.y, 0.3f);
}

TEST_F(SpaceHandles, PlanesHaveCorners) {
    const vis::FlowLayer& flow = rake(volume::SeedShape::Plane, {0.25f, 0.2f, 0.5f}, {0.75f, 0.8f, 0.6f});
    // Thin along z: the corner at the upper end of x and the lower end of y.
    dragBy(pixelOf({1.5, 0.2, 0.55}), {float(-pixels(0.3)), float(-pixels(0.1))});
    EXPECT_NEAR(flow.to.x, 0.6f, 0.01f);
    EXPECT_NEAR(flow.from.y, 0.3f, 0.01f);
    EXPECT_EQ(flow.from.x, 0.25f);
    EXPECT_EQ(flow.to.y, 0.8f);
}

TEST_F(SpaceHandles, EscapeTakesADragBack) {
    const vis::FlowLayer& flow = rake(volume::SeedShape::Line, {0.2f, 0.3f, 0.5f}, {0.6f, 0.7f, 0.5f});
    dragBy(pixelOf({1.2, 0.7, 0.5}), {60, 30}, true);
    EXPECT_NEAR(flow.to.x, 0.6f, 1e-5f);
    EXPECT_NEAR(flow.to.y, 0.7f, 1e-5f);
}

TEST_F(SpaceHandles, BrushesMoveAndGrowInSpaceAndSlices) {
    vis::Brush brush;
    brush.region = vis::SphereRegion{.center = {1, 0.5, 0.5}, .radius = glm::dvec3(0.2)};
    session.selection.brushes = {brush};
    const auto& ball = std::get<vis::SphereRegion>(session.selection.brushes[0].region);
    dragBy(pixelOf({1, 0.5, 0.5}), {float(pixels(0.3)), 0});
    EXPECT_NEAR(ball.center.x, 1.3, 0.01);
    dragBy(pixelOf({1.3, 0.7, 0.5}), {0, float(-pixels(0.1))}); // upwards
    EXPECT_NEAR(ball.radius.y, 0.3, 0.01);
    EXPECT_EQ(ball.radius.x, 0.2);
    slice = true;
    dragBy({50 + 1.3f * 200, 350 - 0.5f * 300}, {-40, 30}); // 200 pixels a metre across, 300 upwards
    EXPECT_NEAR(ball.center.x, 1.1, 0.01);
    EXPECT_NEAR(ball.center.y, 0.4, 0.01);
    EXPECT_EQ(ball.center.z, 0.5);
}

TEST_F(SpaceHandles, ASliceHasNoDotsOfItsOwnPlane) {
    ObliqueView view;
    view.normal = {0, 0, 1};
    session.views["oblique"] = view;
    slice = true;
    const glm::dvec3 cursor = session.cursor;
    dragBy({50 + 1.0f * 200, 350 - 0.5f * 300}, {40, 30});
    EXPECT_EQ(session.cursor, cursor);
    EXPECT_FALSE(moved);
    std::get<ObliqueView>(session.views["oblique"]).normal = {1, 0, 0};
    dragBy({50 + 1.0f * 200, 350 - 0.5f * 300}, {40, 30});
    EXPECT_TRUE(moved) << "another plane has them";
    EXPECT_NEAR(session.cursor.x, 1.2, 0.01);
}

TEST_F(SpaceHandles, ProfileLinesBecomeTheirOwn) {
    session.views["profile"] = ProfileView{};
    const auto& profile = std::get<ProfileView>(session.views["profile"]);
    ASSERT_TRUE(profile.points.empty());
    dragBy(pixelOf({2, 0.5, 0.5}), {float(-pixels(0.4)), float(-pixels(0.2))});
    ASSERT_EQ(profile.points.size(), 2u);
    EXPECT_NEAR(profile.points[1].x, 1.6, 0.01);
    EXPECT_NEAR(profile.points[1].y, 0.7, 0.01);
    EXPECT_EQ(profile.points[0], glm::dvec3(0, 0.5, 0.5));
}

TEST_F(SpaceHandles, ElsewhereTheMouseIsFree) {
    rake(volume::SeedShape::Random, glm::vec3(0), glm::vec3(1));
    const Session before = session;
    dragBy(pixelOf({1, 0.5, 0.5}), {30, 10}); // the whole data cannot be moved: no dot in its middle
    EXPECT_TRUE(session == before);
    EXPECT_FALSE(moved);
}

} // namespace
} // namespace tessera::app
