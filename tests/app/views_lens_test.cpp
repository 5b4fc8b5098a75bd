#include "app/tools/lens_edit.h"
#include "app/tools/lens_list.h"
#include "app/tools/lens_outline.h"
#include "app/tools/plane_sections.h"
#include "tests/app/fed_imgui.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::app {
namespace {

/// A picture of 400 x 300 pixels of a box of 2 x 1 x 1 with a lens in its middle, driven by a fed mouse.
class LensEdit : public FedImGui {
protected:
    LensEdit() : FedImGui({500, 400}) {}
    void SetUp() override {
        session.camera.orientation = glm::quat(1, 0, 0, 0); // along -z, x to the right
        session.camera.projection = vis::Projection::Orthographic;
        session.cursor = {0.5, 0.5, 0.5};
        session.lenses = {{.name = "a", .center = {1, 0.5, 0.5}, .size = {0.2f, 0.1f, 0.15f}}};
        frame();
        frame();
    }

    SpaceFrame space() const {
        return spaceFrame({50, 50}, {450, 350}, session.camera, {glm::dvec3(0), {2, 1, 1}}, session.stretch);
    }
    vis::PlacedLens placed() const {
        return vis::placeLenses(session.lenses, space().world, session.camera, session.cursor).back();
    }
    LensHandles handles() const { return lensHandles(space(), placed()); }
    void frame() {
        feedWindow([&] {
            surface({50, 50}, {450, 350});
            taken = editLenses(drag, session, space(), ImGui::IsItemHovered());
            if (follow) followed = followPointer(session, space(), ImGui::IsItemHovered());
            drawLenses(*ImGui::GetWindowDrawList(), space(), session, drag.lens);
            drawLensHandles(*ImGui::GetWindowDrawList(), drag, space(), session);
        });
    }
    void moveTo(ImVec2 at) {
        mouse = at;
        frame();
    }
    void button(int which, bool down) {
        ImGui::GetIO().MouseDown[which] = down;
        frame();
    }
    void dragBy(ImVec2 from, ImVec2 by, int which = 0) {
        moveTo(from);
        button(which, true);
        moveTo({from.x + by.x / 2, from.y + by.y / 2});
        moveTo({from.x + by.x, from.y + by.y});
        button(which, false);
    }
    void hold(bool alt, bool shift = false) { feedModifiers(ImGui::GetIO(), false, shift, alt); }
    const vis::Lens& lens() const { return session.lenses.back(); }

