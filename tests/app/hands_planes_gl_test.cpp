#include "app/pane/axes3d.h"
#include "app/pane/oblique_plane.h"
#include "app/planes/plane_picture.h"
#include "app/tools/camera_controller.h"
#include "tests/app/hands_fixture.h"
#include "vis/optics/surface_light.h"

#include <glm/geometric.hpp>

/// The mouse on tilted planes, lights and the point in focus: in volume views, slices and the flat view.
namespace tessera::app {
namespace {

const volume::Box& planesBox() {
    static const glm::dvec3 lo(formula::kOrigin[0], formula::kOrigin[1], formula::kOrigin[2]);
    static const volume::Box box{
        lo, lo + glm::dvec3(formula::kSpacing[0] * 7, formula::kSpacing[1] * 6, formula::kSpacing[2] * 8)};
    return box;
}

ObliqueView tiltedBy(glm::dvec3 normal) {
    ObliqueView view;
    view.normal = normal;
    return view;
}

class TiltedPlaneHands : public Hands {
protected:
    /// A volume view from the front without perspective, with an oblique view beside it that is not drawn.
    void showVolume(const std::function<void(Session&)>& prepare, glm::ivec2 size = {400, 300}) {
        VolumeView volume;
        volume.showGizmo = volume.showLegend = volume.showAxes = false;
        show(volume, size, [&](Session& edited) {
            edited.layers.clear();
            edited.camera = {};
            edited.camera.orientation = glm::quat(1, 0, 0, 0);
            edited.camera.projection = vis::Projection::Orthographic;
            prepare(edited);
        });
        ASSERT_FALSE(pictures().empty());
        picture = pictures().back();
    }
    vis::WorldFrame world() { return vis::worldFrame(planesBox(), session().stretch); }
    SpaceFrame space() {
        return spaceFrame(picture.Min, picture.Max, session().camera, planesBox(), session().stretch);
    }
    ImVec2 pixel(glm::dvec3 physical) { return *space().pixel(physical); }
    ImVec2 worldPixel(glm::dvec3 place) { return pixel(world().toPhysical(place)); }
    glm::dvec3 normal() { return unitNormal(std::get<ObliqueView>(session().views.at("oblique")).normal); }
    /// The tip of an arrow a tenth of the camera's distance long on a plane at a place.
    glm::dvec3 tip(glm::dvec3 at, glm::dvec3 upright) {
        return world().toWorld(at) + upright * (0.1 * double(session().camera.distance));
    }
    ImRect picture;
};

TEST_F(TiltedPlaneHands, TheDotMovesAPlaneAlongItsNormalAndTheArrowTiltsIt) {
    for (const glm::dvec3 stretch : {glm::dvec3(1), glm::dvec3(1, 0.5, 1.5)}) {
        showVolume([&](Session& edited) {
            edited.stretch = stretch;
            edited.views["oblique"] = tiltedBy({0.6, 0.8, 0});
        });
        const Session before = session();
        const glm::dvec3 upright = worldNormal(normal(), world());
        const ImVec2 from = pixel(session().cursor);
        // Up and to the right, as the normal points: the dot stays on its line, below the mouse.
        const float way = 30;
        const ImVec2 to{from.x + way * float(upright.x), from.y - way * float(upright.y)};
        drag(from, to);
        EXPECT_NEAR(pixel(session().cursor).x, to.x, 1.5);
        EXPECT_NEAR(pixel(session().cursor).y, to.y, 1.5);
        const glm::dvec3 moved = world().toWorld(session().cursor) - world().toWorld(before.cursor);
        EXPECT_LT(glm::length(moved - upright * glm::dot(moved, upright)), 1e-9) << "along the normal alone";
        EXPECT_GT(glm::dot(moved, upright), 0.01);
        EXPECT_TRUE(session().views == before.views);
        settle();
        EXPECT_EQ(steps(), 1u);
        undo();
        EXPECT_TRUE(session() == before) << apart(before);

        const glm::dvec3 end = tip(session().cursor, upright);
        const ImVec2 grip = worldPixel(end), aim{grip.x - 14, grip.y + 9};
        drag(grip, aim);
        EXPECT_EQ(session().cursor, before.cursor);
        EXPECT_NEAR(worldPixel(tip(session().cursor, worldNormal(normal(), world()))).x, aim.x, 1.5);
        EXPECT_NEAR(worldPixel(tip(session().cursor, worldNormal(normal(), world()))).y, aim.y, 1.5);
        EXPECT_LT(glm::dot(worldNormal(normal(), world()), upright), 0.99);
        settle();
        EXPECT_EQ(steps(), 1u);
        undo();
        EXPECT_TRUE(session() == before) << apart(before);
        moveTo(grip);
        button(0, true);
        moveTo(aim);
        press(key::kEscape);
        button(0, false);
        EXPECT_TRUE(session() == before) << "Esc gives up" << apart(before);
    }
}

TEST_F(TiltedPlaneHands, ThePlaneStaysInTheBox) {
    showVolume([](Session& edited) { edited.views["oblique"] = tiltedBy({0.6, 0.8, 0}); });
    drag(pixel(session().cursor), {picture.Max.x + 400, picture.Min.y - 400});
    EXPECT_FALSE(planeSection({normal(), session().cursor}, planesBox()).empty()) << "some of it is seen";
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(session().cursor[axis], planesBox().lo[axis]);
        EXPECT_LE(session().cursor[axis], planesBox().hi[axis]);
    }
    EXPECT_GT(session().cursor.x, 0.016);
}

TEST_F(TiltedPlaneHands, ClipPlanesAndSliceLayersAreDraggedToo) {
    showVolume([](Session& edited) {
        edited.clips = {{.center = {0.5f, 0.5f, 0.5f}, .axis = {1, 0, 0}}};
        edited.layers = {
            {.name = "",
             .visible = true,
             .technique = vis::SliceLayer{
                 .channel = "T", .orientation = vis::SliceOrientation::Y, .atCursor = false, .position = 0.25}}};
    });
    const Session before = session();
    const glm::dvec3 size = planesBox().size(), middle = planesBox().center();
    drag(pixel(middle), {pixel(middle).x + 30, pixel(middle).y + 7});
    const auto& clip = [this]() -> const vis::Clip& { return session().clips[0]; };
    glm::dvec3 to = planesBox().lo + glm::dvec3(clip().center) * size;
    EXPECT_NEAR(pixel(to).x, pixel(middle).x + 30, 1.5) << "along its normal, x";
    EXPECT_NEAR(clip().center.y, 0.5, 1e-6);
    session() = before;
    frame();
    // A slice across y: its dot lies in its middle, and moves with the mouse upwards.
    const glm::dvec3 own{middle.x, planesBox().lo.y + 0.25 * size.y, middle.z};
    drag(pixel(own), {pixel(own).x + 11, pixel(own).y - 25});
    const double position = std::get<vis::SliceLayer>(session().layers[0].technique).position;
    to = {middle.x, planesBox().lo.y + position * size.y, middle.z};
    EXPECT_NEAR(pixel(to).y, pixel(own).y - 25, 1.5);
    EXPECT_TRUE(session().clips == before.clips);
    session() = before;
    frame();
    const ImVec2 grip = worldPixel(tip(middle, {1, 0, 0}));
    drag(grip, {grip.x - 6, grip.y - 12});
    EXPECT_GT(clip().axis.y, 0.2f) << "the arrow of a clip tilts it";
    EXPECT_EQ(clip().center, before.clips[0].center);
}

TEST_F(TiltedPlaneHands, ArrowsOfLightsTurnThemAndPointsMove) {
    showVolume([](Session& edited) {
        edited.camera.orientation = glm::normalize(glm::quat(0.9f, 0.1f, 0.3f, 0.05f));
        edited.lighting.lights = {{.kind = vis::LightKind::Viewer, .azimuth = -30, .elevation = 40},
                                  {.kind = vis::LightKind::World, .azimuth = 60, .elevation = -20},
                                  {.kind = vis::LightKind::Point, .position = {0.2f, -0.3f, 0.1f}}};
    });
    const Session before = session();
    const double radius =
        0.72 * double(session().camera.distance) * std::tan(glm::radians(double(session().camera.fieldOfView)) / 2);
    const auto at = [&](std::size_t i) {
        const vis::Light& light = session().lighting.lights[i];
        return i == 2 ? glm::dvec3(light.position) : vis::lightDirection(light, session().camera) * radius;
    };
    const ImVec2 hidden = worldPixel(at(0));
    drag(hidden, {hidden.x + 20, hidden.y});
    EXPECT_TRUE(session().lighting == before.lighting) << "without its handles a light stays";
    session() = before;
    view<VolumeView>().showLights = true;
    settle();
    const vis::Lighting lighting = session().lighting;
    for (std::size_t i = 0; i < 3; ++i) {
        SCOPED_TRACE(i);
        const ImVec2 from = worldPixel(at(i)), to{std::floor(from.x) - 14, std::floor(from.y) + 10};
        drag(from, to);
        EXPECT_NEAR(worldPixel(at(i)).x, to.x, 1.5);
        EXPECT_NEAR(worldPixel(at(i)).y, to.y, 1.5);
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_EQ(session().lighting.lights[k] == lighting.lights[k], k != i) << "one light alone";
        settle();
        undo();
        EXPECT_TRUE(session().lighting == lighting);
    }
    // Past the outline of the ball a light goes behind the data, and shines from there.
    const ImVec2 from = worldPixel(at(0)), middle = worldPixel(glm::dvec3(0));
    const glm::dvec2 out = glm::normalize(glm::dvec2(from.x - middle.x, from.y - middle.y));
    const float far = 1.3f *
                      float(radius / (double(session().camera.distance) *
                                      std::tan(glm::radians(double(session().camera.fieldOfView)) / 2))) *
                      picture.GetHeight() / 2;
    drag(from, {middle.x + far * float(out.x), middle.y + far * float(out.y)});
    EXPECT_GT(std::abs(session().lighting.lights[0].azimuth), 90.0f);
}

TEST_F(TiltedPlaneHands, InSlicesAPlaneIsALineWithAnArrow) {
    SlicesView slices;
    slices.channel = "T";
    slices.showReadout = false;
    show(slices, {460, 420}, [](Session& edited) {
        edited.views["oblique"] = tiltedBy({0.6, 0.8, 0});
        edited.stretch = {1, 0.5, 1};
    });
    const ImRect plane = pictures()[0]; // x to the right, y up
    const Session before = session();
    const glm::dvec3 upright = worldNormal(normal(), world());
    const glm::dvec3 end = world().toPhysical(tip(session().cursor, upright));
    const auto place = [&](glm::dvec3 at) {
        return within(plane, (at.x - extent(0).lo) / (extent(0).hi - extent(0).lo),
                      1 - (at.y - extent(1).lo) / (extent(1).hi - extent(1).lo));
    };
    const ImVec2 grip = place(end);
    drag(grip, {grip.x + 12, grip.y + 18});
    EXPECT_EQ(session().cursor, before.cursor);
    const glm::dvec3 now = worldNormal(normal(), world());
    EXPECT_NEAR(now.z, 0, 1e-6) << "turned within the slice";
    const ImVec2 tipNow = place(world().toPhysical(tip(session().cursor, now))), middle = place(session().cursor);
    EXPECT_NEAR(std::atan2(tipNow.y - middle.y, tipNow.x - middle.x),
                std::atan2(grip.y + 18 - middle.y, grip.x + 12 - middle.x), 0.06);
    settle();
    EXPECT_EQ(steps(), 1u);
}

TEST_F(TiltedPlaneHands, InTheFlatViewTheCrossHairStaysInThePlaneAndTheWheelMovesIt) {
    ObliqueView view;
    view.channel = "T";
    view.showReadout = false;
    view.normal = {-0.8, 0, 0.6};
    show(view, {420, 380});
    const ImRect flat = pictures().back();
    const Session before = session();
    const glm::dvec3 n = unitNormal(view.normal), right{0.6, 0, 0.8}, up{0, 1, 0};
    const glm::dvec3 start = session().cursor;
    // The plane runs through the whole of y; a margin of two per cent is added on either side.
    const double perPixel = 1.04 * (extent(1).hi - extent(1).lo) / double(flat.GetHeight());
    moveTo(within(flat, 0.5, 0.5));
    button(0, true);
    const glm::dvec3 first = session().cursor;
    moveTo({mouse.x + 20, mouse.y - 30});
    button(0, false);
    const glm::dvec3 moved = session().cursor - first;
    EXPECT_NEAR(glm::dot(session().cursor - start, n), 0, 1e-10);
    EXPECT_NEAR(glm::dot(moved, up), 30 * perPixel, 2 * perPixel);
    EXPECT_NEAR(glm::dot(moved, right), 20 * perPixel, 2 * perPixel);
    settle();
    EXPECT_EQ(steps(), 1u);
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
    moveTo(within(flat, 0.5, 0.5));
    turnWheel(1);
    const double step =
        1 / glm::length(n / glm::dvec3(formula::kSpacing[0], formula::kSpacing[1], formula::kSpacing[2]));
    EXPECT_NEAR(glm::dot(session().cursor - start, n), step, 1e-9) << "by one sample";
    EXPECT_LT(glm::length(session().cursor - start - n * step), 1e-9);
    for (int i = 0; i < 40; ++i) turnWheel(3);
    EXPECT_FALSE(planeSection({n, session().cursor}, planesBox()).empty()) << "not out of the box";
}

TEST_F(TiltedPlaneHands, ItIsTiltedByNumbersLikeAnySetting) {
    show(tiltedBy({-0.8, 0, 0.6}), {520, 460});
    click(inPane({"Tilt"}).GetCenter());
    ASSERT_TRUE(popup());
    const ImRect x = item(popup(), {"/normal", "##normal", 0, ""}), y = item(popup(), {"/normal", "##normal", 1, ""});
    EXPECT_GT(x.GetWidth(), 40) << "readable";
    drag(x.GetCenter(), within(x, 0.75, 0.5));
    const glm::dvec3 tilted = view<ObliqueView>().normal;
    EXPECT_NEAR(tilted.x, 0.5, 0.15);
    EXPECT_EQ(tilted.z, 0.6);
    drag(y.GetCenter(), {y.Max.x + 300, y.GetCenter().y});
    EXPECT_EQ(view<ObliqueView>().normal.y, 1) << "within its range";
    settle();
    EXPECT_EQ(steps(), 2u);
}

/// Pixels of a colour in a part of the picture, each part of the colour within a few steps.
std::size_t pixelsOf(const vis::Image& image, const ImRect& in, glm::ivec3 color) {
    std::size_t found = 0;
    for (int y = int(in.Min.y); y < int(in.Max.y); ++y)
        for (int x = int(in.Min.x); x < int(in.Max.x); ++x) {
            const std::uint8_t* pixel = &image.rgba[std::size_t(4 * (y * image.size.x + x))];
            found += std::abs(pixel[0] - color.r) + std::abs(pixel[1] - color.g) + std::abs(pixel[2] - color.b) < 60;
        }
    return found;
}

TEST_F(TiltedPlaneHands, TheFlatViewShowsWhatCrossesItAndTheValuesOfItsLines) {
    ObliqueView oblique = tiltedBy({-0.8, 0, 0.6});
    oblique.channel = "T";
    oblique.showReadout = false;
    show(oblique, {520, 460});
    const ImRect flat = pictures().back();
    const glm::ivec3 red(230, 0, 230), blue(0, 230, 0);
    const auto count = [&](glm::ivec3 color) {
        settle();
        return pixelsOf(frames->read(), flat, color);
    };
    EXPECT_EQ(count(red), 0u);
    EXPECT_EQ(count(blue), 0u);
    const glm::dvec3 size = planesBox().size();
    session().selection.brushes.resize(1);
    session().selection.brushes[0].color = {1, 0, 1};
    session().selection.brushes[0].region = vis::SphereRegion{.center = session().cursor, .radius = 0.2 * size};
    EXPECT_GT(count(red), 60u) << "the border of the brush";
    session().lenses = {vis::Lens{}};
    session().lenses[0].color = {0, 1, 0};
    session().lenses[0].center = session().cursor;
    session().lenses[0].effect = vis::LensEffect::Magnify; // shows no parameter of its own
    EXPECT_GT(count(blue), 40u) << "the lens";
    session().selection.brushes.clear();
    session().lenses.clear();
    const auto shown = [&] {
        settle();
        return frames->read();
    };
    const auto changed = [&](const vis::Image& a, const vis::Image& b) {
        std::size_t found = 0;
        for (int y = int(flat.Min.y); y < int(flat.Max.y); ++y)
            for (int x = int(flat.Min.x); x < int(flat.Max.x); ++x) {
                const std::size_t at = std::size_t(4 * (y * a.size.x + x));
                found += std::abs(a.rgba[at] - b.rgba[at]) + std::abs(a.rgba[at + 1] - b.rgba[at + 1]) > 60;
            }
        return found;
    };
    const vis::Image plain = shown();
    ContourSettings& lines = view<ObliqueView>().lines;
    lines = {.count = 8, .channel = "U.x", .values = false};
    const vis::Image lined = shown();
    EXPECT_GT(changed(plain, lined), 300u) << "lines of another parameter";
    lines.values = true;
    EXPECT_GT(changed(lined, shown()), 100u) << "texts on them";
    lines.channel.clear();
    EXPECT_GT(changed(lined, shown()), 300u) << "those of the parameter shown lie elsewhere";
}

TEST_F(TiltedPlaneHands, InTheFlatViewALensIsDraggedByItsMiddleAlongThePlane) {
    show(tiltedBy({-0.8, 0, 0.6}), {520, 460}, [](Session& edited) {
        edited.lenses = {vis::Lens{}};
        edited.lenses[0].center = edited.cursor;
    });
    const ImRect flat = pictures().back();
    const Session before = session();
    const PlanePicture slice = tiltedPlane(before, workbench.source()->info(), {-0.8, 0, 0.6}, {});
    const auto pixelOf = [&](glm::dvec3 place) {
        const glm::dvec2 at = slice.along(place);
        return within(flat, (at.x - slice.x.lo) / (slice.x.hi - slice.x.lo),
                      1 - (at.y - slice.y.lo) / (slice.y.hi - slice.y.lo));
    };
    const ImVec2 from = pixelOf(before.cursor);
    drag(from, {from.x + 24, from.y - 16});
    const glm::dvec3 center = session().lenses[0].center;
    EXPECT_EQ(session().cursor, before.cursor);
    EXPECT_NEAR(slice.plane.plane().distance(center), 0, 1e-9) << "in the plane it was in";
    EXPECT_NEAR(pixelOf(center).x, from.x + 24, 2);
    EXPECT_NEAR(pixelOf(center).y, from.y - 16, 2);
    settle();
    EXPECT_EQ(steps(), 1u);
    drag(within(flat, 0.25, 0.8), within(flat, 0.35, 0.8));
    EXPECT_NE(session().cursor, before.cursor) << "elsewhere the cross-hair goes along";
    EXPECT_EQ(session().lenses[0].center, center);
    // Its squares stand at the ends of its own axes; y runs upwards. The longest edge of the data is 12 mm.
    const double radius = double(session().lenses[0].size.y) * 0.012;
    const ImVec2 middle = pixelOf(center), top = pixelOf(center + glm::dvec3(0, radius, 0));
    moveTo({middle.x + 12, middle.y + 12});
    drag(top, {top.x + 2, top.y + (middle.y - top.y) / 3});
    EXPECT_NEAR(double(session().lenses[0].size.y) * 0.012, radius * 2 / 3, radius * 0.03);
    EXPECT_EQ(session().lenses[0].center, center);
    moveTo({middle.x + 4, middle.y + 4});
    press('F');
    moveTo({middle.x - 30, middle.y + 20});
    const glm::dvec3 followed = session().lenses[0].center;
    EXPECT_NEAR(slice.plane.plane().distance(followed), 0, 1e-9);
    EXPECT_NEAR(pixelOf(followed).x, mouse.x, 1.5);
    EXPECT_NEAR(pixelOf(followed).y, mouse.y, 1.5);
    press('F');
}

TEST_F(TiltedPlaneHands, InTheFlatViewSeedsLinesAndBrushesAreDraggedByTheirDots) {
    const glm::dvec3 upright{-0.8, 0, 0.6}, size = planesBox().size();
    show(tiltedBy(upright), {520, 460}, [&](Session& edited) {
        vis::FlowLayer flow;
        flow.channel = "U";
        flow.seeds = volume::SeedShape::Line;
        flow.from = {0.3f, 0.3f, 0.3f};
        flow.to = {0.6f, 0.7f, 0.5f};
        edited.layers = {{"flow", true, flow}};
        edited.selection.brushes.resize(1);
        edited.selection.brushes[0].region =
            vis::SphereRegion{.center = edited.cursor + 0.15 * size, .radius = 0.2 * size};
        ProfileView line;
        line.points = {planesBox().lo + 0.2 * size, planesBox().lo + glm::dvec3(0.3, 0.9, 0.7) * size};
        edited.views["line"] = line;
    });
    const ImRect flat = pictures().back();
    const PlanePicture slice = tiltedPlane(session(), workbench.source()->info(), upright, {});
    const auto pixelOf = [&](glm::dvec3 place) {
        const glm::dvec2 at = slice.along(place);
        return within(flat, (at.x - slice.x.lo) / (slice.x.hi - slice.x.lo),
                      1 - (at.y - slice.y.lo) / (slice.y.hi - slice.y.lo));
    };
    const glm::dvec3 cursor = session().cursor;
    /// Drags a dot, and says where it must be then: moved along the plane alone.
    const auto dragDot = [&](const std::function<glm::dvec3()>& dot, const char* what) {
        const glm::dvec3 before = dot();
        const ImVec2 from = pixelOf(before);
        drag(from, {from.x + 22, from.y - 14});
        EXPECT_NEAR(pixelOf(dot()).x, from.x + 22, 1.5) << what;
        EXPECT_NEAR(pixelOf(dot()).y, from.y - 14, 1.5) << what;
        EXPECT_NEAR(slice.plane.plane().distance(dot()), slice.plane.plane().distance(before), 1e-6 * glm::length(size))
            << what;
        EXPECT_EQ(session().cursor, cursor) << what;
    };
    dragDot(
        [&] { return planesBox().lo + glm::dvec3(std::get<vis::FlowLayer>(session().layers[0].technique).to) * size; },
        "the end of a line of seeds");
    dragDot([&] { return std::get<ProfileView>(session().views.at("line")).points[1]; }, "the end of a profile line");
    const auto ball = [&] { return std::get<vis::SphereRegion>(session().selection.brushes[0].region); };
    dragDot([&] { return ball().center; }, "the middle of a brush");
    const vis::SphereRegion before = ball();
    const ImVec2 end = pixelOf(before.center + glm::dvec3(0, before.radius.y, 0)); // y runs upwards
    drag(end, {end.x + 9, end.y - 20});
    EXPECT_NEAR(pixelOf(ball().center + glm::dvec3(0, ball().radius.y, 0)).y, end.y - 20, 1.5);
    EXPECT_EQ(ball().center, before.center);
    EXPECT_EQ(ball().radius.x, before.radius.x);
    const ImVec2 slant = pixelOf(ball().center + glm::dvec3(0, 0, ball().radius.z)), // z runs aslant
        middle = pixelOf(ball().center);
    drag(slant, {slant.x + (slant.x - middle.x) * 0.5f, slant.y});
    EXPECT_NEAR(ball().radius.z, before.radius.z * 1.5, before.radius.z * 0.08)
        << "it follows the mouse, not the plane";
    settle();
    EXPECT_EQ(steps(), 5u);
}

TEST_F(TiltedPlaneHands, TheCommandTiltsEveryObliqueSliceToTheViewer) {
    showVolume([](Session& edited) {
        edited.camera.orientation = glm::normalize(glm::quat(0.9f, 0.2f, 0.3f, 0.1f));
        edited.stretch = {1, 0.5, 1.5};
        edited.views["oblique"] = ObliqueView{};
    });
    const auto run = [&](const std::string& name) {
        for (const Command& command : workbench.commands())
            if (command.title() == name) {
                ASSERT_TRUE(command.available()) << name;
                command.run();
                return settle();
            }
        ADD_FAILURE() << name;
    };
    run("Face oblique slices to the viewer");
    EXPECT_LT(glm::length(worldNormal(normal(), world()) + vis::forwardOf(session().camera)), 1e-6);
    run("Show handles of lights");
    EXPECT_TRUE(view<VolumeView>().showLights);
    EXPECT_EQ(session().camera.aperture, 0);
    run("Focus on the cross-hair");
    EXPECT_GT(session().camera.aperture, 0);
    EXPECT_LT(glm::length(world().toPhysical(glm::dvec3(session().camera.focus)) - session().cursor), 1e-8);
    run("Depth of field");
    EXPECT_EQ(session().camera.aperture, 0) << "off again";
    session().views.erase("oblique");
    run("Face oblique slices to the viewer");
    EXPECT_TRUE(session().views.contains("oblique")) << "opened where there was none";
}

// Items after the one that closes the menu are drawn once more.
TEST_F(TiltedPlaneHands, EveryItemAndEscCloseTheMenuOfThePicture) {
    showVolume([](Session&) {}, {320, 800}); // the whole menu has room
    for (const char* const name : {"Reset view", "Parallel projection", "Depth of field", ""}) {
        click(within(picture, 0.4, 0.45), 1);
        ASSERT_TRUE(popup()) << name;
        if (*name != 0)
            click(item(popup(), {name}).GetCenter());
        else
            press(key::kEscape);
        for (int i = 0; i < 3; ++i) frame();
        EXPECT_FALSE(popup()) << name;
    }
    EXPECT_EQ(session().camera.projection, vis::Projection::Perspective) << "it was parallel";
    EXPECT_GT(session().camera.aperture, 0);
}

TEST_F(TiltedPlaneHands, AClickInTheMenuFocusesOnWhatIsSeenThere) {
    showVolume(
        [](Session& edited) {
            edited.layers = {
                {.name = "",
                 .visible = true,
                 .technique = vis::SliceLayer{
                     .channel = "T", .orientation = vis::SliceOrientation::Z, .atCursor = false, .position = 0.75}}};
        },
        {320, 800}); // the whole menu has room
    const glm::dvec3 size = planesBox().size(), lo = planesBox().lo;
    const ImVec2 at = within(picture, 0.4, 0.45);
    click(at, 1);
    ASSERT_TRUE(popup());
    click(item(popup(), {"Focus here"}).GetCenter());
    for (int i = 0; i < 3; ++i) frame(); // its 64 pictures are not waited for
    EXPECT_GT(session().camera.aperture, 0);
    const glm::dvec3 place = world().toPhysical(glm::dvec3(session().camera.focus));
    EXPECT_NEAR(place.z, lo.z + 0.75 * size.z, 1e-3 * size.z) << "on the slice";
    EXPECT_NEAR(pixel(place).x, at.x, 1.5);
    EXPECT_NEAR(pixel(place).y, at.y, 1.5);
    EXPECT_EQ(steps(), 1u);
    // The point in focus has a dot.
    const ImVec2 from = pixel(place);
    drag(from, {from.x + 25, from.y - 10});
    const glm::dvec3 moved = world().toPhysical(glm::dvec3(session().camera.focus));
    EXPECT_NEAR(pixel(moved).x, from.x + 25, 1.5);
    EXPECT_NEAR(pixel(moved).y, from.y - 10, 1.5);
}

} // namespace
} // namespace tessera::app
