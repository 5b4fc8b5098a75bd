#include "app/pane/axes3d.h"
#include "app/pane/plot.h"
#include "tests/app/hands_fixture.h"

#include <glm/geometric.hpp>

/// The mouse on bodies that clip: in volume views and in slices, of data that are stretched.
namespace tessera::app {
namespace {

constexpr glm::dvec3 kBodyStretch{1, 0.5, 1.5};

const volume::Box& bodiesBox() {
    static const glm::dvec3 lo(formula::kOrigin[0], formula::kOrigin[1], formula::kOrigin[2]);
    static const volume::Box box{
        lo, lo + glm::dvec3(formula::kSpacing[0] * 7, formula::kSpacing[1] * 6, formula::kSpacing[2] * 8)};
    return box;
}

class ClipBodyHands : public Hands {
protected:
    ClipBodyHands() = default;
    explicit ClipBodyHands(WorkbenchOptions options) : Hands(std::move(options)) {}
    /// A volume view from the front without perspective.
    void showVolume(const vis::Clip& clip, bool handles = true) {
        VolumeView volume;
        volume.showGizmo = volume.showLegend = volume.showAxes = false;
        volume.showLenses = handles;
        show(volume, {400, 300}, [&](Session& edited) {
            edited.layers.clear();
            edited.camera = {};
            edited.camera.orientation = glm::quat(1, 0, 0, 0);
            edited.camera.projection = vis::Projection::Orthographic;
            edited.stretch = kBodyStretch;
            edited.clips = {clip};
        });
        picture = pictures().back();
    }
    /// The three slices.
    void showSlices(const vis::Clip& clip) {
        SlicesView slices;
        slices.channel = "T";
        slices.showReadout = false;
        show(slices, {460, 420}, [&](Session& edited) {
            edited.stretch = kBodyStretch;
            edited.cursor = bodiesBox().lo + glm::dvec3(0.65, 0.57, 0.6) * bodiesBox().size();
            edited.clips = {clip};
        });
        ASSERT_EQ(pictures().size(), 3u);
    }
    vis::WorldFrame world() { return vis::worldFrame(bodiesBox(), session().stretch); }
    const vis::Clip& clip() { return session().clips.at(0); }
    /// The pixel of a place in the world, from the middle of the clip.
    ImVec2 pixel(glm::dvec3 from) {
        const vis::PlacedClip placed = vis::placeClips({clip()}, world()).at(0);
        const SpaceFrame space = spaceFrame(picture.Min, picture.Max, session().camera, bodiesBox(), session().stretch);
        return *space.pixel(world().toPhysical(placed.center + from));
    }
    /// The same in a slice, and pixels of a world length there.
    ImVec2 pixelIn(int plane, glm::dvec3 from) {
        const ImRect in = pictures()[std::size_t(plane)];
        const vis::PlacedClip placed = vis::placeClips({clip()}, world()).at(0);
        const glm::dvec3 share = (placed.center + from) / world().halfSize * 0.5 + 0.5;
        const auto [right, up] = kAxes[plane];
        return {float(in.Min.x + share[right] * in.GetWidth()), float(in.Max.y - share[up] * in.GetHeight())};
    }
    double pixelsIn(int plane, double length) {
        return length / (2 * world().halfSize[kAxes[plane][0]]) * double(pictures()[std::size_t(plane)].GetWidth());
    }
    /// Drags by pixels; one step, which is undone when `check` has seen what it did, and given up with Esc.
    void dragAndBack(ImVec2 from, ImVec2 by, const std::function<void()>& check) {
        settle();
        const Session before = session();
        const std::size_t step = steps();
        drag(from, {std::floor(from.x) + by.x, std::floor(from.y) + by.y});
        check();
        EXPECT_EQ(session().cursor, before.cursor);
        EXPECT_TRUE(session().camera == before.camera);
        settle();
        EXPECT_EQ(steps(), step + 1);
        undo();
        EXPECT_TRUE(session() == before) << apart(before);
        moveTo(from);
        button(0, true);
        moveTo({std::floor(from.x) + by.x, std::floor(from.y) + by.y});
        EXPECT_FALSE(session() == before);
        press(key::kEscape);
        EXPECT_TRUE(session() == before) << apart(before);
        button(0, false);
        EXPECT_TRUE(session() == before) << apart(before);
        moveTo({-1000, -1000});
    }
    /// The box around what is drawn of an outline that the mouse is not on, within a picture.
    static ImRect outline(const ImRect& in) {
        const ImU32 color = (plotColors().text & ~IM_COL32_A_MASK) | (ImU32(0.35f * 255) << IM_COL32_A_SHIFT);
        ImRect box(1e9f, 1e9f, -1e9f, -1e9f);
        const ImDrawData& data = *ImGui::GetDrawData();
        for (int l = 0; l < data.CmdListsCount; ++l)
            for (const ImDrawVert& vertex : data.CmdLists[l]->VtxBuffer)
                if (vertex.col == color && in.Contains(vertex.pos)) box.Add(vertex.pos);
        return box;
    }
    static void expectBox(const ImRect& drawn, ImVec2 lower, ImVec2 upper) {
        EXPECT_NEAR(drawn.Min.x, lower.x, 1.5);
        EXPECT_NEAR(drawn.Max.y, lower.y, 1.5);
        EXPECT_NEAR(drawn.Max.x, upper.x, 1.5);
        EXPECT_NEAR(drawn.Min.y, upper.y, 1.5);
    }