    Session session;
    LensDrag drag;
    bool taken = false, follow = false, followed = false;
};

TEST_F(LensEdit, TheMiddleMovesUnderTheMouse) {
    const ImVec2 from = *handles().middle;
    dragBy(from, {40, -20});
    const ImVec2 to = *handles().middle;
    EXPECT_NEAR(to.x, from.x + 40, 0.1);
    EXPECT_NEAR(to.y, from.y - 20, 0.1);
    EXPECT_EQ(lens().center.z, 0.5) << "in the plane that faces the viewer";
    EXPECT_FALSE(drag.active);
    hold(false, true);
    dragBy(to, {0, -10}); // pushed away
    hold(false);
    EXPECT_LT(lens().center.z, 0.45);
    dragBy(*handles().middle, {-2000, 0});
    EXPECT_EQ(lens().center.x, 0) << "stays in the box";
}

TEST_F(LensEdit, SquaresResizeAndKeepTheShape) {
    dragBy(*handles().axes[0], {0.5f * (handles().axes[0]->x - handles().middle->x), 0});
    EXPECT_NEAR(lens().size.x, 0.3f, 0.005f);
    EXPECT_NEAR(lens().size.y, 0.15f, 0.003f) << "round lenses grow in all directions";
    session.lenses[0].shape = vis::LensShape::Box;
    const glm::vec3 before = lens().size;
    dragBy(*handles().axes[1], {0, 0.25f * (handles().axes[1]->y - handles().middle->y)});
    EXPECT_NEAR(lens().size.y, before.y * 1.25f, 0.005f);
    EXPECT_EQ(lens().size.x, before.x);
    EXPECT_FALSE(handles().axes[2]) << "points at the viewer";
}

TEST_F(LensEdit, OnlyTheWayAlongItsAxisMovesASquare) {
    session.lenses[0].shape = vis::LensShape::Box;
    session.lenses[0].rotation = {0, 0, 30};
    frame();
    const ImVec2 end = *handles().axes[0], middle = *handles().middle, way{end.x - middle.x, end.y - middle.y};
    dragBy(end, {-0.5f * way.y, 0.5f * way.x}); // across
    EXPECT_NEAR(lens().size.x, 0.2f, 0.004f);
    dragBy(*handles().axes[0], {0.5f * way.x, 0.5f * way.y});
    EXPECT_NEAR(lens().size.x, 0.3f, 0.006f);
}

TEST_F(LensEdit, TheRingTurnsLikeABall) {
    const ImVec2 at = *handles().turn;
    moveTo(*handles().middle);
    dragBy({std::floor(at.x), std::floor(at.y)}, {45, 0});
    const glm::dvec3 x = glm::normalize(placed().fromUnit[0]);
    EXPECT_NEAR(x.x, std::cos(45 * 4 / 300.0), 1e-4);
    EXPECT_NEAR(std::abs(x.z), std::sin(45 * 4 / 300.0), 1e-4);
    EXPECT_NEAR(glm::length(placed().fromUnit[1]), 0.1, 1e-6);
    EXPECT_EQ(lens().center, glm::dvec3(1, 0.5, 0.5));
}

TEST_F(LensEdit, AltWorksAnywhereInsideAndElsewhereTheMouseIsFree) {
    const ImVec2 inside{handles().middle->x + 20, handles().middle->y + 5};
    dragBy(inside, {30, 0});
    EXPECT_EQ(lens().center.x, 1) << "without Alt the picture is turned";
    hold(true);
    dragBy(inside, {30, 0});
    EXPECT_GT(lens().center.x, 1.05);
    moveTo(*handles().middle);
    ImGui::GetIO().MouseWheel = 1;
    frame();
    EXPECT_TRUE(taken);
    EXPECT_NEAR(lens().size.x, 0.22f, 1e-4f);
    dragBy(*handles().middle, {0, 37.5f}, 1);
    EXPECT_GT(std::abs(lens().rotation.x), 5) << "the right button turns";
    hold(false);
    moveTo({60, 60});
    EXPECT_FALSE(taken);
    EXPECT_EQ(drag.lens, -1);
}

TEST_F(LensEdit, EscapeTakesTheDragBackAndFollowersTakeTheCursorAlong) {
    moveTo(*handles().middle);
    button(0, true);
    moveTo({mouse.x + 50, mouse.y});
    EXPECT_GT(lens().center.x, 1.1);
    feedKey(ImGui::GetIO(), key::kEscape, true);
    frame();
    feedKey(ImGui::GetIO(), key::kEscape, false);
    button(0, false);
    EXPECT_EQ(lens().center.x, 1);
    session.lenses[0].followsCursor = true;
    dragBy(*handles().middle, {30, 0});
    EXPECT_GT(session.cursor.x, 0.55);
    EXPECT_EQ(lens().center.x, 1);
}

TEST_F(LensEdit, TheTopmostLensIsTaken) {
    session.lenses.push_back(lens());
    session.lenses.back().name = "b";
    EXPECT_EQ(lensUnder(space(), session, *handles().middle), 1);
    session.lenses.back().enabled = false;
    EXPECT_EQ(lensUnder(space(), session, {250, 200}), 0);
    EXPECT_EQ(lensUnder(space(), session, {60, 60}), -1);
}

/// A slice of 400 x 100 pixels of the box, stretched to half its height, a little off the middle of the lens: 200
/// pixels a metre to the right, 100 upwards, and as many of the same length in the world.
class LensInSlice : public FedImGui {
protected:
    LensInSlice() : FedImGui({500, 400}) {}
    void SetUp() override {
        session.stretch = {1, 0.5, 1};
        session.cursor = {0.3, 0.5, 0.45};
        session.lenses = {{.name = "a", .center = {1, 0.5, 0.5}, .size = glm::vec3(0.08f)}};
        frame();
        frame();
    }
    void frame() {
        feedWindow([&] {
            surface({50, 50}, {450, 150});
            const volume::Box box{glm::dvec3(0), {2, 1, 1}};
            const PlaneFrame slice{{{50, 50}, {450, 150}, {0, 200}, {0, 100}}, // centimetres
                                   page,
                                   glm::dvec2(100),
                                   vis::worldFrame(box, session.stretch),
                                   box};
            taken = editLenses(drag, session, slice, ImGui::IsItemHovered());
            ImDrawList& draw = *ImGui::GetWindowDrawList();
            const int before = draw.VtxBuffer.Size;
            drawLensHandles(draw, drag, slice, session);
            drawn = draw.VtxBuffer.Size > before;
        });
    }
    void moveTo(ImVec2 at) {
        mouse = at;
        frame();
    }
    void dragBy(ImVec2 from, ImVec2 by, bool escape = false) {
        moveTo(from);
        ImGui::GetIO().MouseDown[0] = true;
        frame();
        moveTo({from.x + by.x, from.y + by.y});
        if (escape) feedKey(ImGui::GetIO(), key::kEscape, true), frame(), feedKey(ImGui::GetIO(), key::kEscape, false);
        ImGui::GetIO().MouseDown[0] = false;
        frame();
    }
    void hold(bool alt, bool ctrl = false) { feedModifiers(ImGui::GetIO(), ctrl, false, alt); }
    const vis::Lens& lens() const { return session.lenses.front(); }

