#include "app/pane/axes3d.h"
#include "app/views/shadow_cube/cube_axes.h"
#include "tests/app/drawn_text.h"
#include "tests/app/hands_fixture.h"

#include <algorithm>

/// The mouse in views of space: volume, shadow cube, comparisons. The camera's own hand: camera_controller_gl_test.cpp.
namespace tessera::app {
namespace {

volume::Box cellBox() {
    const glm::dvec3 lo(formula::kOrigin[0], formula::kOrigin[1], formula::kOrigin[2]);
    return {lo, lo + glm::dvec3(formula::kSpacing[0] * 7, formula::kSpacing[1] * 6, formula::kSpacing[2] * 8)};
}

class SpaceHands : public Hands {
protected:
    /// An empty scene seen along -z, x to the right, y up, without perspective.
    static void fromFront(Session& edited) {
        edited.layers.clear();
        edited.camera = {};
        edited.camera.orientation = glm::quat(1, 0, 0, 0);
        edited.camera.projection = vis::Projection::Orthographic;
    }
    void showSpace(const ViewState& view, glm::ivec2 size = {400, 300},
                   const std::function<void(Session&)>& prepare = {}) {
        show(view, size, [&](Session& edited) {
            fromFront(edited);
            if (prepare) prepare(edited);
        });
        ASSERT_FALSE(pictures().empty());
        picture = pictures().back();
    }
    void showVolume() {
        VolumeView volume;
        volume.showGizmo = volume.showLegend = false;
        showSpace(volume);
    }
    vis::Camera& camera() { return session().camera; }
    double aspect() const { return double(picture.GetWidth()) / double(picture.GetHeight()); }
    glm::vec2 ndc(ImVec2 at) const {
        return {(at.x - picture.Min.x) / picture.GetWidth() * 2 - 1,
                1 - (at.y - picture.Min.y) / picture.GetHeight() * 2};
    }
    /// The camera that the view draws with.
    vis::Camera drawnBy() {
        const auto* cube = std::get_if<ShadowCubeView>(&session().views.at("pane"));
        if (!cube) return camera();
        const glm::dvec3 half = vis::worldFrame(cellBox(), session().stretch).halfSize + double(cube->gap);
        return cubeCamera(*cube, camera(), half, aspect(), cubeShare(*cube, picture.GetSize()));
    }
    ImVec2 pixel(glm::dvec3 physical) {
        return *spaceFrame(picture.Min, picture.Max, drawnBy(), cellBox(), session().stretch).pixel(physical);
    }
    /// Where a direction of the world points to for the viewer.
    static glm::dvec3 seen(const vis::Camera& by, glm::dvec3 direction) {
        return glm::dmat3(vis::viewMatrix(by)) * direction;
    }
    void expectSame(const vis::Camera& expected) {
        EXPECT_LT(glm::length(camera().orientation - expected.orientation), 1e-5f);
        EXPECT_LT(glm::length(camera().target - expected.target), 1e-5f);
        EXPECT_NEAR(camera().distance, expected.distance, 1e-5f);
    }
    ImRect picture;
};

TEST_F(SpaceHands, ADragTurnsTheObjectWithTheMouse) {
    showVolume();
    const Session before = session();
    const ImVec2 middle = within(picture, 0.5, 0.5);
    const auto from = [&](ImVec2 by) {
        camera() = before.camera;
        drag(middle, {middle.x + by.x, middle.y + by.y});
        EXPECT_EQ(camera().distance, before.camera.distance);
        EXPECT_EQ(camera().target, before.camera.target);
        return seen(camera(), {0, 0, 1}); // what faced the viewer
    };
    const glm::dvec3 right = from({60, 0}), up = from({0, -60}), left = from({-60, 0}), lower = from({0, 60});
    for (const glm::dvec3& front : {right, up, left, lower}) EXPECT_LT(front.z, 0.97);
    EXPECT_GT(right.x, 0.25);
    EXPECT_NEAR(right.y, 0, 0.01) << "about the upright axis";
    EXPECT_LT(left.x, -0.25);
    EXPECT_GT(up.y, 0.25);
    EXPECT_NEAR(up.x, 0, 0.01);
    EXPECT_LT(lower.y, -0.25);
    camera() = before.camera;
    frame();
    vis::Camera expected = before.camera;
    moveTo(within(picture, 0.3, 0.4));
    button(0, true);
    for (const ImVec2 to : {within(picture, 0.6, 0.5), within(picture, 0.7, 0.2)}) {
        vis::orbit(expected, ndc(mouse), ndc(to));
        moveTo(to);
        expectSame(expected);
    }
    button(0, false);
    moveTo(middle);
    expectSame(expected);
}

TEST_F(SpaceHands, OneTurnIsOneStep) {
    showVolume();
    const Session before = session();
    moveTo(within(picture, 0.3, 0.4));
    EXPECT_TRUE(session() == before) << apart(before);
    drag(mouse, within(picture, 0.7, 0.6));
    EXPECT_FALSE(session() == before);
    settle();
    EXPECT_EQ(steps(), 1u);
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
}

TEST_F(SpaceHands, WheelAndRightButtonZoom) {
    showVolume();
    const vis::Camera before = camera();
    const ImVec2 at = within(picture, 0.8, 0.3);
    moveTo(at);
    turnWheel(2);
    EXPECT_NEAR(camera().distance, before.distance / (1.15f * 1.15f), 1e-5f) << "away from the hand: nearer";
    EXPECT_EQ(camera().target, before.target);
    turnWheel(-2);
    EXPECT_NEAR(camera().distance, before.distance, 1e-5f);
    // With Ctrl what is under the mouse, at the target's depth, stays there.
    const double width = 2 * double(before.distance) * std::tan(glm::radians(before.fieldOfView / 2.0)) * aspect();
    const auto under = [&] {
        return double(camera().target.x) + double(ndc(at).x) / 2 * width * double(camera().distance / before.distance);
    };
    const double held = under();
    ctrl = true;
    turnWheel(3);
    ctrl = false;
    EXPECT_NEAR(camera().distance, before.distance / std::pow(1.15f, 3.0f), 1e-5f);
    EXPECT_NEAR(under(), held, 1e-5);
    EXPECT_GT(camera().target.x, 0.1f) << "the target moves towards the mouse";
    camera() = before;
    drag(within(picture, 0.5, 0.75), within(picture, 0.5, 0.25), 1);
    const float risen = ndc(within(picture, 0, 0.25)).y - ndc(within(picture, 0, 0.75)).y;
    EXPECT_NEAR(camera().distance, before.distance / std::exp(1.5f * risen), 1e-4f) << "up: nearer";
    EXPECT_FALSE(popup()) << "a drag opens no menu";
    camera() = before;
    click(at, 1);
    EXPECT_TRUE(popup());
    expectSame(before);
    press(key::kEscape);
    moveTo(at);
    for (int i = 0; i < 4; ++i) turnWheel(30);
    EXPECT_EQ(camera().distance, 0.01f);
    for (int i = 0; i < 4; ++i) turnWheel(-30);
    EXPECT_EQ(camera().distance, 100.0f);
}

TEST_F(SpaceHands, AltIsForTheLensAlsoBelowAnotherDot) {
    showVolume();
    const glm::dvec3 middle = (cellBox().lo + cellBox().hi) / 2.0;
    vis::Brush ball;
    ball.region = vis::SphereRegion{.center = middle, .radius = cellBox().size() * 0.2};
    session().selection.brushes = {ball};
    vis::Lens lens;
    lens.center = middle;
    session().lenses = {lens};
    settle();
    const ImVec2 from = pixel(middle), to{from.x + 30, from.y};
    const auto ballAt = [&] { return std::get<vis::SphereRegion>(session().selection.brushes[0].region).center; };
    alt = true;
    drag(from, to);
    alt = false;
    frame();
    EXPECT_GT(glm::length(session().lenses[0].center - middle), 1e-4);
    EXPECT_EQ(ballAt(), middle);
    const glm::dvec3 moved = session().lenses[0].center;
    drag(from, to);
    EXPECT_GT(glm::length(ballAt() - middle), 1e-4) << "without it the dot";
    EXPECT_EQ(session().lenses[0].center, moved);
}

TEST_F(SpaceHands, TheFacesOfTheCubeAreBrushed) {
    ShadowCubeView cube;
    cube.brushing = true;
    showSpace(cube);
    const glm::dvec3 a{0.0121, 0.0093, 0}, b{0.0152, 0.0031, 0};
    const Session before = session();
    const volume::Box box = cellBox();
    const double exact = 1.1 * (box.hi.x - box.lo.x) / double(pixel(box.hi).x - pixel(box.lo).x); // a pixel
    const auto& brushes = session().selection.brushes;
    const auto expectPrism = [&](std::size_t index, glm::dvec3 from, glm::dvec3 to, vis::BrushCombine combine) {
        ASSERT_GT(brushes.size(), index);
        const auto& region = std::get<vis::BoxRegion>(brushes[index].region);
        for (int axis = 0; axis < 2; ++axis) {
            EXPECT_NEAR(region.center[axis], (from[axis] + to[axis]) / 2, exact);
            EXPECT_NEAR(region.radius[axis], std::abs(from[axis] - to[axis]) / 2, exact);
        }
        EXPECT_NEAR(region.center.z, box.center().z, 1e-12) << "through all that lies before the face";
        EXPECT_GE(region.radius.z, (box.hi.z - box.lo.z) / 2);
        EXPECT_EQ(brushes[index].combine, combine);
    };
    drag(pixel(a), pixel(b));
    EXPECT_EQ(brushes.size(), 1u);
    expectPrism(0, a, b, vis::BrushCombine::And);
    expectSame(before.camera);
    settle();
    EXPECT_EQ(steps(), 1u);
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
    drag(pixel(a), pixel(b));
    shift = true;
    const glm::dvec3 c{0.0105, 0.001, 0}, d{0.0115, 0.005, 0};
    drag(pixel(c), pixel(d));
    shift = false;
    EXPECT_EQ(brushes.size(), 2u);
    expectPrism(1, c, d, vis::BrushCombine::Or);
    ctrl = true;
    drag(pixel(d), pixel(a));
    ctrl = false;
    EXPECT_EQ(brushes.size(), 3u);
    expectPrism(2, d, a, vis::BrushCombine::Minus);
    const vis::Selection three = session().selection;
    moveTo(pixel(b));
    button(0, true);
    moveTo(pixel(c));
    EXPECT_EQ(brushes.size(), 1u) << "without them it takes the others' place";
    press(key::kEscape);
    EXPECT_TRUE(session().selection == three) << "Esc gives up";
    button(0, false);
    EXPECT_TRUE(session().selection == three);
    drag(pixel(a), {picture.Max.x + 100, picture.Min.y - 100});
    expectPrism(0, a, {box.hi.x, box.hi.y, 0}, vis::BrushCombine::And); // no farther than the data
}

TEST_F(SpaceHands, TheCubeTurnsWithTheObjectOrAlone) {
    ShadowCubeView cube;
    showSpace(cube);
    const vis::Camera before = camera();
    vis::Camera turned = before;
    const ImVec2 from = within(picture, 0.3, 0.5), to = within(picture, 0.6, 0.4);
    moveTo(from);
    button(0, true);
    vis::orbit(turned, ndc(from), ndc(to));
    moveTo(to);
    button(0, false);
    expectSame(turned);
    EXPECT_GT(seen(camera(), {0, 0, 1}).x, 0.2) << "as the mouse went";
    EXPECT_EQ(view<ShadowCubeView>().orientation, cube.orientation);
    // Unlocked, a drag beside the object turns the cube alone.
    camera() = before;
    view<ShadowCubeView>().together = false;
    view<ShadowCubeView>().orientation = before.orientation;
    frame();
    moveTo(from);
    button(0, true);
    moveTo(to);
    button(0, false);
    expectSame(before);
    EXPECT_LT(glm::length(view<ShadowCubeView>().orientation - turned.orientation), 1e-5f);
    view<ShadowCubeView>().orientation = before.orientation;
    const glm::dvec3 cursor = session().cursor, place{0.0152, 0.0093, 0};
    ImGui::GetIO().MouseDoubleClickTime = 0.3f;
    for (int i = 0; i < 2; ++i) click(pixel(place));
    EXPECT_NEAR(session().cursor.x, place.x, 1e-4);
    EXPECT_NEAR(session().cursor.y, place.y, 1e-4);
    EXPECT_EQ(session().cursor.z, cursor.z) << "a double click on a face says nothing about the depth";
}

TEST_F(SpaceHands, AFaceOfTheCubeHasAMenuOfItsOwn) {
    ShadowCubeView cube;
    cube.back.channel = cube.left.channel = "T";
    showSpace(cube, {640, 480}, [](Session& edited) { vis::orbit(edited.camera, {0, 0}, {0.3f, -0.25f}); });
    const Session before = session();
    const auto inFace = [&](std::size_t index, double s, double t) {
        const vis::WorldFrame world = vis::worldFrame(cellBox(), session().stretch);
        const glm::dvec3 half = world.halfSize + double(view<ShadowCubeView>().gap);
        return pixel(world.toPhysical(
            kCubeFaces[index].at(s * half[kCubeFaces[index].right()], t * half[kCubeFaces[index].up()], half)));
    };
    // The faces that are seen, each by a place of its own.
    std::size_t seenFaces = 0;
    const glm::dvec3 half = vis::worldFrame(cellBox(), session().stretch).halfSize + double(cube.gap);
    for (std::size_t i = 0; i < kCubeFaces.size(); ++i) {
        if (!facesViewer(kCubeFaces[i], half, drawnBy())) continue;
        SCOPED_TRACE(i);
        ++seenFaces;
        const ImVec2 at = inFace(i, 0.6, -0.6);
        moveTo(at);
        EXPECT_FALSE(popup());
        click(at, 1);
        ASSERT_TRUE(popup());
        EXPECT_TRUE(session() == before) << "a click magnifies nothing" << apart(before);
        const Wall former = wallOf(std::as_const(cube), i);
        click(item(popup(), {"##kind"}).GetCenter());
        click(item(popup(), {"Maximum"}).GetCenter());
        EXPECT_EQ(wallOf(view<ShadowCubeView>(), i).kind, WallKind::Maximum);
        click(item(popup(), {"##channel"}).GetCenter());
        click(item(popup(), {"U.y"}).GetCenter());
        EXPECT_EQ(wallOf(view<ShadowCubeView>(), i).channel, "U.y");
        press(key::kEscape);
        EXPECT_FALSE(popup());
        settle();
        EXPECT_EQ(steps(), 2u);
        for (std::size_t k = 0; k < kCubeFaces.size(); ++k)
            if (k != i) {
                EXPECT_TRUE(wallOf(view<ShadowCubeView>(), k) == wallOf(std::as_const(cube), k)) << "one face alone";
            }
        // The title says what it shows, and opens the same menu.
        std::vector<ImVec2> titles;
        for (const DrawnText& text : drawnTexts())
            if (text.text == "maximum U.y") titles.push_back(text.middle());
        ASSERT_EQ(titles.size(), 1u);
        click(titles[0]);
        ASSERT_TRUE(popup());
        click(item(popup(), {"##kind"}).GetCenter());
        click(item(popup(), {"Mean"}).GetCenter());
        EXPECT_EQ(wallOf(view<ShadowCubeView>(), i).kind, WallKind::Mean);
        press(key::kEscape);
        settle();
        expectSame(before.camera);
        for (int step = 0; step < 3; ++step) undo();
        EXPECT_TRUE(session() == before) << apart(before);
        EXPECT_TRUE(wallOf(view<ShadowCubeView>(), i) == former);
        settle();
    }
    EXPECT_EQ(seenFaces, 3u);
    // Beside the cube there is no menu, and a drag magnifies.
    click({picture.Min.x + 3, picture.Min.y + 3}, 1);
    EXPECT_FALSE(popup());
    drag(inFace(4, 0.6, -0.6), inFace(4, 0.6, 0.6), 1);
    EXPECT_FALSE(popup());
    EXPECT_GT(view<ShadowCubeView>().zoom, 1.1f);
}

CompareView twoVariants(CompareMode mode) {
    CompareView compare;
    compare.mode = mode;
    compare.showTable = false;
    compare.variants = {{}, {.name = "other", .changes = {{"/lighting/ambient", "0.5"}}}};
    return compare;
}

TEST_F(SpaceHands, TheSwipeLineGoesWithTheMouse) {
    showSpace(twoVariants(CompareMode::Swipe));
    const Session before = session();
    const auto swipe = [&] { return view<CompareView>().swipe; };
    moveTo(within(picture, 0.5, 0.4));
    EXPECT_TRUE(session() == before);
    button(0, true);
    for (const double share : {0.8, 0.25}) {
        moveTo(within(picture, share, 0.6));
        EXPECT_NEAR(swipe(), (mouse.x - picture.Min.x) / picture.GetWidth(), 1e-6f);
    }
    moveTo({picture.Max.x + 90, mouse.y});
    EXPECT_EQ(swipe(), 1);
    moveTo({picture.Min.x - 90, mouse.y});
    EXPECT_EQ(swipe(), 0);
    moveTo(within(picture, 0.3, 0.5));
    button(0, false);
    expectSame(before.camera);
    settle();
    EXPECT_EQ(steps(), 1u);
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
    const ImVec2 from = within(picture, 0.7, 0.5), to = within(picture, 0.9, 0.4);
    vis::Camera turned = before.camera;
    moveTo(from);
    button(0, true);
    vis::orbit(turned, ndc(from), ndc(to));
    moveTo(to);
    button(0, false);
    expectSame(turned); // beside the line the pictures are turned
    EXPECT_EQ(swipe(), 0.5f);
}

TEST_F(SpaceHands, TheWheelZoomsTheShadowCubeAndTheTesseract) {
    showSpace(ShadowCubeView{});
    const vis::Camera others = camera();
    const auto magnified = [&] { return view<ShadowCubeView>().zoom; };
    moveTo(within(picture, 0.5, 0.5));
    turnWheel(2);
    EXPECT_NEAR(magnified(), 1.15f * 1.15f, 1e-5f) << "away from the hand: nearer";
    turnWheel(-2);
    EXPECT_NEAR(magnified(), 1, 1e-5f);
    moveTo({picture.Max.x + 30, 5});
    turnWheel(1);
    EXPECT_NEAR(magnified(), 1, 1e-5f) << "not over the picture";
    shift = true;
    drag(within(picture, 0.5, 0.5), within(picture, 0.7, 0.5));
    shift = false;
    EXPECT_LT(view<ShadowCubeView>().target.x, -0.05) << "moves the cube to the right";
    expectSame(others); // of other views

    showSpace(TesseractView{}, {500, 500});
    const auto zoom = [&] { return std::get<TesseractView>(session().views.at("pane")).zoom; };
    const float before = zoom();
    moveTo(within(picture, 0.5, 0.5));
    turnWheel(2);
    EXPECT_NEAR(zoom(), before * 1.15f * 1.15f, 1e-5f) << "away from the hand: larger";
    turnWheel(-60);
    EXPECT_EQ(zoom(), 0.2f);
    turnWheel(60);
    EXPECT_EQ(zoom(), 10.0f);
    moveTo({picture.GetCenter().x, picture.Max.y + 20}); // over the sliders
    turnWheel(-1);
    EXPECT_EQ(zoom(), 10.0f);
}

TEST_F(SpaceHands, InALowPictureTheReferenceIsToldByTheTableAlone) {
    for (const int height : {300, 110}) {
        showSpace(twoVariants(CompareMode::Grid), {500, height});
        const std::vector<std::string> words = drawnWords();
        EXPECT_EQ(std::ranges::count(words, "reference"), height > 200) << height;
        EXPECT_EQ(std::ranges::count(words, "other"), 1);
    }
}

TEST_F(SpaceHands, ADragInOnePictureOfAComparisonTurnsAll) {
    showSpace(twoVariants(CompareMode::Grid), {500, 260});
    const std::vector<ImRect> both = pictures();
    ASSERT_EQ(both.size(), 2u);
    for (const ImRect& one : both) {
        picture = one;
        const vis::Camera before = camera();
        const ImVec2 from = within(one, 0.4, 0.6), to = within(one, 0.7, 0.3);
        vis::Camera turned = before;
        moveTo(from);
        button(0, true);
        vis::orbit(turned, ndc(from), ndc(to));
        moveTo(to);
        button(0, false);
        expectSame(turned);
        const float distance = camera().distance;
        turnWheel(1);
        EXPECT_NEAR(camera().distance, distance / 1.15f, 1e-5f);
    }
}

} // namespace
} // namespace tessera::app
