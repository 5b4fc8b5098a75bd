#include "app/drawing/panels.h"
#include "app/pane/axes3d.h"
#include "app/platform/headless.h"
#include "app/views/shadow_cube/cube_axes.h"
#include "tests/app/drawn_text.h"
#include "tests/app/hands_fixture.h"

#include <algorithm>
#include <charconv>

/// Axes at the edges of the shadow cube, and transfer functions that faces have of their own.
namespace tessera::app {
namespace {

std::optional<double> numberIn(const std::string& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

class CubeAxes : public Hands {
protected:
    void showCube(ShadowCubeView cube, vis::StandardView from, vis::Projection projection, glm::ivec2 size = {640, 480},
                  glm::dvec3 stretch = glm::dvec3(1)) {
        show(cube, size, [&](Session& edited) {
            edited.layers.clear();
            edited.stretch = stretch;
            edited.camera = {};
            edited.camera.orientation = vis::standardOrientation(from);
            edited.camera.projection = projection;
        });
        ASSERT_FALSE(pictures().empty());
        picture = pictures().back();
    }
    /// Where a place of the data lies in the picture.
    ImVec2 pixel(glm::dvec3 physical) {
        const glm::dvec3 lo(formula::kOrigin[0], formula::kOrigin[1], formula::kOrigin[2]);
        const volume::Box box{lo, {extent(0).hi, extent(1).hi, extent(2).hi}};
        const auto& cube = view<ShadowCubeView>();
        const glm::dvec3 half = vis::worldFrame(box, session().stretch).halfSize + double(cube.gap);
        const double aspect = double(picture.GetWidth()) / double(picture.GetHeight());
        const vis::Camera camera = cubeCamera(cube, session().camera, half, aspect, cubeShare(cube, picture.GetSize()));
        return *spaceFrame(picture.Min, picture.Max, camera, box, session().stretch).pixel(physical);
    }
    /// Numbers in rows from left to right and in columns from below, each with the title that follows.
    std::vector<std::string> rows() {
        std::vector<DrawnText> numbers, titles;
        for (const DrawnText& text : drawnTexts()) {
            if (numberIn(text.text)) numbers.push_back(text);
            if (text.text.ends_with("[mm]")) titles.push_back(text);
        }
        std::vector<std::string> out;
        for (const DrawnText& title : titles) {
            // Those at its axis are of the colourless numbers nearest to a line: it runs across or upwards.
            const int axis = title.text[0] - 'x';
            const ImVec2 a = pixel(corner(axis, extent(axis).lo)), b = pixel(corner(axis, extent(axis).hi));
            const bool upright = std::abs(b.y - a.y) > std::abs(b.x - a.x);
            std::vector<std::pair<float, std::string>> along;
            for (const DrawnText& number : numbers) {
                const ImVec2 at = number.middle(), expected = pixel(corner(axis, *numberIn(number.text) / 1000));
                const float off = upright ? at.y - expected.y : at.x - expected.x;
                const bool beside =
                    upright ? at.x < picture.Min.x + picture.GetWidth() * 0.5f && std::abs(at.x - title.max.x) < 60
                            : std::abs(at.y - title.min.y) < 30;
                if (beside && std::abs(off) < 3) along.emplace_back(upright ? -at.y : at.x, number.text);
            }
            std::ranges::sort(along);
            std::string row = title.text + (upright ? " upwards:" : ":");
            for (const auto& [place, text] : along) row += " " + text;
            out.push_back(row);
        }
        std::ranges::sort(out);
        return out;
    }
    static glm::dvec3 corner(int axis, double value) {
        glm::dvec3 at((extent(0).lo + extent(0).hi) / 2, (extent(1).lo + extent(1).hi) / 2,
                      (extent(2).lo + extent(2).hi) / 2);
        at[axis] = value;
        return at;
    }
    static int titles(const std::string& axis) {
        const std::vector<std::string> words = drawnWords();
        return int(std::ranges::count(words, axis + " [mm]"));
    }
    ImRect picture;
};

// Without perspective all that lies behind each other has the same numbers.
TEST_F(CubeAxes, NumbersAreThePositionsInTheLattice) {
    const std::vector<std::pair<vis::StandardView, std::vector<std::string>>> kExpected{
        {vis::StandardView::Front, {"x [mm]: 10 12 14 16", "y [mm] upwards: 0 2 4 6 8 10 12"}},
        {vis::StandardView::Back, {"x [mm]: 16 14 12 10", "y [mm] upwards: 0 2 4 6 8 10 12"}},
        {vis::StandardView::Left, {"y [mm] upwards: 0 2 4 6 8 10 12", "z [mm]: -2 0 2"}},
        {vis::StandardView::Right, {"y [mm] upwards: 0 2 4 6 8 10 12", "z [mm]: 2 0 -2"}},
        {vis::StandardView::Top, {"x [mm]: 10 11 12 13 14 15 16 17", "z [mm] upwards: 2 1 0 -1 -2"}},
        {vis::StandardView::Bottom, {"x [mm]: 10 11 12 13 14 15 16 17", "z [mm] upwards: -2 -1 0 1 2"}},
    };
    for (const auto& [from, expected] : kExpected) {
        SCOPED_TRACE(vis::kStandardViewNames[std::size_t(from)]);
        showCube({}, from, vis::Projection::Orthographic);
        EXPECT_EQ(rows(), expected);
    }
    showCube({}, vis::StandardView::Front, vis::Projection::Orthographic, {640, 480}, {3, 0.5, 1});
    EXPECT_EQ(rows(), (std::vector<std::string>{"x [mm]: 10 11 12 13 14 15 16 17", "y [mm] upwards: 0 5 10"}));
}

TEST_F(CubeAxes, EveryStandardViewHasThemApartFromEachOther) {
    for (const glm::ivec2 size : {glm::ivec2(640, 480), glm::ivec2(420, 520), glm::ivec2(900, 420)})
        for (const vis::Projection projection : {vis::Projection::Perspective, vis::Projection::Orthographic})
            for (std::size_t from = 0; from < std::size(vis::kStandardViewNames); ++from) {
                SCOPED_TRACE(std::string(vis::kStandardViewNames[from]) + ", " + std::to_string(size.x) +
                             (projection == vis::Projection::Perspective ? ", perspective" : ""));
                showCube({}, static_cast<vis::StandardView>(from), projection, size);
                const std::vector<DrawnText> texts = drawnTexts();
                for (std::size_t i = 0; i < texts.size(); ++i) {
                    const DrawnText& a = texts[i];
                    EXPECT_TRUE(a.min.x >= picture.Min.x && a.max.x <= picture.Max.x) << a.text;
                    for (std::size_t k = 0; k < i; ++k) {
                        const DrawnText& b = texts[k];
                        EXPECT_FALSE(a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y)
                            << a.text << " over " << b.text;
                    }
                }
                // An axis along the view may be too short for numbers.
                const bool all = static_cast<vis::StandardView>(from) == vis::StandardView::Isometric;
                const int shown = titles("x") + titles("y") + titles("z");
                std::string words;
                for (const DrawnText& text : texts) words += text.text + "; ";
                EXPECT_GE(shown, all ? 3 : 2) << words;
            }
}

TEST_F(CubeAxes, LinesLeadFromTheNumbersToTheProjection) {
    showCube({}, vis::StandardView::Front, vis::Projection::Orthographic);
    const std::vector<ImVec2> ends = app::drawnIn((axisColor(0) & ~IM_COL32_A_MASK) | (90u << IM_COL32_A_SHIFT));
    ASSERT_FALSE(ends.empty());
    const float lowest = pixel({0, extent(1).lo, 0}).y;
    for (const double value : {0.010, 0.012, 0.014, 0.016}) {
        const float x = pixel({value, 0, 0}).x;
        for (const bool below : {false, true})
            EXPECT_TRUE(std::ranges::any_of(ends,
                                            [&](ImVec2 at) {
                                                return std::abs(at.x - x) < 2 &&
                                                       (below ? at.y > lowest + 10 : std::abs(at.y - lowest) < 2);
                                            }))
                << value << below;
    }
    EXPECT_TRUE(std::ranges::none_of(ends, [&](ImVec2 at) {
        return at.y < lowest - 3 && at.y > pixel({0, extent(1).hi, 0}).y + 3;
    })) << "the projection is left alone";
}

TEST_F(CubeAxes, ASettingHidesThem) {
    ShadowCubeView without;
    without.showAxes = false;
    showCube(without, vis::StandardView::Isometric, vis::Projection::Perspective);
    EXPECT_EQ(titles("x") + titles("y") + titles("z"), 0);
    showCube({}, vis::StandardView::Isometric, vis::Projection::Perspective);
    EXPECT_EQ(titles("x") + titles("y") + titles("z"), 3);
}

TEST_F(CubeAxes, APictureForExportHasThemUnlessItIsWithout) {
    showCube({}, vis::StandardView::Isometric, vis::Projection::Perspective);
    Opened opened;
    opened.source = opened.numbers = volume::makeMemorySource(formula::makeCell(), {});
    opened.document.session = session();
    opened.document.history.reset(session());
    const auto words = [&](bool axes) {
        PictureRequest request{.pane = "pane"};
        request.size = {640, 480};
        request.decoration.axes = axes;
        PictureMaker maker;
        const VectorPage page = maker.page(opened.document, opened.sources(), request);
        int count = 0;
        for (const shapes::Mark& mark : page.marks)
            if (const auto* text = std::get_if<shapes::Words>(&mark.shape)) count += text->text.ends_with("[mm]");
        return count;
    };
    EXPECT_EQ(words(true), 3) << "as texts";
    EXPECT_EQ(words(false), 0);
}

TEST_F(CubeAxes, AFaceMayHaveAFunctionOfItsOwn) {
    ShadowCubeView cube;
    cube.back.channel = "T";
    showCube(cube, vis::StandardView::Front, vis::Projection::Orthographic);
    const Session before = session();
    const vis::TransferFunction shared = session().transfer.at("T");
    EXPECT_EQ(std::ranges::count(drawnWords(), "T [K]"), 1);
    click(within(picture, 0.5, 0.5), 1);
    ASSERT_TRUE(popup());
    click(item(popup(), {"##ownTransfer"}).GetCenter());
    const std::string name = view<ShadowCubeView>().back.transfer;
    EXPECT_EQ(name, "mean T, back");
    EXPECT_TRUE(session().transfer.at(name) == shared) << "begins as the one it had";
    press(key::kEscape);
    settle();
    EXPECT_EQ(steps(), 1u);
    EXPECT_EQ(std::ranges::count(drawnWords(), "mean T [K]"), 1) << "its legend says of what it is";
    EXPECT_EQ(std::ranges::count(drawnWords(), "T [K]"), 0);
    const Session own = session();
    EXPECT_TRUE(sessionFromJson(toJson(own), "cube") == own) << "is saved";
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
    session() = own;
    frame();
    click(within(picture, 0.5, 0.5), 1);
    ASSERT_TRUE(popup());
    click(item(popup(), {"##ownTransfer"}).GetCenter());
    EXPECT_TRUE(view<ShadowCubeView>().back.transfer.empty());
    EXPECT_FALSE(session().transfer.contains(name)) << "nothing else has it";
    press(key::kEscape);
}

TEST_F(CubeAxes, LegendsSayWhichFacesTheyAreFor) {
    ShadowCubeView cube;
    cube.right.channel = cube.bottom.channel = cube.back.channel = "T";
    const auto legends = [&] {
        showCube(cube, vis::StandardView::Isometric, vis::Projection::Perspective, {800, 600});
        std::vector<std::string> found;
        for (const std::string& text : drawnWords())
            if (text.ends_with("]") && !text.ends_with("[mm]")) found.push_back(text);
        return found;
    };
    using Words = std::vector<std::string>;
    EXPECT_EQ(legends(), (Words{"T [K]"})) << "one for all";
    cube.bottom.transfer = "far";
    EXPECT_EQ(legends(), (Words{"slice T, mean T, back [K]", "mean T, bottom [K]"}));
    EXPECT_EQ(std::ranges::count(drawnWords(), "mean T, bottom"), 1) << "the face has the same name";
    cube.bottom.kind = WallKind::Maximum;
    EXPECT_EQ(legends(), (Words{"slice T, mean T [K]", "maximum T [K]"}));
    cube.bottom = {.channel = "T", .kind = WallKind::XRay};
    EXPECT_EQ(legends(), (Words{"slice T, mean T [K]", "absorption T [%]"})) << "the colours of a share";
}

} // namespace
} // namespace tessera::app
