#include "app/pane/axes3d.h"
#include "tests/app/drawn_text.h"
#include "tests/app/views_fixture.h"
#include "tests/volume/uneven.h"

#include <charconv>
#include <optional>

/// Panes of data with uneven axes: what they say of places and proportions.
namespace tessera::app {
namespace {

class UnevenViews : public ViewsTest {
protected:
    void showLayers(bool even = false) {
        volume::Lattice lattice = volume::test::layeredLattice(volume::AxisMap::Of::Cells);
        const volume::Box box = volume::test::unevenBox(lattice);
        if (even) lattice.axes = {};
        volume::Dataset dataset = volume::test::datasetOf(
            {volume::test::sampled<float>(lattice, [](glm::dvec3 p) { return 1e3 * p.x + 2e4 * p.z; })});
        dataset.info.bounds = box;
        dataset.info.parameters[0].name = "T";
        dataset.info.lengthUnit = "m";
        show(volume::makeMemorySource(std::move(dataset), {.brickSize = 8}));
        session.stretch = glm::dvec3(1);
    }
    template <class View>
    std::vector<DrawnText> textsOf(const char* pane, View& view,
                                   void (*function)(ViewContext&, const std::string&, View&), ImVec2 size) {
        for (int i = 0; i < 3; ++i) frame([&] { draw(pane, view, function, size); });
        return drawnTexts();
    }
    static bool says(const std::vector<DrawnText>& texts, const std::string& what) {
        return std::ranges::any_of(texts,
                                   [&](const DrawnText& each) { return each.text.find(what) != std::string::npos; });
    }
};

std::optional<double> tickNumber(const std::string& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

TEST_F(UnevenViews, SayThatTheyAreNotToScale) {
    showLayers();
    figure = true;
    session.stretch = {1, 5, 2};
    const std::string badge = "x, z by cells";
    EXPECT_TRUE(says(textsOf("volume", volumeView, drawVolumeView, {640, 480}), "stretch 1 : 5 : 2, " + badge));
    EXPECT_TRUE(says(textsOf("slices", slicesView, drawSlicesView, {640, 480}), badge));
    EXPECT_TRUE(says(textsOf("slices", slicesView, drawSlicesView, {150, 480}), "by cells")) << "a narrow pane, too";
    EXPECT_TRUE(says(textsOf("sliceMatrix", sliceMatrixView, drawSliceMatrixView, {640, 480}), badge));
    EXPECT_TRUE(says(textsOf("shadowCube", shadowCubeView, drawShadowCubeView, {640, 480}), badge));
    EXPECT_TRUE(says(textsOf("tesseract", tesseractView, drawTesseractView, {900, 480}), badge));
    showLayers(true);
    for (const auto& texts : {textsOf("volume", volumeView, drawVolumeView, {640, 480}),
                              textsOf("slices", slicesView, drawSlicesView, {640, 480}),
                              textsOf("shadowCube", shadowCubeView, drawShadowCubeView, {640, 480}),
                              textsOf("tesseract", tesseractView, drawTesseractView, {900, 480})})
        EXPECT_FALSE(says(texts, "by cells"));
}

TEST_F(UnevenViews, HaveAScaleBarOnlyAlongEvenAxes) {
    for (const bool even : {false, true}) {
        showLayers(even);
        session.camera.projection = vis::Projection::Orthographic;
        for (const auto& [view, axis] : {std::pair{vis::StandardView::Front, 0}, {vis::StandardView::Left, 2}}) {
            session.camera.orientation = vis::standardOrientation(view);
            const auto texts = textsOf("volume", volumeView, drawVolumeView, {640, 480});
            const bool bar = std::ranges::any_of(texts, [](const DrawnText& each) {
                return each.text.ends_with("m") && tickNumber(each.text.substr(0, each.text.find(' ')));
            });
            EXPECT_EQ(bar, even) << axis;
        }
    }
}

TEST_F(UnevenViews, TicksOfThe3DPictureStandAtTheirNumbers) {
    showLayers();
    volumeView.showAxes = true;
    session.camera = {};
    session.camera.projection = vis::Projection::Orthographic;
    session.camera.orientation = vis::standardOrientation(vis::StandardView::Front); // x to the right, y up
    vis::fit(session.camera, vis::worldFrame(source->info(), session.stretch), 640.0 / 480);
    session.camera.distance *= 1.4f; // room for numbers below the box
    decoration.legend = decoration.gizmo = decoration.scaleBar = false;
    const auto texts = textsOf("volume", volumeView, drawVolumeView, {640, 480});
    const volume::DatasetInfo& info = source->info();
    // Numbers in a row below the box.
    std::vector<std::pair<double, float>> row;
    float lowest = 0;
    for (const DrawnText& text : texts)
        if (tickNumber(text.text)) lowest = std::max(lowest, text.middle().y);
    for (const DrawnText& text : texts)
        if (const auto number = tickNumber(text.text); number && text.middle().y > lowest - 4)
            row.emplace_back(*number, text.middle().x);
    std::string all;
    for (const DrawnText& text : texts)
        all += text.text + " at " + std::to_string(text.middle().x) + "," + std::to_string(text.middle().y) + "; ";
    ASSERT_GE(row.size(), 3u) << all;
    std::ranges::sort(row);
    const vis::WorldFrame world = vis::worldFrame(info, session.stretch);
    const auto drawn = [&](double mm) { return world.toWorld(glm::dvec3(mm / 1000, info.bounds.lo.y, 0)).x; };
    // Pixels are proportional to places of the drawing.
    const double scale =
        (row.back().second - row.front().second) / (drawn(row.back().first) - drawn(row.front().first));
    EXPECT_GT(scale, 100);
    for (const auto& [number, x] : row)
        EXPECT_NEAR(x, row.front().second + (drawn(number) - drawn(row.front().first)) * scale, 2.5) << number;
}

TEST_F(UnevenViews, TicksOfSlicesStandAtTheirNumbers) {
    showLayers();
    ObliqueView tilted;
    tilted.normal = {0, 1, 0};
    const auto texts = textsOf("oblique", tilted, drawObliqueView, {900, 640});
    std::vector<std::pair<double, ImVec2>> numbers;
    for (const DrawnText& text : texts)
        if (const auto number = tickNumber(text.text); number && std::abs(*number) >= 0.9 && std::abs(*number) <= 3.1)
            numbers.emplace_back(*number, text.middle());
    ASSERT_GE(numbers.size(), 6u);
    // Of x and z both: each number lies at its place on the sheet, on the screen along one axis.
    const volume::AxisMaps& axes = source->info().lattice.axes;
    int rows = 0, columns = 0;
    for (const bool upright : {false, true}) {
        std::map<int, std::vector<std::pair<double, float>>> lines;
        for (const auto& [number, at] : numbers)
            lines[int(std::lround((upright ? at.x : at.y) / 6))].emplace_back(number, upright ? at.y : at.x);
        for (auto& [at, line] : lines) {
            if (line.size() < 3) continue;
            std::ranges::sort(line, {}, &std::pair<double, float>::first);
            const auto fits = [&](int axis) {
                const auto drawn = [&](double mm) {
                    return mm < 0 ? -axes.toSheet(axis, -mm / 1000) : axes.toSheet(axis, mm / 1000);
                };
                const double scale =
                    (line.back().second - line.front().second) / (drawn(line.back().first) - drawn(line.front().first));
                for (const auto& [number, pixel] : line)
                    if (std::abs(pixel - line.front().second - (drawn(number) - drawn(line.front().first)) * scale) > 4)
                        return false;
                return true;
            };
            EXPECT_TRUE(fits(0) || fits(2));
            ++(upright ? columns : rows);
        }
    }
    EXPECT_GE(rows, 1);
}

TEST_F(UnevenViews, EveryPaneDrawsAtEverySize) {
    showLayers();
    drawAllSizes();
    EXPECT_TRUE(messages.empty());
}

} // namespace
} // namespace tessera::app
