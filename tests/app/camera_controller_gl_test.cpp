#include "app/tools/camera_controller.h"
#include "tests/app/fed_imgui.h"
#include "tests/app/formula_cell.h"
#include "vis/gl/headless.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

/// What the mouse and the keys over a picture of the scene do to the camera: that what is under the mouse goes where
/// the mouse goes, seen in the pixels that the camera's matrices give.
namespace tessera::app {
namespace {

/// A picture of 400 x 300 pixels of the formula cell, seen aslant.
class CameraControllerGl : public FedImGui {
protected:
    CameraControllerGl() : FedImGui({600, 500}) {}
    void SetUp() override {
        source = volume::makeMemorySource(formula::makeCell(), {.lattice = volume::LatticeKind::BCC});
        renderer.setSource(source);
        session = defaultSession(source->info(), {});
        world = vis::worldFrame(source->info(), session.stretch);
        camera().target = {0.05f, -0.02f, 0.1f};
        park();
    }
    vis::Camera& camera() { return session.camera; }
    ImVec2 middle() const { return {box.min.x + box.size.x / 2, box.min.y + box.size.y / 2}; }
    ImVec2 fromMiddle(float right, float up) const { return {middle().x + right, middle().y - up}; }

    /// Where the camera shows a point of the world, by its matrices.
    ImVec2 pixel(glm::dvec3 at) {
        const glm::dvec4 clip =
            vis::projectionMatrix(camera(), box.aspect()) * vis::viewMatrix(camera()) * glm::dvec4(at, 1);
        return {float(box.min.x + (clip.x / clip.w + 1) / 2 * box.size.x),
                float(box.min.y + (1 - clip.y / clip.w) / 2 * box.size.y)};
    }
    /// The point of the world at a place in eye axes from the target.
    glm::dvec3 beside(glm::dvec3 eye) {
        const glm::dvec3 behind = eye - glm::dvec3(0, 0, camera().distance);
        return glm::dvec3(glm::inverse(vis::viewMatrix(camera())) * glm::dvec4(behind, 1));
    }
    /// The point under a pixel in the plane of the target that faces the viewer.
    glm::dvec3 under(ImVec2 at) {
        const double height = camera().distance * std::tan(glm::radians(double(camera().fieldOfView)) / 2);
        return beside({double(at.x - middle().x) * height / (box.size.y / 2.0),
                       double(middle().y - at.y) * height / (box.size.y / 2.0), 0});
    }

    void frame(float seconds = 1.0f / 60) {
        feedWindow(
            [&] {
                if (type) {
                    ImGui::SetKeyboardFocusHere();
                    ImGui::InputText("text", text, sizeof text);
                }
                ImGui::SetCursorScreenPos(box.min);
                ImGui::InvisibleButton("picture", box.size,
                                       ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
                                           ImGuiButtonFlags_MouseButtonRight);
                ViewContext context{session, source, renderer, jobs, caches};
                context.cameraKey = picked;
                moving = handleMouse(context, hand, target.get(), box, world, "menu");
                picked = context.cameraKey;
                menuOpen = ImGui::IsPopupOpen("menu");
                if (ImGui::BeginPopup("menu")) ImGui::EndPopup();
            },
            seconds);
    }
    void moveTo(ImVec2 at) {
        mouse = at;
        frame();
    }
    void button(int which, bool down) {
        ImGui::GetIO().MouseDown[which] = down;
        frame();
    }
    void drag(ImVec2 from, ImVec2 to, int which = ImGuiMouseButton_Left) {
        mouse = from;
        frame(1); // no second click of a double one
        button(which, true);
        EXPECT_FALSE(moving) << "a button that goes down moves nothing";
        for (const float part : {0.25f, 0.5f, 1.0f})
            moveTo({from.x + (to.x - from.x) * part, from.y + (to.y - from.y) * part});
        button(which, false);
    }
    void click(ImVec2 at, int which) { drag(at, at, which); }
    void wheel(ImVec2 at, float notches) {
        mouse = at;
        ImGui::GetIO().MouseWheel = notches;
        frame();
    }
    void hold(bool ctrl, bool shift) { feedModifiers(ImGui::GetIO(), ctrl, shift, false); }
    void key(int code, bool shift = false, bool ctrl = false) {
        hold(ctrl, shift);
        for (const bool down : {true, false}) {
            feedKey(ImGui::GetIO(), code, down);
            frame();
        }
        hold(false, false);
    }
    /// The mouse away from the picture, over nothing.
    void park() {
        mouse = {580, 480};
        frame(1);
        frame();
    }
    void drawScene() {
        target = renderer.makeTarget();
        vis::Scene scene = sceneOf(session);
        renderer.render(*target, scene, {.size = {400, 300}, .wait = true});
    }