    /// Axes of the slices to the right and up.
    static constexpr int kAxes[3][2] = {{0, 1}, {2, 1}, {0, 2}};
    ImRect picture;
};

vis::Clip bodyOf(vis::ClipKind kind) {
    return {.kind = kind,
            .center = {0.55f, 0.5f, 0.45f},
            .axis = {0.6f, 0, 0}, // not of length 1: what a drag does not change stays as it is
            .size = {0.4f, 0.24f, 0.5f},
            .radius = 0.2f,
            .length = 0.7f};
}

TEST_F(ClipBodyHands, InSpaceABallIsMovedByItsMiddleAndGrowsByItsEnds) {
    showVolume(bodyOf(vis::ClipKind::Sphere));
    const double r = 0.2;
    expectBox(outline(picture), pixel({-r, -r, 0}), pixel({r, r, 0}));
    const double perPixel = r / double(pixel({r, 0, 0}).x - pixel({0, 0, 0}).x);
    const glm::dvec3 half = world().halfSize;
    dragAndBack(pixel({0, 0, 0}), {30, -20}, [&] {
        const glm::dvec3 by = (glm::dvec3(clip().center) - glm::dvec3(0.55, 0.5, 0.45)) * 2.0 * half;
        EXPECT_NEAR(by.x, 30 * perPixel, perPixel) << "to the right";
        EXPECT_NEAR(by.y, 20 * perPixel, perPixel) << "and up";
        EXPECT_NEAR(by.z, 0, 1e-6);
        EXPECT_EQ(clip().radius, 0.2f);
    });
    dragAndBack(pixel({r, 0, 0}), {17, 9}, [&] { EXPECT_NEAR(clip().radius, r + 17 * perPixel, perPixel); });
    dragAndBack(pixel({0, r, 0}), {5, -12}, [&] { EXPECT_NEAR(clip().radius, r + 12 * perPixel, perPixel); });
    dragAndBack(pixel({0, r, 0}), {5, 12}, [&] {
        EXPECT_NEAR(clip().radius, r - 12 * perPixel, perPixel) << "inwards it shrinks";
        EXPECT_EQ(clip().center, glm::vec3(0.55f, 0.5f, 0.45f));
    });
}

TEST_F(ClipBodyHands, InSpaceABoxGrowsAlongTheAxisOfItsDot) {
    showVolume(bodyOf(vis::ClipKind::Box));
    expectBox(outline(picture), pixel({-0.2, -0.12, 0}), pixel({0.2, 0.12, 0}));
    const double perPixel = 0.2 / double(pixel({0.2, 0, 0}).x - pixel({0, 0, 0}).x);
    dragAndBack(pixel({0.2, 0, 0}), {-14, 6}, [&] {
        EXPECT_NEAR(clip().size.x, 0.4 - 2 * 14 * perPixel, 2 * perPixel);
        EXPECT_EQ(clip().size.y, 0.24f);
        EXPECT_EQ(clip().size.z, 0.5f);
    });
    dragAndBack(pixel({0, 0.12, 0}), {3, -21}, [&] {
        EXPECT_NEAR(clip().size.y, 0.24 + 2 * 21 * perPixel, 2 * perPixel);
        EXPECT_EQ(clip().size.x, 0.4f);
    });
    // Not without end, nor through itself.
    drag(pixel({0, 0.12, 0}), {pixel({0, 0, 0}).x, picture.Min.y - 5000});
    EXPECT_EQ(clip().size.y, 2);
    session().clips = {bodyOf(vis::ClipKind::Box)};
    frame();
    drag(pixel({0, 0, 0}), {picture.Max.x + 9000, pixel({0, 0, 0}).y});
    EXPECT_EQ(clip().center.x, 1.5f) << "the range of the setting, beyond the box of the data";
}

TEST_F(ClipBodyHands, InSpaceACylinderGrowsLongerAndThickerAndIsTilted) {
    showVolume(bodyOf(vis::ClipKind::Cylinder));
    expectBox(outline(picture), pixel({-0.35, -0.2, 0}), pixel({0.35, 0.2, 0}));
    const double perPixel = 0.2 / double(pixel({0, 0, 0}).y - pixel({0, 0.2, 0}).y);
    dragAndBack(pixel({-0.35, 0, 0}), {-11, 4}, [&] {
        EXPECT_NEAR(clip().length, 0.7 + 2 * 11 * perPixel, 2 * perPixel) << "away from its middle";
        EXPECT_EQ(clip().radius, 0.2f);
    });
    dragAndBack(pixel({0, 0.2, 0}), {4, 13}, [&] {
        EXPECT_NEAR(clip().radius, 0.2 - 13 * perPixel, perPixel);
        EXPECT_EQ(clip().length, 0.7f);
    });
    const double arrow = 0.1 * double(session().camera.distance);
    dragAndBack(pixel({arrow, 0, 0}), {-8, -16}, [&] {
        const glm::dvec3 axis = glm::normalize(glm::dvec3(clip().axis));
        EXPECT_GT(axis.y, 0.1) << "upwards";
        EXPECT_GT(axis.x, 0);
        EXPECT_EQ(clip().length, 0.7f);
    });
}

TEST_F(ClipBodyHands, InSlicesDotsMoveAlongThemAndTheirOutlinesAreCuts) {
    for (int plane = 0; plane < 3; ++plane) {
        SCOPED_TRACE(plane);
        const auto [right, up] = kAxes[plane];
        const int normal = 3 - right - up;
        glm::dvec3 along(0), upwards(0);
        along[right] = 1, upwards[up] = 1;
        showSlices(bodyOf(vis::ClipKind::Sphere));
        // The slice does not run through the middle: the circle is smaller than the ball.
        const vis::PlacedClip placed = vis::placeClips({clip()}, world()).at(0);
        const double off = world().toWorld(session().cursor)[normal] - placed.center[normal];
        const double seen = std::sqrt(0.2 * 0.2 - off * off);
        ASSERT_LT(seen, 0.199);
        const ImRect in = pictures()[std::size_t(plane)];
        expectBox(outline(in), pixelIn(plane, -seen * (along + upwards)), pixelIn(plane, seen * (along + upwards)));
        const double perPixel = 1 / pixelsIn(plane, 1);
        dragAndBack(pixelIn(plane, {0, 0, 0}), {8, 5}, [&] {
            const glm::dvec3 by = (glm::dvec3(clip().center) - glm::dvec3(0.55, 0.5, 0.45)) * 2.0 * world().halfSize;
            EXPECT_NEAR(by[right], 8 * perPixel, perPixel);
            EXPECT_NEAR(by[up], -5 * perPixel, perPixel) << "down";
            EXPECT_NEAR(by[normal], 0, 1e-6);
        });
        dragAndBack(pixelIn(plane, 0.2 * along), {7, 3},
                    [&] { EXPECT_NEAR(clip().radius, 0.2 + 7 * perPixel, perPixel); });
        dragAndBack(pixelIn(plane, 0.2 * upwards), {2, 9},
                    [&] { EXPECT_NEAR(clip().radius, 0.2 - 9 * perPixel, perPixel); });
        showSlices(bodyOf(vis::ClipKind::Box));
        const glm::dvec3 half(0.2, 0.12, 0.25);
        expectBox(outline(in), pixelIn(plane, -half), pixelIn(plane, half));
        dragAndBack(pixelIn(plane, half * upwards), {2, -6}, [&] {
            EXPECT_NEAR(clip().size[up], 2 * half[up] + 2 * 6 * perPixel, 2 * perPixel);
            EXPECT_NEAR(clip().size[right], 2 * half[right], 1e-6);
        });
    }
}

TEST_F(ClipBodyHands, InSlicesACylinderIsARectangleOrACircle) {
    showSlices(bodyOf(vis::ClipKind::Cylinder)); // along x
    const vis::PlacedClip placed = vis::placeClips({clip()}, world()).at(0);
    const glm::dvec3 off = world().toWorld(session().cursor) - placed.center;
    const double wide = std::sqrt(0.2 * 0.2 - off.z * off.z);
    expectBox(outline(pictures()[0]), pixelIn(0, {-0.35, -wide, 0}), pixelIn(0, {0.35, wide, 0}));
    expectBox(outline(pictures()[1]), pixelIn(1, {0, -0.2, -0.2}), pixelIn(1, {0, 0.2, 0.2}));
    const double perPixel = 1 / pixelsIn(0, 1);
    dragAndBack(pixelIn(0, {-0.35, 0, 0}), {9, 2},
                [&] { EXPECT_NEAR(clip().length, 0.7 - 2 * 9 * perPixel, 2 * perPixel); });
    dragAndBack(pixelIn(0, {0, 0.2, 0}), {9, -4}, [&] { EXPECT_NEAR(clip().radius, 0.2 + 4 * perPixel, perPixel); });
    const double arrow = 0.1 * double(session().camera.distance);
    dragAndBack(pixelIn(0, {arrow, 0, 0}), {-3, 14}, [&] {
        EXPECT_LT(glm::normalize(glm::dvec3(clip().axis)).y, -0.1) << "down";
        EXPECT_NEAR(clip().axis.z, 0, 1e-6) << "within the slice";
    });
    // Aslant in the slice its end goes along its own line.
    session().clips[0].axis = {0.6f, 0.6f, 0};
    settle();
    const double part = 0.35 / std::sqrt(2.0);
    dragAndBack(pixelIn(0, {-part, -part, 0}), {-4, 12},
                [&] { EXPECT_NEAR(clip().length, 0.7 + 2 * (16 / std::sqrt(2.0)) * perPixel, 2 * perPixel); });
    session().clips[0].axis = {0.6f, 0, 0};
    settle();
    // Across its axis end and arrow lie on the middle, which moves it.
    dragAndBack(pixelIn(1, {0, 0, 0}), {9, 0}, [&] {
        EXPECT_GT(clip().center.z, 0.46f);
        EXPECT_EQ(clip().axis, glm::vec3(0.6f, 0, 0));
        EXPECT_EQ(clip().length, 0.7f);
    });
}

TEST_F(ClipBodyHands, WhatIsOffOrHiddenHasNoDots) {
    vis::Clip off = bodyOf(vis::ClipKind::Sphere);
    off.enabled = false;
    for (const bool hidden : {false, true}) {
        showVolume(hidden ? bodyOf(vis::ClipKind::Sphere) : off, !hidden);
        EXPECT_LT(outline(picture).GetWidth(), 0) << "no lines";
        const vis::Clip before = clip();
        session().clips[0].enabled = true;
        const ImVec2 middle = pixel({0, 0, 0}), end = pixel({0.2, 0, 0});
        session().clips[0] = before;
        for (const ImVec2 from : {middle, end}) drag(from, {from.x + 20, from.y + 10});
        EXPECT_TRUE(clip() == before);
        EXPECT_FALSE(session().camera == vis::Camera{}) << "the mouse is the camera's";
    }
    showSlices(off);
    EXPECT_LT(outline(pictures()[0]).GetWidth(), 0);
}

class ClipBodyFigure : public ClipBodyHands {
protected:
    ClipBodyFigure() : ClipBodyHands({.headless = true, .onlyPane = "pane"}) {}
};

TEST_F(ClipBodyFigure, HasNoDotsThatNobodyCanDrag) {
    showVolume(bodyOf(vis::ClipKind::Box));
    EXPECT_LT(outline(picture).GetWidth(), 0);
    showSlices(bodyOf(vis::ClipKind::Box));
    for (const ImRect& slice : pictures()) EXPECT_LT(outline(slice).GetWidth(), 0);
    vis::Clip empty = bodyOf(vis::ClipKind::Sphere);
    empty.radius = 0;
    showSlices(empty);
}

} // namespace
} // namespace tessera::app
