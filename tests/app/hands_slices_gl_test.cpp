#include "app/drawing/drawing.h"
#include "app/tools/brush_edit.h"
#include "tests/app/drawn_text.h"
#include "tests/app/hands_fixture.h"

/// The mouse in pictures of planes: which axis a drag or the wheel moves, which way, and where it ends.
namespace tessera::app {
namespace {

constexpr double kTiny = 1e-9; ///< metres; a pixel is about 1e-4

class SliceHands : public Hands {
protected:
    /// Axes of the three slices: to the right, up, across.
    static constexpr int kAxes[3][3] = {{0, 1, 2}, {2, 1, 0}, {0, 2, 1}};

    void showSlices(const std::function<void(Session&)>& prepare = {}) {
        SlicesView slices;
        slices.channel = "T";
        slices.showReadout = false;
        show(slices, {460, 420}, prepare);
        planes = pictures();
        ASSERT_EQ(planes.size(), 3u);
    }
    std::vector<ImRect> planes;
    std::vector<vis::Image> images;
};

TEST_F(SliceHands, TitlesGiveUpDigitsBeforeTheAxisAndItsUnit) {
    std::size_t shorter = 0;
    for (const float width : {460.0f, 300.0f, 250.0f}) {
        SlicesView slices;
        slices.channel = "T";
        show(slices, {width, 300});
        const std::vector<std::string> words = drawnWords();
        for (const std::string axis : {"x", "y", "z"}) {
            const auto title = std::ranges::find_if(
                words, [&](const std::string& word) { return word.starts_with(axis + " ") && word.ends_with(" mm"); });
            ASSERT_NE(title, words.end()) << axis << " at " << width;
            shorter += !title->starts_with(axis + " = ");
        }
    }
    EXPECT_GT(shorter, 0u) << "none of these panes is narrow";
}

TEST_F(SliceHands, TextsAroundSlicesAreClearOfEachOther) {
    showSlices();
    const auto drawnAt = [&](glm::ivec2 size, glm::dvec3 stretch) {
        session().stretch = stretch;
        frames.emplace(size);
        settle();
        std::size_t pairs = 0;
        const std::vector<DrawnText> texts = drawnTexts();
        for (std::size_t i = 0; i < texts.size(); ++i)
            for (std::size_t k = 0; k < i; ++k, ++pairs)
                EXPECT_TRUE(texts[i].min.x >= texts[k].max.x || texts[i].max.x <= texts[k].min.x ||
                            texts[i].min.y >= texts[k].max.y + 1 || texts[i].max.y + 1 <= texts[k].min.y)
                    << "'" << texts[i].text << "' touches '" << texts[k].text << "' at " << size.x << " x " << size.y
                    << ", stretch " << stretch.x << " " << stretch.y << " " << stretch.z;
        EXPECT_GT(pairs, 9u);
    };
    // The box of the cell is 7 x 12 x 4 mm; z goes from -2 to 2, whose numbers stand at the ends of the axis.
    for (const glm::dvec3 stretch : {glm::dvec3(1, 1, 1), {1, 1, 12}, {8, 1, 1}, {1, 6, 1}})
        for (const int width : {240, 330, 460, 700})
            for (const int height : {150, 190, 260, 420, 560}) drawnAt({width, height}, stretch);
}

// Below each other, thin ones and those whose heights have no room: y and x are 12 and 7 mm, before they are stretched.
TEST_F(SliceHands, SlicesThatShareAnAxisHaveOneScale) {
    show(SlicesView{}, {460, 190});
    for (const glm::dvec3 stretch : {glm::dvec3(0.4, 1, 16), {0.2, 1, 6.5}}) {
        session().stretch = stretch;
        if (stretch.z < 10) frames.emplace(glm::ivec2{460, 172});
        settle();
        planes = pictures();
        ASSERT_EQ(planes.size(), 3u);
        const ImRect &zy = planes[1], &zx = planes[2];
        EXPECT_GT(zy.GetWidth(), 2 * zy.GetHeight());
        EXPECT_EQ(zy.Min.x, zx.Min.x);
        EXPECT_EQ(zy.GetWidth(), zx.GetWidth());
        EXPECT_NEAR(zx.GetHeight(), double(zy.GetHeight()) / 12 * 7 * stretch.x, 1.01) << "pixels";
    }
}

TEST_F(SliceHands, TheCrossHairGoesUnderTheMouse) {
    for (const double stretch : {1.0, 0.4}) {
        showSlices([&](Session& edited) { edited.stretch.y = stretch; });
        for (int plane = 0; plane < 3; ++plane) {
            SCOPED_TRACE(plane);
            const ImRect& picture = planes[std::size_t(plane)];
            const auto [right, up, normal] = kAxes[plane];
            const Session before = session();
            const auto expectAt = [&](ImVec2 at) {
                EXPECT_NEAR(session().cursor[right], across(picture, extent(right), at), kTiny);
                EXPECT_NEAR(session().cursor[up], upwards(picture, extent(up), at), kTiny);
                EXPECT_EQ(session().cursor[normal], before.cursor[normal]);
            };
            moveTo(within(picture, 0.2, 0.3));
            EXPECT_TRUE(session() == before) << "the mouse alone moves nothing";
            button(0, true);
            expectAt(mouse);
            moveTo(within(picture, 0.8, 0.6));
            expectAt(mouse);
            moveTo({picture.Max.x + 30, picture.Min.y - 30}); // also over another slice
            EXPECT_EQ(session().cursor[right], extent(right).hi);
            EXPECT_EQ(session().cursor[up], extent(up).hi);
            moveTo({picture.Min.x - 20, picture.Max.y + 20});
            EXPECT_EQ(session().cursor[right], extent(right).lo);
            EXPECT_EQ(session().cursor[up], extent(up).lo);
            moveTo(within(picture, 0.4, 0.7));
            button(0, false);
            const ImVec2 left = mouse;
            moveTo(within(picture, 0.9, 0.1));
            expectAt(left);
            EXPECT_EQ(steps(), 1u) << "one drag is one step";
            undo();
            EXPECT_TRUE(session() == before) << apart(before);
        }
    }
}

TEST_F(SliceHands, TheWheelGoesThroughThePlanes) {
    showSlices();
    for (int plane = 0; plane < 3; ++plane) {
        SCOPED_TRACE(plane);
        const int normal = kAxes[plane][2];
        const double step = formula::kSpacing[normal];
        glm::dvec3 expected = session().cursor;
        moveTo(within(planes[std::size_t(plane)], 0.5, 0.5));
        turnWheel(1);
        expected[normal] += step;
        EXPECT_NEAR(session().cursor[normal], expected[normal], kTiny) << "away from the hand: to larger coordinates";
        turnWheel(-2);
        expected[normal] -= 2 * step;
        EXPECT_NEAR(session().cursor[normal], expected[normal], kTiny);
        for (const int other : {kAxes[plane][0], kAxes[plane][1]}) EXPECT_EQ(session().cursor[other], expected[other]);
        session().cursor[normal] = extent(normal).lo;
        shift = true;
        turnWheel(0.3f);
        EXPECT_NEAR(session().cursor[normal], extent(normal).lo + 3 * step, 1e-6 * step) << "Shift: ten samples";
        turnWheel(1);
        EXPECT_EQ(session().cursor[normal], extent(normal).hi);
        turnWheel(-1);
        EXPECT_EQ(session().cursor[normal], extent(normal).lo);
        shift = false;
        turnWheel(-1);
        EXPECT_EQ(session().cursor[normal], extent(normal).lo);
    }
    const glm::dvec3 before = session().cursor;
    moveTo({planes[0].Max.x + 4, planes[0].Min.y - 6});
    turnWheel(1);
    EXPECT_EQ(session().cursor, before) << "beside the slices the wheel is not theirs";
}

TEST_F(SliceHands, TheMiddleOfALensMovesTheLens) {
    const vis::Lens lens{.name = "a", .center = {0.0135, 0.006, 0.0003}, .size = {0.2f, 0.2f, 0.2f}};
    for (int plane = 0; plane < 3; ++plane) {
        SCOPED_TRACE(plane);
        showSlices([&](Session& edited) { edited.lenses = {lens}; });
        const ImRect& picture = planes[std::size_t(plane)];
        const auto [right, up, normal] = kAxes[plane];
        const auto share = [&](int axis) {
            return (lens.center[axis] - extent(axis).lo) / (extent(axis).hi - extent(axis).lo);
        };
        const glm::dvec3 cursor = session().cursor;
        drag(within(picture, share(right), 1 - share(up)), within(picture, 0.75, 0.8));
        const glm::dvec3 center = session().lenses[0].center;
        const auto pixel = [&](int axis, float pixels) { return (extent(axis).hi - extent(axis).lo) / double(pixels); };
        EXPECT_NEAR(center[right], across(picture, extent(right), mouse), pixel(right, picture.GetWidth()));
        EXPECT_NEAR(center[up], upwards(picture, extent(up), mouse), pixel(up, picture.GetHeight()));
        EXPECT_EQ(center[normal], lens.center[normal]);
        EXPECT_EQ(session().cursor, cursor);
        EXPECT_EQ(steps(), 1u);
        // What is switched off or goes with the cross-hair leaves the mouse to it.
        for (const bool follows : {false, true}) {
            vis::Lens& other = session().lenses[0];
            other.center = lens.center;
            other.enabled = follows, other.followsCursor = follows;
            drag(within(picture, share(right), 1 - share(up)), within(picture, 0.3, 0.3));
            EXPECT_EQ(session().lenses[0].center, lens.center);
            EXPECT_NEAR(session().cursor[right], across(picture, extent(right), mouse), kTiny);
        }
    }
}

TEST_F(SliceHands, ASquareOfALensResizesItAndSoDoesTheWheelWithAlt) {
    for (int plane = 0; plane < 3; ++plane) {
        SCOPED_TRACE(plane);
        showSlices([&](Session& edited) {
            edited.stretch = {1, 0.5, 1.5}; // edges as 7 to 6 to 6
            edited.lenses = {{.name = "a", .size = glm::vec3(0.3f)}};
            edited.lenses[0].center = {0.0135, 0.006, 0};
        });
        const ImRect& picture = planes[std::size_t(plane)];
        const auto [right, up, normal] = kAxes[plane];
        const auto share = [&](int axis) {
            return (session().lenses[0].center[axis] - extent(axis).lo) / (extent(axis).hi - extent(axis).lo);
        };
        const Session before = session();
        const ImVec2 middle = within(picture, share(right), 1 - share(up));
        // The longest edge of the data is 1 in the world.
        const double edge[] = {1, 6.0 / 7, 6.0 / 7};
        const float radius = float(0.3 / edge[right] * double(picture.GetWidth()));
        moveTo({middle.x + 10, middle.y - 14});
        EXPECT_TRUE(session() == before) << apart(before);
        drag({middle.x + radius, middle.y}, {middle.x + 1.4f * radius, middle.y + 3});
        EXPECT_NEAR(session().lenses[0].size[0], 0.3 * 1.4, 0.3 * 1.5 / double(radius));
        EXPECT_EQ(session().lenses[0].center, before.lenses[0].center);
        EXPECT_EQ(session().cursor, before.cursor);
        settle();
        EXPECT_EQ(steps(), 1u);
        undo();
        EXPECT_TRUE(session() == before) << apart(before);
        moveTo({middle.x + 10, middle.y - 14});
        alt = true;
        turnWheel(-1);
        alt = false;
        EXPECT_NEAR(session().lenses[0].size[0], 0.3 / 1.1, 1e-4);
        EXPECT_EQ(session().cursor, before.cursor) << "the slice stays";
        turnWheel(1);
        EXPECT_NE(session().cursor[normal], before.cursor[normal]) << "without Alt it does not";
    }
}

TEST_F(SliceHands, ALensFollowsTheMouseUntilItIsPinned) {
    for (int plane = 0; plane < 3; ++plane) {
        SCOPED_TRACE(plane);
        showSlices([&](Session& edited) {
            edited.lenses = {{.name = "a", .size = glm::vec3(0.1f)}, {.name = "b", .size = glm::vec3(0.1f)}};
            edited.lenses[0].center = edited.lenses[1].center = edited.cursor;
            edited.lenses[1].center[kAxes[plane][0]] = extent(kAxes[plane][0]).hi;
        });
        const ImRect& picture = planes[std::size_t(plane)];
        const auto [right, up, normal] = kAxes[plane];
        const Session before = session();
        const auto share = [&](int axis) {
            return (session().cursor[axis] - extent(axis).lo) / (extent(axis).hi - extent(axis).lo);
        };
        moveTo(within(picture, share(right), 1 - share(up)));
        press('F');
        EXPECT_TRUE(session().lenses[0].followsPointer) << "the one under the mouse";
        for (const double at : {0.7, 0.4}) {
            moveTo(within(picture, at, 0.3));
            const glm::dvec3 center = session().lenses[0].center;
            EXPECT_NEAR(center[right], across(picture, extent(right), mouse), kTiny);
            EXPECT_NEAR(center[up], upwards(picture, extent(up), mouse), kTiny);
            EXPECT_NEAR(center[normal], before.cursor[normal], kTiny) << "on the slice";
        }
        press('F');
        EXPECT_FALSE(session().lenses[0].followsPointer);
        const glm::dvec3 left = session().lenses[0].center;
        moveTo(within(picture, 0.2, 0.6));
        EXPECT_EQ(session().lenses[0].center, left);
        EXPECT_TRUE(session().lenses[1] == before.lenses[1]);
        EXPECT_EQ(session().cursor, before.cursor);
    }
}

TEST_F(SliceHands, CornersOfAProfileLineMoveInThePlane) {
    const std::vector<glm::dvec3> corners{{0.012, 0.009, 0.001}, {0.015, 0.003, -0.0005}};
    for (int plane = 0; plane < 3; ++plane)
        for (std::size_t held = 0; held < 2; ++held) {
            SCOPED_TRACE(plane);
            showSlices([&](Session& edited) {
                ProfileView profile;
                profile.points = corners;
                edited.views["line"] = profile;
            });
            const ImRect& picture = planes[std::size_t(plane)];
            const auto [right, up, normal] = kAxes[plane];
            const auto pixel = [&](glm::dvec3 at) {
                const auto share = [&](int axis) {
                    return (at[axis] - extent(axis).lo) / (extent(axis).hi - extent(axis).lo);
                };
                return ImVec2(float(picture.Min.x + share(right) * picture.GetWidth()),
                              float(picture.Max.y - share(up) * picture.GetHeight()));
            };
            const auto points = [&] { return std::get<ProfileView>(session().views.at("line")).points; };
            const glm::dvec3 cursor = session().cursor;
            const ImVec2 from = pixel(corners[held]);
            moveTo(from);
            const ImVec2 start = mouse;
            const float x = start.x < picture.GetCenter().x ? 12 : -12, y = start.y < picture.GetCenter().y ? 9 : -9;
            button(0, true);
            moveTo({start.x + x, start.y + y});
            const glm::dvec3 moved = points()[held];
            EXPECT_NEAR(pixel(moved).x, from.x + x, 1.01);
            EXPECT_NEAR(pixel(moved).y, from.y + y, 1.01);
            EXPECT_EQ(moved[normal], corners[held][normal]);
            EXPECT_EQ(points()[1 - held], corners[1 - held]);
            moveTo({picture.Max.x + 50, picture.Max.y + 50});
            EXPECT_EQ(points()[held][right], extent(right).hi) << "stays in the box";
            EXPECT_EQ(points()[held][up], extent(up).lo);
            press(key::kEscape);
            EXPECT_EQ(points(), corners) << "Esc takes the drag back";
            button(0, false);
            EXPECT_EQ(points(), corners);
            EXPECT_EQ(session().cursor, cursor) << "the cross-hair stays";
            EXPECT_EQ(steps(), 0u);
        }
}

TEST_F(SliceHands, TheRightButtonOpensTheMenuAndMovesNothing) {
    showSlices();
    const Session before = session();
    click(within(planes[1], 0.6, 0.4), 1);
    EXPECT_TRUE(popup());
    EXPECT_TRUE(session() == before) << apart(before);
    drag(within(planes[0], 0.2, 0.2), within(planes[0], 0.7, 0.7), 2);
    EXPECT_TRUE(session() == before) << "nor does the middle one";
}

TEST_F(SliceHands, ALensAtTheCrossHairShowsItsLayerThere) {
    for (const bool follows : {false, true}) {
        showSlices([&](Session& edited) {
            edited.lenses = {{.name = "inner", .effect = vis::LensEffect::Replace, .size = glm::vec3(0.25f)}};
            edited.lenses[0].followsCursor = follows;
            if (!follows) edited.lenses[0].center = edited.cursor;
            edited.layers.push_back({"c", true, vis::VolumeLayer{.channel = "c"}, "inner"});
        });
        const vis::Image shown = frames->read();
        if (!follows) {
            images.push_back(shown);
            continue;
        }
        EXPECT_TRUE(shown.rgba == images.front().rgba) << "as one that is put there";
        session().lenses.clear();
        settle();
        EXPECT_FALSE(frames->read().rgba == shown.rgba);
    }
}

TEST_F(SliceHands, OutlinesAndLinesLieOnAPageAsOnScreen) {
    showSlices([&](Session& edited) {
        SlicesView& slices = std::get<SlicesView>(edited.views.at("pane"));
        slices.lines = {.count = 6, .channel = "U.x", .values = false}; // which rises along x alone
        edited.selection.brushes.resize(1);
        edited.selection.brushes[0].color = {1, 0, 0};
        edited.selection.brushes[0].region = vis::SphereRegion{.center = edited.cursor, .radius = {1e-3, 2e-3, 6e-4}};
    });
    const ViewExport* offered = workbench.exported("pane");
    ASSERT_TRUE(offered && offered->figure);
    const auto outlines = [&](const PageForm& form) {
        std::vector<ImRect> boxes;
        for (const shapes::Mark& mark : offered->figure(form, {}).marks)
            if (const auto* line = std::get_if<shapes::Stroke>(&mark.shape); line && line->color.r > 0.6f)
                if (line->color.g < 0.1f) {
                    ImRect box(1e9f, 1e9f, -1e9f, -1e9f);
                    for (const glm::dvec2& point : line->points) box.Add(ImVec2(float(point.x), float(point.y)));
                    boxes.push_back(box);
                }
        return boxes;
    };
    std::vector<ImRect> pages; // the pictures
    double first = 1e9;        // line on the page, in the first picture
    for (const shapes::Mark& mark : offered->figure({.legend = false}, {}).marks) {
        if (const auto* picture = std::get_if<shapes::Picture>(&mark.shape))
            pages.emplace_back(float(picture->box.lo.x), float(picture->box.lo.y), float(picture->box.hi.x),
                               float(picture->box.hi.y));
        if (const auto* line = std::get_if<shapes::Stroke>(&mark.shape); line && line->color.g > 0.1f)
            if (line->color.r < 0.2f && line->color.b < 0.2f)
                for (const glm::dvec2& point : line->points) first = std::min(first, point.x);
    }
    const std::vector<ImRect> drawn = outlines({.legend = false});
    ASSERT_EQ(pages.size(), 3u);
    ASSERT_EQ(drawn.size(), 3u);
    ImRect expected(1e9f, 1e9f, -1e9f, -1e9f); // around all three
    double line = 1e9;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto onScreen = [&](ImVec2 at) {
            return ImVec2(planes[i].Min.x + (at.x - pages[i].Min.x) / pages[i].GetWidth() * planes[i].GetWidth(),
                          planes[i].Min.y + (at.y - pages[i].Min.y) / pages[i].GetHeight() * planes[i].GetHeight());
        };
        expected.Add(onScreen(drawn[i].Min));
        expected.Add(onScreen(drawn[i].Max));
        const double share = (first - double(pages[0].Min.x)) / double(pages[0].GetWidth());
        if (i != 1) line = std::min(line, double(planes[i].Min.x) + share * double(planes[i].GetWidth()));
    }
    const ImRect shown = inked(brushColor({1, 0, 0}, 0.9f));
    EXPECT_NEAR(shown.Min.x, expected.Min.x, 2.5);
    EXPECT_NEAR(shown.Min.y, expected.Min.y, 2.5);
    EXPECT_NEAR(shown.Max.x, expected.Max.x, 2.5);
    EXPECT_NEAR(shown.Max.y, expected.Max.y, 2.5);
    EXPECT_NEAR(inked(IM_COL32(12, 12, 12, 245)).Min.x, line, 2.5) << "the contour line of the least value";
    EXPECT_TRUE(outlines({.outlines = false}).empty()) << "where they are left out";
}

class PlaneHands : public Hands {};

TEST_F(PlaneHands, AClickInASliceOfTheMatrixGoesThere) {
    struct Case {
        volume::SpaceAxis normal;
        int right, up; ///< the longer edge lies level
    };
    // The edges of the cell are 7, 12 and 4 mm.
    for (const auto& [normal, right, up] :
         {Case{volume::SpaceAxis::Z, 1, 0}, Case{volume::SpaceAxis::Y, 0, 2}, Case{volume::SpaceAxis::X, 1, 2}}) {
        SliceMatrixView matrix;
        matrix.channels = {"T", "|U|"};
        matrix.planes = 3;
        matrix.axis = normal;
        show(matrix, {640, 320});
        const std::vector<ImRect> slices = pictures(); // plane by plane, parameter by parameter
        ASSERT_EQ(slices.size(), 6u);
        for (const std::size_t index : {std::size_t(0), std::size_t(3), std::size_t(5)}) {
            SCOPED_TRACE(index);
            const ImRect& slice = slices[index];
            click(within(slice, 0.25, 0.2));
            const int across0 = int(normal);
            const Range deep = extent(across0);
            EXPECT_NEAR(session().cursor[across0], deep.lo + (deep.hi - deep.lo) * (2.0 * double(index / 2) + 1) / 6,
                        kTiny);
            // Columns need not begin at whole pixels.
            const auto pixels = [&](int axis, float count) {
                return (extent(axis).hi - extent(axis).lo) / double(count);
            };
            EXPECT_NEAR(session().cursor[right], across(slice, extent(right), mouse), pixels(right, slice.GetWidth()));
            EXPECT_NEAR(session().cursor[up], upwards(slice, extent(up), mouse), pixels(up, slice.GetHeight()));
        }
        drag(within(slices[2], 0.3, 0.3), within(slices[2], 0.7, 0.6));
        const Range deep = extent(int(normal));
        EXPECT_NEAR(session().cursor[int(normal)], (deep.lo + deep.hi) / 2, kTiny) << "a drag stays in its plane";
        EXPECT_NEAR(session().cursor[right], across(slices[2], extent(right), mouse), kTiny);
        EXPECT_NEAR(session().cursor[up], upwards(slices[2], extent(up), mouse), kTiny);
        moveTo(within(slices[0], 0.5, 0.5));
        const glm::dvec3 before = session().cursor;
        turnWheel(1);
        EXPECT_EQ(session().cursor, before) << "planes of the matrix stand where they are";
        click({slices[0].Min.x + 10, slices[0].Min.y - 8});
        EXPECT_EQ(session().cursor, before) << "the head line is no slice";
    }
}

TEST_F(PlaneHands, AClickInASliceOfAnotherTimeGoesToThatTime) {
    SliceMatrixView matrix;
    matrix.channels = {"T", "|U|"};
    matrix.columns = MatrixAxis::Times;
    show(matrix, {640, 320});
    const std::vector<double> times = workbench.document().info().times;
    ASSERT_GE(times.size(), 2u);
    const std::vector<ImRect> slices = pictures(); // time by time, parameter by parameter
    ASSERT_EQ(slices.size(), 2 * std::min<std::size_t>(times.size(), 4));
    const double deep = session().cursor.z;
    click(within(slices.back(), 0.3, 0.4));
    EXPECT_EQ(session().time, times.back());
    EXPECT_NEAR(session().cursor.z, deep, kTiny) << "in the plane of the cross-hair";
    click(within(slices.front(), 0.6, 0.5));
    EXPECT_EQ(session().time, times.front());
}

TEST_F(PlaneHands, AveragesOverPlanesTakeTheCrossHairAlong) {
    for (int axis = 0; axis < 3; ++axis) {
        SCOPED_TRACE(axis);
        ProfileView profile;
        profile.over = ProfileOver::Sections;
        profile.channels = {"T"};
        profile.sections.across = SectionAcross(axis);
        show(profile, {640, 320});
        const ImRect plots = inPane({"plots"});
        const Session before = session();
        moveTo(within(plots, 0.3, 0.5));
        EXPECT_TRUE(session() == before) << "the mouse alone only reads";
        button(0, true);
        for (const double share : {0.3, 0.85}) {
            moveTo(within(plots, share, 0.5));
            glm::dvec3 expected = before.cursor;
            expected[axis] = across(plots, extent(axis), mouse);
            for (int i = 0; i < 3; ++i) EXPECT_NEAR(session().cursor[i], expected[i], kTiny);
        }
        moveTo({plots.Min.x - 40, mouse.y});
        EXPECT_NEAR(session().cursor[axis], extent(axis).lo, 1e-15);
        moveTo({plots.Max.x + 40, mouse.y});
        EXPECT_NEAR(session().cursor[axis], extent(axis).hi, 1e-15);
        EXPECT_LE(session().cursor[axis], extent(axis).hi);
        button(0, false);
        frame();
        EXPECT_EQ(steps(), 1u);
        undo();
        EXPECT_TRUE(session() == before) << apart(before);
    }
}

} // namespace
} // namespace tessera::app