    Session session;
    LensDrag drag;
    PicturePlane page = planeAcross(0, 1, 2, 0.45);
    const ImVec2 middle{250, 100}, right{282, 100}, top{250, 68}; // 0.08 of 2 m: 32 pixels
    bool taken = false, drawn = false;
};

TEST_F(LensInSlice, SquaresResizeIt) {
    moveTo({middle.x + 15, middle.y - 15});
    EXPECT_TRUE(drawn) << "handles of the lens under the mouse";
    moveTo({60, 60});
    EXPECT_FALSE(drawn);
    moveTo({middle.x + 15, middle.y - 15});
    dragBy(right, {16, 7});
    EXPECT_NEAR(lens().size.x, 0.12f, 1e-4f) << "half as far again";
    EXPECT_NEAR(lens().size.y, 0.12f, 1e-4f) << "a ball stays one";
    EXPECT_EQ(lens().center, glm::dvec3(1, 0.5, 0.5));
    session.lenses[0].size = glm::vec3(0.08f);
    moveTo({middle.x + 15, middle.y - 15});
    hold(false, true);
    dragBy(top, {3, 8});
    hold(false);
    EXPECT_NEAR(lens().size.y, 0.06f, 1e-4f) << "inwards it shrinks; with Ctrl along one axis";
    EXPECT_EQ(lens().size.x, 0.08f);
    session.lenses[0].size = glm::vec3(0.08f);
    moveTo({middle.x + 15, middle.y - 15});
    dragBy(top, {3, -20}, true);
    EXPECT_EQ(lens().size, glm::vec3(0.08f)) << "given up";
    session.lenses[0].shape =
        vis::LensShape::Disc; // as it faces the viewer: its radius in any slice that it is seen in
    session.camera.orientation = glm::quat(1, 0, 0, 0);
    moveTo({middle.x + 12, middle.y - 12});
    dragBy(top, {0, -16});
    EXPECT_NEAR(lens().size.x, 0.12f, 1e-4f);
}

TEST_F(LensInSlice, TheMiddleMovesItAlongTheSlice) {
    dragBy({middle.x + 3, middle.y + 2}, {40, -10});
    EXPECT_NEAR(lens().center.x, 1.2, 1e-6);
    EXPECT_NEAR(lens().center.y, 0.6, 1e-6);
    EXPECT_EQ(lens().center.z, 0.5);
    EXPECT_EQ(session.cursor.x, 0.3);
    session.lenses[0].followsCursor = true;
    dragBy({50 + 0.3f * 200, 100}, {20, 10});
    EXPECT_NEAR(session.cursor.x, 0.4, 1e-6) << "the cross-hair goes along";
    EXPECT_NEAR(session.cursor.y, 0.4, 1e-6);
    EXPECT_EQ(session.cursor.z, 0.45);
}

TEST_F(LensInSlice, AltWorksAnywhereInside) {
    const ImVec2 inside{middle.x + 16, middle.y + 12};
    moveTo(inside);
    ImGui::GetIO().MouseWheel = 1;
    frame();
    EXPECT_FALSE(taken) << "without Alt the wheel goes through the slices";
    dragBy(inside, {20, 0});
    EXPECT_EQ(lens().center.x, 1) << "and a drag moves the cross-hair";
    hold(true);
    moveTo(inside);
    ImGui::GetIO().MouseWheel = 1;
    frame();
    EXPECT_TRUE(taken);
    EXPECT_NEAR(lens().size.x, 0.088f, 1e-5f);
    dragBy(inside, {20, 0});
    EXPECT_NEAR(lens().center.x, 1.1, 1e-6);
    moveTo({middle.x + 20, middle.y});
    ImGui::GetIO().MouseDown[1] = true;
    frame();
    EXPECT_FALSE(taken) << "nothing is rotated in a slice";
    ImGui::GetIO().MouseDown[1] = false;
    hold(false);
}

TEST_F(LensInSlice, TheTopmostOfThoseThatReachTheSliceIsTaken) {
    session.lenses.push_back(lens());
    dragBy(middle, {10, 0});
    EXPECT_EQ(session.lenses[0].center.x, 1);
    EXPECT_NEAR(session.lenses[1].center.x, 1.05, 1e-6);
    session.lenses[1].center.x = 1;
    session.lenses[1].enabled = false;
    dragBy(middle, {10, 0});
    EXPECT_NEAR(session.lenses[0].center.x, 1.05, 1e-6);
    EXPECT_EQ(session.lenses[1].center.x, 1);
    session.lenses[0].center = {1, 0.5, 0.9};
    dragBy(middle, {10, 0});
    EXPECT_EQ(session.lenses[0].center.x, 1) << "what is not seen is not moved";
}

TEST(LensSection, LiesOnTheLensAndInThePlane) {
    for (const vis::LensShape shape : {vis::LensShape::Sphere, vis::LensShape::Box, vis::LensShape::Cylinder}) {
        const vis::Lens lens{.shape = shape, .size = {0.2f, 0.1f, 0.15f}, .rotation = {30, 40, 50}};
        const vis::PlacedLens placed = vis::placeLenses({lens}, {}, {}, {}).front();
        const auto points = lensSection(placed, {0, 0, 0.05}, {1, 0, 0}, {0, 1, 0});
        EXPECT_GE(points.size(), 32u);
        for (const glm::dvec3& point : points) {
            EXPECT_EQ(point.z, 0.05);
            EXPECT_NEAR(placed.radius(point), 1, 1e-6);
        }
        EXPECT_TRUE(lensSection(placed, {0, 0, 0.4}, {1, 0, 0}, {0, 1, 0}).empty());
    }
}

/// Where a plane cuts a lens far from its middle, the section lies there, on either side.
TEST(LensSection, FollowsATiltedLensToBothSides) {
    const vis::Lens lens{.shape = vis::LensShape::Sphere, .size = {0.6f, 0.05f, 0.05f}, .rotation = {0, 45, 0}};
    const vis::PlacedLens placed = vis::placeLenses({lens}, {}, {}, {}).front();
    const auto middleAt = [&](double z) {
        const auto points = lensSection(placed, {0, 0, z}, {1, 0, 0}, {0, 1, 0});
        glm::dvec3 sum(0);
        for (const glm::dvec3& point : points) sum += point / double(std::max<std::size_t>(points.size(), 1));
        EXPECT_FALSE(points.empty()) << z;
        return sum;
    };
    const glm::dvec3 above = middleAt(0.3), below = middleAt(-0.3);
    EXPECT_NEAR(std::abs(above.x), 0.3, 0.02) << "along the diagonal";
    EXPECT_NEAR(above.x, -below.x, 1e-3);
    EXPECT_NEAR(above.y, 0, 1e-3);
    EXPECT_NEAR(below.y, 0, 1e-3);
}

TEST_F(LensEdit, TheHandleThatTurnsStandsAboveTheOthers) {
    session.lenses[0].rotation = {0, 0, 90}; // the longest axis upright
    frame();
    const LensHandles at = handles();
    ASSERT_TRUE(at.turn && at.middle);
    EXPECT_EQ(at.turn->x, at.middle->x);
    float farthest = 0;
    for (const auto& axis : at.axes)
        if (axis) farthest = std::max(farthest, std::hypot(axis->x - at.middle->x, axis->y - at.middle->y));
    EXPECT_GT(farthest, 20);
    EXPECT_LT(at.turn->y, at.middle->y - farthest);
    EXPECT_GT(at.turn->y, at.middle->y - farthest - 40);
}

TEST(LensList, NamesAreHeldTogether) {
    volume::DatasetInfo info;
    info.bounds = {glm::dvec3(0), {2, 1, 1}};
    Session session;
    addLensWith(session, info, vis::VolumeLayer{.channel = "O2"});
    addLensWith(session, info, vis::IsoLayer{.channel = "T"});
    ASSERT_EQ(session.lenses.size(), 2u);
    EXPECT_NE(session.lenses[0].name, session.lenses[1].name);
    EXPECT_NE(session.lenses[0].color, session.lenses[1].color);
    session.selection.brushes = {{.region = vis::LensRegion{session.lenses[1].name}}};
    renameLens(session, 1, session.lenses[0].name);
    EXPECT_NE(session.lenses[0].name, session.lenses[1].name);
    renameLens(session, 1, "hot");
    EXPECT_EQ(session.layers[1].lens, "hot");
    EXPECT_EQ(std::get<vis::LensRegion>(session.selection.brushes[0].region).lens, "hot");
    removeLens(session, 1);
    EXPECT_FALSE(session.layers[1].visible) << "nothing that was inside fills the picture";
    EXPECT_TRUE(session.layers[1].lens.empty());
    EXPECT_TRUE(session.selection.brushes.empty());
    EXPECT_TRUE(session.layers[0].visible);
}

/// A lens that follows the pointer stays under it in the plane of its middle; F pins it and takes it up again.
TEST_F(LensEdit, FollowsThePointerUntilItIsPinned) {
    session.lenses[0].followsPointer = true;
    follow = true;
    moveTo({150, 120});
    moveTo({180, 170});
    EXPECT_NEAR(handles().middle->x, 180, 0.1);
    EXPECT_NEAR(handles().middle->y, 170, 0.1);
    EXPECT_EQ(lens().center.z, 0.5);
    EXPECT_TRUE(followed);
    const auto key = [&] {
        feedKey(ImGui::GetIO(), 'F', true);
        frame();
        feedKey(ImGui::GetIO(), 'F', false);
        frame();
    };
    key();
    EXPECT_FALSE(lens().followsPointer);
    const glm::dvec3 pinned = lens().center;
    moveTo({300, 200});
    EXPECT_EQ(lens().center, pinned);
    key();
    EXPECT_TRUE(lens().followsPointer) << "the last one where none is under the mouse";
    moveTo({301, 200});
    EXPECT_NEAR(handles().middle->x, 301, 0.1);
    ImGui::GetIO().MouseDown[0] = true; // the camera turns: the lens stays
    moveTo({250, 220});
    EXPECT_NEAR(handles().middle->x, 301, 0.1);
    ImGui::GetIO().MouseDown[0] = false;
}

TEST(LensOrder, ALensTakesThePlaceItIsDroppedOn) {
    Session session;
    for (const char* name : {"a", "b", "c", "d"}) session.lenses.push_back({.name = name});
    const auto order = [&] {
        std::string names;
        for (const vis::Lens& lens : session.lenses) names += lens.name;
        return names;
    };
    moveLens(session, 0, 2);
    EXPECT_EQ(order(), "bcad");
    moveLens(session, 3, 0);
    EXPECT_EQ(order(), "dbca");
    moveLens(session, 1, 7);
    EXPECT_EQ(order(), "dbca");
}

TEST_F(LensEdit, ALensThatIsGoneIsDraggedNoFurther) {
    moveTo(*handles().middle);
    button(0, true);
    moveTo({mouse.x + 10, mouse.y});
    EXPECT_TRUE(taken);
    session.lenses.clear(); // undone meanwhile
    moveTo({mouse.x + 10, mouse.y});
    EXPECT_FALSE(taken);
    EXPECT_FALSE(drag.active);
    button(0, false);
    EXPECT_TRUE(session.lenses.empty());
}

} // namespace
} // namespace tessera::app
