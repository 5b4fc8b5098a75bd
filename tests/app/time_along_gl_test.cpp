#include "app/pane/axes3d.h"
#include "app/tools/camera_controller.h"
#include "app/ui/time_text.h"
#include "app/views/curves/profile_data.h"
#include "app/views/volume/space_beside.h"
#include "app/workbench/fit_box.h"
#include "tests/app/views_fixture.h"
#include "tests/app/workbench_fixture.h"
#include "volume/sources/plane_source.h"

#include <algorithm>
#include <cmath>
#include <imgui_internal.h>

/// Data whose times run along an axis, with the data in space beside them.
namespace tessera::app {
namespace {

struct TimeAlong : ViewsTest {
    void SetUp() override {
        ViewsTest::SetUp();
        space = fuelCell(volume::LatticeKind::CC);
        show(volume::makePlaneSource(space, cut));
        session.data.timeAxis = cut;
        view.inSpace = true;
    }
    template <class View>
    void drawCut(View& shown, void (*function)(ViewContext&, const std::string&, View&), ImVec2 size) {
        frame([&] {
            ViewContext context{session, source, renderer, jobs, caches};
            context.origin.spaceOfPlane = space;
            context.headless = true;
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize(size);
            ImGui::Begin("view", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
            function(context, "view", shown);
            ImGui::End();
            messages.insert(messages.end(), context.answers.messages.begin(), context.answers.messages.end());
        });
    }

    volume::TimeAxis cut{volume::SpaceAxis::Z, 0.25};
    std::shared_ptr<const volume::BrickSource> space;
    VolumeView view;
};

TEST_F(TimeAlong, TheCrossHairIsATimeInOneAndAPlaceInTheOther) {
    const volume::DatasetInfo &along = source->info(), &whole = space->info();
    const double perLength = along.plane->timePerLength;
    session.cursor = along.bounds.center();
    session.cursor.z = 0.25 * whole.times.back() / perLength;
    session.selection.brushes = {vis::rangeBrush({{"T", 300, 350, 0}}), vis::Brush{},
                                 vis::rangeBrush({{"time", 0, 1, 0}})};
    session.selection.brushes[1].region = vis::BoxRegion{};
    const Session inner = sessionInSpace(session, along, whole);
    EXPECT_NEAR(inner.time, 0.25 * whole.times.back(), 1e-9);
    EXPECT_NEAR(inner.cursor.z, whole.bounds.lo.z + 0.25 * whole.bounds.size().z, 1e-12);
    EXPECT_EQ(inner.cursor.x, session.cursor.x);
    ASSERT_EQ(inner.selection.brushes.size(), 1u) << "a box of times and the parameter time are not of space";
    EXPECT_EQ(inner.selection.brushes[0].region, session.selection.brushes[0].region);
    // A spot that is gone to in space moves the plane, and leaves the time as it is.
    Session edited = inner;
    edited.cursor.x = whole.bounds.hi.x;
    edited.cursor.z = whole.bounds.hi.z;
    edited.camera.distance *= 2;
    const double time = session.cursor.z;
    takeFromSpace(session, inner, edited, along, whole);
    EXPECT_EQ(session.cursor.x, whole.bounds.hi.x);
    EXPECT_EQ(session.cursor.z, time);
    EXPECT_EQ(session.data.timeAxis->place, 1);
    EXPECT_EQ(session.camera, edited.camera);
    EXPECT_EQ(session.selection.brushes.size(), 3u);
}

TEST_F(TimeAlong, ThePlaneIsMovedByItsDotInSpace) {
    const ImVec2 size{600, 500};
    const volume::Box& box = space->info().bounds;
    const vis::WorldFrame world = vis::worldFrame(box, session.stretch);
    const ImVec2 pad = ImGui::GetStyle().WindowPadding;
    const ImVec2 hi{size.x - pad.x, size.y - pad.y};
    lookAlong(session.camera, vis::StandardView::Right, world, (hi.x - pad.x) / (hi.y - pad.y)); // z lies level
    const auto pixelAt = [&](double place) {
        glm::dvec3 at = box.center();
        at.z = box.lo.z + place * box.size().z;
        return *spaceFrame(pad, hi, session.camera, box, session.stretch).pixel(at);
    };
    for (int i = 0; i < 2; ++i) drawCut(view, drawVolumeView, size);
    ASSERT_EQ(session.data.timeAxis->place, 0.25);
    const vis::Camera camera = session.camera;
    mouse = pixelAt(0.25);
    drawCut(view, drawVolumeView, size);
    ImGui::GetIO().MouseDown[0] = true;
    drawCut(view, drawVolumeView, size);
    mouse = pixelAt(0.75);
    drawCut(view, drawVolumeView, size);
    EXPECT_NEAR(session.data.timeAxis->place, 0.75, 0.02);
    ImGui::GetIO().MouseDown[0] = false;
    drawCut(view, drawVolumeView, size);
    drawCut(view, drawVolumeView, size);
    EXPECT_NEAR(session.data.timeAxis->place, 0.75, 0.02);
    EXPECT_EQ(session.camera, camera) << "the drag is not the camera's";
    EXPECT_TRUE(messages.empty());
    // The view of the plane itself has no such dot: the same drag turns the camera.
    view.inSpace = false;
    for (int i = 0; i < 2; ++i) drawCut(view, drawVolumeView, size);
    mouse = pixelAt(0.75);
    drawCut(view, drawVolumeView, size);
    ImGui::GetIO().MouseDown[0] = true;
    drawCut(view, drawVolumeView, size);
    mouse = pixelAt(0.5);
    drawCut(view, drawVolumeView, size);
    ImGui::GetIO().MouseDown[0] = false;
    drawCut(view, drawVolumeView, size);
    EXPECT_NEAR(session.data.timeAxis->place, 0.75, 0.02);
    EXPECT_FALSE(session.camera == camera);
}

TEST_F(TimeAlong, TheSliderOfTheTimelineSaysWhereThePlaneLies) {
    const ImVec2 size{1200, 100};
    TimelineView timeline;
    for (int i = 0; i < 2; ++i) drawCut(timeline, drawTimelineView, size);
    const ImGuiID slider = ImGui::FindWindowByName("view")->GetID("##place");
    float from = -1, to = -1;
    mouse.y = ImGui::GetStyle().WindowPadding.y + ImGui::GetFrameHeight() / 2;
    for (float x = 0; x < size.x; x += 2) {
        mouse.x = x;
        drawCut(timeline, drawTimelineView, size);
        if (ImGui::GetHoveredID() != slider) continue;
        if (from < 0) from = x;
        to = x;
    }
    ASSERT_GT(to - from, 40) << "the slider is there";
    const auto dragTo = [&](float share, bool down) {
        mouse.x = from + (to - from) * share;
        ImGui::GetIO().MouseDown[0] = down;
        drawCut(timeline, drawTimelineView, size);
    };
    dragTo(0.5f, true);
    dragTo(0.8f, true);
    EXPECT_NEAR(session.data.timeAxis->place, 0.8, 0.04);
    dragTo(1, true);
    dragTo(1, false);
    EXPECT_EQ(session.data.timeAxis->place, 1);
    EXPECT_EQ(session.data.timeAxis->axis, volume::SpaceAxis::Z);
}

TEST_F(TimeAlong, ProfilesAlongTimeAreInItsUnit) {
    const volume::DatasetInfo& info = source->info();
    const glm::dvec3 middle = info.bounds.center();
    const auto alongAxis = [&](int axis) {
        ProfileQuery query{.over = ProfileOver::Line, .channels = {0}, .corners = {middle, middle}, .samples = 5};
        query.corners[0][axis] = info.bounds.lo[axis];
        query.corners[1][axis] = info.bounds.hi[axis];
        return readProfile(*source, query);
    };
    const std::vector<double>& times = space->info().times;
    const Profile profile = alongAxis(2);
    const LineAxis time = lineAxis(session, info, profile);
    EXPECT_EQ(time.title, timeWord(info));
    EXPECT_EQ(time.unit, info.timeUnit);
    ASSERT_EQ(time.unit, "s");
    ASSERT_EQ(time.values.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i)
        EXPECT_NEAR(time.values[i], times.front() + (times.back() - times.front()) * double(i) / 4, 1e-9);
    const std::string csv = csvOf(profileTable(info, session, profile)), word = timeWord(info) + " [s],";
    const auto length = [&](const char* name) { return titleWithUnit(name, info.lengthUnit) + ","; };
    EXPECT_TRUE(csv.starts_with(word + length("x") + length("y") + length("z") + word)) << csv;
    const LineAxis across = lineAxis(session, info, alongAxis(1));
    EXPECT_EQ(across.title, "distance");
    EXPECT_TRUE(across.unit == "mm" || across.unit == "um" || across.unit == "cm") << across.unit;
    EXPECT_NEAR(across.values[4] / across.values[2], 2, 1e-9);
    volume::DatasetInfo lengths = info; // the same numbers as lengths
    lengths.plane.reset();
    EXPECT_EQ(lineAxis(session, lengths, profile).title, "distance");
}

TEST_F(TimeAlong, APlaneThatMovesIsDraggedWhereItIsAtTheTimeShown) {
    cut = {volume::SpaceAxis::Z, 0.5, 60, 0.5};
    show(volume::makePlaneSource(space, cut));
    session.data.timeAxis = cut;
    const volume::DatasetInfo& whole = space->info();
    const volume::Box& box = whole.bounds;
    session.cursor = source->info().bounds.lo + glm::dvec3(0.5, 0.5, 0.75) * source->info().bounds.size();
    const double now = whole.times.front() + 0.75 * (whole.times.back() - whole.times.front());
    const auto shareNow = [&] {
        const volume::SpaceTimePlane plane = volume::planeOf(whole, *session.data.timeAxis);
        return (-(plane.normal.w * now + plane.e) / plane.normal.z - box.lo.z) / box.size().z;
    };
    ASSERT_NEAR(shareNow(), 0.5 + 0.25 / std::tan(std::acos(-1) / 3), 1e-9);
    const ImVec2 size{600, 500}, pad = ImGui::GetStyle().WindowPadding, hi{size.x - pad.x, size.y - pad.y};
    lookAlong(session.camera, vis::StandardView::Right, vis::worldFrame(box, session.stretch),
              (hi.x - pad.x) / (hi.y - pad.y)); // z lies level
    const auto goTo = [&](double place, bool down) {
        glm::dvec3 at = box.center();
        at.z = box.lo.z + place * box.size().z;
        mouse = *spaceFrame(pad, hi, session.camera, box, session.stretch).pixel(at);
        ImGui::GetIO().MouseDown[0] = down;
        drawCut(view, drawVolumeView, size);
    };
    for (int i = 0; i < 2; ++i) drawCut(view, drawVolumeView, size);
    goTo(shareNow(), false);
    goTo(shareNow(), true);
    goTo(0.8, true);
    goTo(0.8, false);
    EXPECT_NEAR(shareNow(), 0.8, 0.02);
    EXPECT_EQ(session.data.timeAxis->degrees, 60) << "not turned";
}

struct TimeAlongWorkbench : DrawnWorkbench {
    void SetUp() override {
        OpenRequest request;
        request.data.emplace();
        request.data->model = "fuel-cell";
        request.data->settings = {{"nx", 9}, {"ny", 9}, {"nz", 25}, {"times", 3}};
        request.data->lattice = PictureLattice::Grid;
        workbench.install(open(request));
        settle();
    }
    std::string besidePane() const {
        for (const auto& [pane, view] : workbench.session().views)
            if (const auto* volume = std::get_if<VolumeView>(&view); volume && volume->inSpace) return pane;
        return {};
    }
    /// One pane alone, without anything drawn over the picture.
    vis::Image pictureOf(const std::string& pane) {
        auto& view = std::get<VolumeView>(workbench.session().views.at(pane));
        view.showBox = view.showAxes = view.showLegend = view.showCursor = view.showGizmo = view.showScaleBar =
            view.showLenses = false;
        workbench.session().dock.maximised = pane;
        settle();
        return frames.read();
    }
    /// Share of the pixels between the texts at the top and the status line that differ.
    static double differing(const vis::Image& a, const vis::Image& b) {
        EXPECT_EQ(a.size, b.size);
        std::size_t count = 0, all = 0;
        const std::size_t row = std::size_t(a.size.x) * 4;
        for (std::size_t i = row * 90; i < std::min(a.rgba.size(), b.rgba.size()) - row * 40; i += 4, ++all)
            count += std::abs(a.rgba[i] - b.rgba[i]) + std::abs(a.rgba[i + 1] - b.rgba[i + 1]) > 16;
        return double(count) / double(all);
    }
};

/// Half the width of what the box covers of the picture of a pane, as a share of it.
double coveredWidth(Workbench& workbench, const std::string& pane) {
    const Session& session = workbench.session();
    const vis::WorldFrame world = vis::worldFrame(workbench.document().info(), session.stretch);
    const ImGuiWindow* const window = ImGui::FindWindowByName(("###pane." + pane).c_str());
    if (!window || !window->WasActive) return 0;
    return boxExtent(session.camera, world).x * double(window->Size.y) / double(window->Size.x);
}

TEST_F(TimeAlongWorkbench, TheBoxIsWholeInBothHalvesOfThePane) {
    const vis::WorldFrame world = vis::worldFrame(workbench.document().info(), workbench.session().stretch);
    fitToPane(workbench.session(), "volume", world, 1);
    settle();
    const vis::Camera wide = workbench.session().camera;
    EXPECT_LE(coveredWidth(workbench, "volume"), 1);
    EXPECT_GT(coveredWidth(workbench, "volume"), 0.5);
    ASSERT_TRUE(run("Time along z"));
    settle();
    const std::string beside = besidePane();
    for (const std::string& pane : {std::string("volume"), beside}) {
        EXPECT_LE(coveredWidth(workbench, pane), 1) << pane;
        EXPECT_GT(coveredWidth(workbench, pane), 0.5) << pane;
    }
    EXPECT_LT(workbench.session().camera.distance, 1.3f * wide.distance) << "a long box in panes below each other";
    ASSERT_TRUE(run("Time along z")); // back to one pane, as large as it was
    settle();
    EXPECT_NEAR(workbench.session().camera.distance, wide.distance, 0.15f * wide.distance);
    // A camera that saw a part of the box goes on to see that part.
    workbench.session().camera.distance = 0.4f;
    settle();
    const vis::Camera close = workbench.session().camera;
    ASSERT_TRUE(run("Time along z"));
    settle();
    EXPECT_EQ(workbench.session().camera, close);
}

// The bars of the window and the tabs grow with the scale, and the panes are left less room.
TEST_F(TimeAlongWorkbench, AScaleThatALayoutBringsIsThatOfThePanesItIsFittedTo) {
    const volume::DatasetInfo info = workbench.document().info();
    const auto fitted = [&](Session next) {
        next.camera.distance = 0.2f;
        const WindowLook& look = workbench.look();
        showWholeBox(next, info, look.scale(), look.scaleWith(next.appearance));
        return next;
    };
    Session next = workbench.session();
    next.appearance.scale = 2.5f;
    const Session before = fitted(next);
    EXPECT_GT(std::abs(before.camera.distance / fitted(workbench.session()).camera.distance - 1), 0.05)
        << "the scale matters";
    workbench.session() = before;
    settle();
    ASSERT_NEAR(workbench.look().scale(), 2.5f, 1e-6);
    EXPECT_NEAR(before.camera.distance, fitted(before).camera.distance, 0.02f * before.camera.distance);
    EXPECT_LE(coveredWidth(workbench, "volume"), 1.02);
}

TEST_F(TimeAlongWorkbench, ACrossHairOutsideOfTheBoxCutsAtItsEnd) {
    const volume::Box box = workbench.document().info().bounds;
    workbench.session().cursor.z = box.lo.z - 0.2 * box.size().z;
    ASSERT_TRUE(run("Time along z"));
    settle();
    ASSERT_TRUE(workbench.session().data.timeAxis);
    EXPECT_EQ(workbench.session().data.timeAxis->place, 0.0) << "a session with less could not be opened again";
}

TEST_F(TimeAlongWorkbench, TheDataInSpaceStandBesideAsTheyWere) {
    workbench.session().time = workbench.source()->info().times[1];
    const vis::Camera camera = workbench.session().camera;
    const vis::Image before = pictureOf("volume");
    EXPECT_EQ(besidePane(), "");
    EXPECT_FALSE(run("Data in space")) << "all are";
    ASSERT_TRUE(run("Time along z"));
    settle();
    const std::string beside = besidePane();
    ASSERT_FALSE(beside.empty());
    ASSERT_EQ(workbench.source()->info().times.size(), 1u);
    workbench.session().camera = camera; // it moved away for the box to have room in half the pane
    const vis::Image along = pictureOf("volume"), space = pictureOf(beside);
    EXPECT_LT(differing(before, space), 0.01) << "the same data at the same time";
    EXPECT_GT(differing(before, along), 0.02) << "the plane at all times looks otherwise";
    // By the command, the view that stands alone now shows the plane, and the data again.
    const auto inSpace = [&] { return std::get<VolumeView>(workbench.session().views.at(beside)).inSpace; };
    ASSERT_TRUE(inSpace());
    const Session shown = workbench.session();
    ASSERT_TRUE(run("Data in space"));
    settle();
    EXPECT_FALSE(inSpace());
    ASSERT_TRUE(run("Undo"));
    settle();
    EXPECT_TRUE(workbench.session() == shown);
    // Another place: read again once nothing is dragged.
    const auto numbers = workbench.numbers();
    workbench.session().data.timeAxis->place = 0.9;
    settle();
    EXPECT_NE(workbench.numbers(), numbers);
    EXPECT_NE(workbench.origin().spaceOfPlane, nullptr);
    EXPECT_EQ(besidePane(), beside);
    ASSERT_TRUE(run("Time along z")); // back
    settle();
    EXPECT_EQ(besidePane(), "");
    EXPECT_EQ(workbench.origin().spaceOfPlane, nullptr);
    workbench.session().camera = camera;
    EXPECT_LT(differing(before, pictureOf("volume")), 0.01);
}

} // namespace
} // namespace tessera::app