    vis::HeadlessContext gl;
    vis::Renderer renderer;
    Jobs jobs;
    std::map<std::string, std::unique_ptr<ViewCache>> caches;
    std::shared_ptr<const volume::BrickSource> source;
    Session session;
    vis::WorldFrame world;
    vis::ViewTargetPtr target;
    CameraController hand;
    PictureBox box{{50, 40}, {400, 300}};
    int picked = 0;
    bool moving = false, menuOpen = false, type = false;
    char text[16] = "";
};

void expectAt(ImVec2 is, ImVec2 wanted, double within = 0.05) {
    EXPECT_NEAR(is.x, wanted.x, within);
    EXPECT_NEAR(is.y, wanted.y, within);
}

constexpr vis::Projection kProjections[] = {vis::Projection::Perspective, vis::Projection::Orthographic};

TEST_F(CameraControllerGl, TheNearSideOfTheObjectGoesWithTheMouse) {
    const vis::Camera before = camera();
    for (const vis::Projection projection : kProjections)
        for (const auto& [right, up] : {std::pair(60.0f, 0.0f), {-60, 0}, {0, 45}, {0, -45}}) {
            camera() = before;
            camera().projection = projection;
            const glm::dvec3 near = beside({0, 0, 0.3}), far = beside({0, 0, -0.3});
            expectAt(pixel(near), middle());
            drag(middle(), fromMiddle(right, up));
            // A ball as wide and high as the picture: the point of it under the mouse stays there.
            const glm::dvec3 turned = glm::dvec3(vis::viewMatrix(camera()) * glm::dvec4(near, 1));
            EXPECT_NEAR(turned.x, 0.3 * double(right) / 200, 1e-5);
            EXPECT_NEAR(turned.y, 0.3 * double(up) / 150, 1e-5);
            const ImVec2 front = pixel(near), back = pixel(far);
            EXPECT_GT((front.x - middle().x) * right + (middle().y - front.y) * up, 0);
            EXPECT_LT((back.x - middle().x) * right + (middle().y - back.y) * up, 0);
            EXPECT_EQ(camera().target, before.target);
            EXPECT_EQ(camera().distance, before.distance);
        }
}

// While it moves the picture is drawn coarsely.
TEST_F(CameraControllerGl, ADragIsToldWhileItMoves) {
    for (const int which : {ImGuiMouseButton_Left, ImGuiMouseButton_Middle, ImGuiMouseButton_Right}) {
        park();
        EXPECT_FALSE(moving);
        moveTo(middle());
        EXPECT_FALSE(moving);
        button(which, true);
        moveTo(fromMiddle(40, 30));
        moveTo(fromMiddle(60, 30));
        EXPECT_TRUE(moving) << which;
        button(which, false);
        frame();
        EXPECT_FALSE(moving) << which;
    }
}

TEST_F(CameraControllerGl, ADragAtTheEdgeTurnsAboutTheViewersAxis) {
    const glm::dvec3 edge = under(fromMiddle(195, 0));
    drag(fromMiddle(195, -40), fromMiddle(195, 40));
    EXPECT_LT(pixel(edge).y, middle().y - 20) << "the right side goes up with the mouse";
}

TEST_F(CameraControllerGl, PannedPointsStayUnderTheMouse) {
    const vis::Camera before = camera();
    for (const vis::Projection projection : kProjections)
        for (const int which : {ImGuiMouseButton_Left, ImGuiMouseButton_Middle}) {
            camera() = before;
            camera().projection = projection;
            const ImVec2 from = fromMiddle(-70, 30), to = fromMiddle(45, -82);
            const glm::dvec3 held = under(from);
            hold(false, which == ImGuiMouseButton_Left);
            drag(from, to, which);
            hold(false, false);
            expectAt(pixel(held), to);
            EXPECT_EQ(camera().orientation, before.orientation);
            EXPECT_EQ(camera().distance, before.distance);
        }
}

TEST_F(CameraControllerGl, ARightDragUpMagnifies) {
    const vis::Camera before = camera();
    const ImVec2 place = fromMiddle(80, 20);
    const glm::dvec3 seen = under(place);
    drag(fromMiddle(-50, -30), fromMiddle(20, 30), ImGuiMouseButton_Right);
    EXPECT_NEAR(camera().distance, double(before.distance) / std::exp(1.5 * 60 / 150), 1e-4);
    EXPECT_GT(pixel(seen).x, place.x + 20);
    EXPECT_LT(pixel(seen).y, place.y - 5);
    EXPECT_EQ(camera().orientation, before.orientation);
    EXPECT_EQ(camera().target, before.target);
    drag(fromMiddle(0, 30), fromMiddle(0, -30), ImGuiMouseButton_Right);
    EXPECT_NEAR(camera().distance, double(before.distance), 1e-4) << "down as much as up";
}

TEST_F(CameraControllerGl, TheWheelMagnifiesWhatIsInTheMiddleOrWithCtrlUnderTheMouse) {
    const vis::Camera before = camera();
    const ImVec2 place = fromMiddle(120, -70);
    for (const vis::Projection projection : kProjections) {
        camera() = before;
        camera().projection = projection;
        glm::dvec3 seen = under(place);
        wheel(place, 1);
        EXPECT_TRUE(moving);
        expectAt(pixel(seen), fromMiddle(120 * 1.15f, -70 * 1.15f));
        EXPECT_EQ(camera().target, before.target);
        wheel(place, -3);
        expectAt(pixel(seen), fromMiddle(120 / 1.3225f, -70 / 1.3225f));

        camera() = before;
        camera().projection = projection;
        seen = under(place);
        const glm::dvec3 centre = under(middle());
        hold(true, false);
        wheel(place, 2);
        hold(false, false);
        expectAt(pixel(seen), place);
        EXPECT_NEAR(camera().distance, double(before.distance) / 1.3225, 1e-5);
        EXPECT_LT(pixel(centre).x, middle().x - 10) << "the rest goes away from the mouse";
    }
    camera() = before;
    wheel({20, 20}, 1);
    EXPECT_EQ(camera(), before) << "beside the picture";
}

TEST_F(CameraControllerGl, CtrlRollsThePictureWithTheMouse) {
    const vis::Camera before = camera();
    const auto around = [&](double degrees) { // whole pixels, as ImGui has the mouse
        const double angle = degrees * std::numbers::pi / 180;
        return fromMiddle(float(std::round(120 * std::cos(angle))), float(std::round(120 * std::sin(angle))));
    };
    for (const auto& [from, to] : {std::pair(0.0, 40.0), {60, 10}, {170, 200}, {-80, -100}}) {
        camera() = before;
        const ImVec2 begin = around(from), end = around(to);
        const glm::dvec3 held = under(begin);
        hold(true, false);
        drag(begin, end);
        hold(false, false);
        const glm::dvec2 way(end.x - middle().x, end.y - middle().y);
        const double part = std::hypot(begin.x - middle().x, begin.y - middle().y) / glm::length(way);
        expectAt(pixel(held), {float(middle().x + way.x * part), float(middle().y + way.y * part)});
        expectAt(pixel(glm::dvec3(before.target)), middle());
    }
}

/// The world's axes on screen after a key, each as the signed axis (1 = x ... -3 = -z) that points there.
struct Standard {
    int key;
    bool shift;
    int right, up;
};

TEST_F(CameraControllerGl, DigitsLookAlongTheAxes) {
    static constexpr Standard kStandards[] = {{'1', false, 1, 2}, {'1', true, -1, 2},  {'3', false, -3, 2},
                                              {'3', true, 3, 2},  {'7', false, 1, -3}, {'7', true, 1, 3}};
    const vis::Camera before = camera();
    const auto axis = [](int signedAxis) {
        glm::dvec3 out(0);
        out[std::abs(signedAxis) - 1] = signedAxis > 0 ? 0.1 : -0.1;
        return out;
    };
    for (const vis::Projection projection : kProjections)
        for (const Standard& each : kStandards) {
            SCOPED_TRACE(std::string(each.shift ? "Shift+" : "") + char(each.key));
            camera() = before;
            camera().projection = projection;
            moveTo(middle());
            key(each.key, each.shift);
            expectAt(pixel(glm::dvec3(0)), middle());
            const ImVec2 right = pixel(axis(each.right)), up = pixel(axis(each.up));
            EXPECT_GT(right.x, middle().x + 5);
            EXPECT_NEAR(right.y, middle().y, 0.05);
            EXPECT_LT(up.y, middle().y - 5);
            EXPECT_NEAR(up.x, middle().x, 0.05);
            // All of the box is seen and fills the picture one way.
            float most = 0;
            for (int corner = 0; corner < 8; ++corner) {
                const glm::dvec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
                const ImVec2 at = pixel(world.halfSize * sign);
                most = std::max({most, std::abs(at.x - middle().x) / 200, std::abs(at.y - middle().y) / 150});
            }
            EXPECT_GT(most, 0.85f);
            EXPECT_LT(most, 1);
            const vis::Camera byKey = camera();
            if (each.shift) continue;
            camera() = before;
            camera().projection = projection;
            park();
            picked = each.key;
            frame();
            EXPECT_EQ(camera(), byKey) << "the same from a menu, wherever the mouse is";
            EXPECT_EQ(picked, 0);
        }
}

TEST_F(CameraControllerGl, NineFiveAndRAreTheSlantedViewTheProjectionAndTheFirstView) {
    const vis::Camera before = camera();
    moveTo(middle());
    camera().projection = vis::Projection::Orthographic;
    key('9');
    const ImVec2 x = pixel({0.1, 0, 0}), y = pixel({0, 0.1, 0}), z = pixel({0, 0, 0.1});
    const auto length = [&](ImVec2 end) { return std::hypot(end.x - middle().x, end.y - middle().y); };
    EXPECT_NEAR(length(x), length(y), 0.05);
    EXPECT_NEAR(length(z), length(y), 0.05);
    EXPECT_NEAR(y.x, middle().x, 0.05);
    EXPECT_LT(y.y, middle().y - 5);
    EXPECT_GT(z.y, middle().y + 2) << "from above, in front of z";
    EXPECT_GT(z.x, middle().x + 5);
    EXPECT_GT(x.x, middle().x + 5);

    camera() = before;
    key('5');
    EXPECT_EQ(camera().projection, vis::Projection::Orthographic);
    key('5');
    EXPECT_EQ(camera(), before);
    drag(middle(), fromMiddle(60, 40));
    key('R');
    EXPECT_EQ(camera().orientation, vis::firstOrientation(world));
    expectAt(pixel(glm::dvec3(0)), middle());
    const vis::Camera reset = camera();
    for (const int each : {'9', '5', 'R'}) key(each, true);
    for (const int each : {'1', '3', '5', '7', '9', 'R'}) key(each, false, true);
    EXPECT_EQ(camera(), reset) << "with other modifiers they are other keys";
}

TEST_F(CameraControllerGl, KeysAreNoneWhileSomethingIsTyped) {
    moveTo(middle());
    type = true;
    frame();
    frame();
    const vis::Camera before = camera();
    key('1');
    EXPECT_EQ(camera(), before);
}

TEST_F(CameraControllerGl, ARightClickOpensTheMenuAndADragDoesNot) {
    const vis::Camera before = camera();
    drag(middle(), fromMiddle(0, 40), ImGuiMouseButton_Right);
    EXPECT_FALSE(menuOpen);
    mouse = middle();
    frame(1);
    button(ImGuiMouseButton_Right, true);
    for (const float up : {20.0f, 40.0f, 15.0f, 0.0f}) moveTo(fromMiddle(0, up));
    button(ImGuiMouseButton_Right, false);
    EXPECT_FALSE(menuOpen) << "a drag that comes back";
    for (const int which : {ImGuiMouseButton_Left, ImGuiMouseButton_Middle}) {
        click(middle(), which);
        EXPECT_FALSE(menuOpen);
    }
    camera() = before;
    mouse = middle();
    frame(1);
    button(ImGuiMouseButton_Right, true);
    EXPECT_FALSE(menuOpen) << "not before the button is up";
    button(ImGuiMouseButton_Right, false);
    EXPECT_TRUE(menuOpen);
    EXPECT_EQ(camera(), before);
}

TEST_F(CameraControllerGl, WhatIsBlockedOrBesideThePictureBeginsNoDrag) {
    const vis::Camera before = camera();
    hand.blocked = true;
    for (const int which : {ImGuiMouseButton_Left, ImGuiMouseButton_Middle, ImGuiMouseButton_Right}) {
        drag(middle(), fromMiddle(50, 20), which);
        EXPECT_FALSE(hand.dragging());
        EXPECT_FALSE(menuOpen);
    }
    hand.blocked = false;
    drag({20, 20}, middle());
    EXPECT_EQ(camera(), before);
    // What has begun goes on, blocked or outside of the picture.
    const glm::dvec3 held = under(middle());
    mouse = middle();
    frame(1);
    button(ImGuiMouseButton_Middle, true);
    EXPECT_TRUE(hand.dragging());
    hand.blocked = true;
    moveTo(fromMiddle(250, 170));
    EXPECT_TRUE(moving);
    expectAt(pixel(held), fromMiddle(250, 170));
    button(ImGuiMouseButton_Middle, false);
    EXPECT_FALSE(hand.dragging());
    moveTo(middle());
    expectAt(pixel(held), fromMiddle(250, 170));
}

TEST_F(CameraControllerGl, AMiddleClickCentresWhatIsThereAndADoubleClickPutsTheCursorThere) {
    drawScene();
    const vis::Camera before = camera();
    const ImVec2 place = fromMiddle(-31, 17);
    const auto inside = [&](glm::dvec3 at) { return glm::all(glm::lessThan(glm::abs(at), world.halfSize + 1e-3)); };
    drag(place, fromMiddle(-20, 30), ImGuiMouseButton_Middle);
    camera() = before;
    click(place, ImGuiMouseButton_Middle);
    const glm::dvec3 centred(camera().target);
    EXPECT_NE(camera().target, before.target);
    EXPECT_TRUE(inside(centred));
    expectAt(pixel(centred), middle());
    camera() = before;
    expectAt(pixel(centred), place, 1);

    click(fromMiddle(-195, 145), ImGuiMouseButton_Middle);
    EXPECT_EQ(camera(), before) << "nothing is there";

    const glm::dvec3 cursor = session.cursor;
    click(place, ImGuiMouseButton_Left);
    EXPECT_EQ(session.cursor, cursor);
    button(ImGuiMouseButton_Left, true);
    button(ImGuiMouseButton_Left, false);
    EXPECT_NE(session.cursor, cursor);
    EXPECT_TRUE(inside(world.toWorld(session.cursor)));
    expectAt(pixel(world.toWorld(session.cursor)), place, 1);
    EXPECT_EQ(camera(), before);
}

} // namespace
} // namespace tessera::app
