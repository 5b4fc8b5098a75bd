#include "app/ui/widgets.h"
#include "app/views/tesseract/tesseract_brush.h"
#include "app/views/tesseract/tesseract_cloud.h"
#include "app/views/tesseract/tesseract_turn.h"
#include "tests/app/drawn_text.h"
#include "tests/app/views_fixture.h"
#include "vis/scene/selection.h"
#include "volume/derived/derived.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>

namespace tessera::app {
namespace {

using testing::HasSubstr;

class TesseractViews : public ViewsTest {
protected:
    TesseractFrame frameOfView() {
        TesseractFrame out;
        out.min = {100, 80};
        out.max = {500, 420};
        out.axes = tesseractAxes(source->info(), tesseractView);
        out.count = int(out.axes.size());
        out.rotation = vis::rotationOf(anglesOf(tesseractView, out.count));
        out.projection = {double(tesseractView.eye), 3, double(tesseractView.zoom), tesseractView.parallel};
        out.half = halfEdges(tesseractView, source->info().bounds, session.stretch, out.axes.size());
        return out;
    }
    /// The data with the parameters of the session computed.
    void compute() {
        const auto derived = session.data.derived;
        std::vector<std::string> problems;
        source = volume::deriveAll(volume::underived(source), derived, problems);
        ASSERT_TRUE(problems.empty());
        renderer.setSource(source);
    }
    /// A drag with the left button through these places.
    void drag(const std::vector<ImVec2>& places) {
        const TesseractFrame seen = frameOfView();
        const auto body = [&] {
            ViewContext context{session, source, renderer, jobs, caches};
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize({640, 480});
            ImGui::Begin("window", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
            ImGui::SetCursorScreenPos(seen.min);
            mouseArea("picture", {seen.max.x - seen.min.x, seen.max.y - seen.min.y},
                      ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
            taken = editTesseractBrush(context, brush, tesseractView, seen);
            ImGui::End();
        };
        mouse = places.front();
        frame(body), frame(body);
        ImGui::GetIO().MouseDown[0] = true;
        frame(body);
        for (const ImVec2 place : places) mouse = place, frame(body);
        ImGui::GetIO().MouseDown[0] = false;
        frame(body), frame(body);
    }
    /// Counts the samples that the brushes select, and checks that these are those whose points lie inside a shape of
    /// pixels; those at its rim may be either.
    template <class Inside> std::size_t expectSelected(Inside&& inside, const std::function<bool(ImVec2)>& atRim) {
        const TesseractFrame seen = frameOfView();
        const volume::DatasetInfo& info = source->info();
        const vis::DoiFunction interest(session.selection);
        volume::SamplesQuery query{{0}, {}, 10000000};
        for (int t = 0; t < int(info.times.size()); ++t) query.times.push_back(t);
        for (const std::string& name : interest.channels()) query.channels.push_back(info.findChannel(name).value());
        const volume::Samples4 samples = volume::gatherSamples(*source, query);
        vis::CloudStyle style;
        style.bounds = info.bounds;
        style.half = seen.half;
        style.fourth = seen.axes[3].range;
        style.transfer.opacity = {{0, 1}, {1, 1}};
        std::size_t selected = 0, wrong = 0, checked = 0;
        for (const vis::CloudPoint& point : vis::makeCloud(samples, style)) {
            const ImVec2 at = seen.pixel(seen.project(vis::pointOf(glm::dvec4(point.position))).at);
            if (atRim(at)) continue;
            std::vector<double> values;
            for (int c = 1; c < samples.channels; ++c)
                values.push_back(double(samples.values[point.sample * std::size_t(samples.channels) + std::size_t(c)]));
            const bool is = interest(values, glm::dvec3(samples.positions[point.sample])) > 0.5;
            selected += is ? 1 : 0;
            wrong += is != inside(at) ? 1 : 0;
            ++checked;
        }
        EXPECT_EQ(wrong, 0u) << "of " << checked;
        return selected;
    }

    BrushDrag brush;
    bool taken = false;
};

TEST_F(TesseractViews, ABoxSelectsExactlyTheSamplesInIt) {
    show(fuelCell(volume::LatticeKind::CC));
    tesseractView.hand = TesseractHand::Box;
    drag({{200, 150}, {300, 300}});
    EXPECT_FALSE(taken) << "turned, and in perspective, no box of the picture is one of the data";
    EXPECT_TRUE(session.selection.brushes.empty());
    // x to the right and t upwards.
    tesseractView.turn = {0, 0, 0};
    tesseractView.turn4 = {0, -80, 0};
    turnToBrush(session, source->info(), tesseractView, frameOfView());
    EXPECT_TRUE(tesseractView.parallel);
    const auto faced = vis::facedAxes(frameOfView().rotation);
    ASSERT_TRUE(faced);
    EXPECT_EQ((*faced)[0], 0);
    EXPECT_EQ((*faced)[1], 3);
    EXPECT_EQ(session.data.derived.size(), 2u) << "position and time";
    drag({{200, 150}, {300, 300}});
    EXPECT_FALSE(taken) << "until position and time are computed";
    compute();
    const ImVec2 a{231.3f, 112.7f}, b{317.9f, 262.1f};
    drag({a, {280, 200}, b});
    EXPECT_TRUE(taken);
    ASSERT_EQ(session.selection.brushes.size(), 1u);
    ASSERT_TRUE(std::holds_alternative<vis::RangeRegion>(session.selection.brushes[0].region));
    const auto near = [](float x, float y) { return std::abs(x - y) < 0.05f; };
    const std::size_t selected = expectSelected(
        [&](ImVec2 at) { return at.x > a.x && at.x < b.x && at.y > a.y && at.y < b.y; },
        [&](ImVec2 at) { return near(at.x, a.x) || near(at.x, b.x) || near(at.y, a.y) || near(at.y, b.y); });
    EXPECT_GT(selected, 50u);
}

TEST_F(TesseractViews, ALassoSelectsTheSamplesInIt) {
    show(fuelCell(volume::LatticeKind::CC));
    tesseractView.hand = TesseractHand::Lasso;
    tesseractView.turn = {90, -80, 0}; // z to the right, x upwards
    turnToBrush(session, source->info(), tesseractView, frameOfView());
    compute();
    const std::vector<ImVec2> corners{{220, 330}, {330, 320}, {390, 200}, {260, 170}};
    std::vector<ImVec2> places;
    for (std::size_t i = 0; i < 4; ++i)
        for (int step = 0; step < 12; ++step) {
            const ImVec2 from = corners[i], to = corners[(i + 1) % 4];
            const float share = float(step) / 12;
            places.push_back({from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share});
        }
    drag(places);
    ASSERT_EQ(session.selection.brushes.size(), 1u);
    ASSERT_TRUE(std::holds_alternative<vis::LassoRegion>(session.selection.brushes[0].region));
    const auto side = [&](std::size_t i, ImVec2 at) { // pixels to the inside of an edge
        const ImVec2 from = corners[i], to = corners[(i + 1) % 4];
        const float length = std::hypot(to.x - from.x, to.y - from.y);
        return ((to.y - from.y) * (at.x - from.x) - (to.x - from.x) * (at.y - from.y)) / length;
    };
    const auto inside = [&](ImVec2 at) {
        for (std::size_t i = 0; i < 4; ++i)
            if (side(i, at) < 0) return false;
        return true;
    };
    const auto atRim = [&](ImVec2 at) { // lassos are tables of 128 entries a side
        for (std::size_t i = 0; i < 4; ++i)
            if (std::abs(side(i, at)) < 3) return true;
        return false;
    };
    EXPECT_GT(expectSelected(inside, atRim), 50u);
}

/// The built-in cell with cells of one height.
std::shared_ptr<const volume::BrickSource> evenCell() {
    return volume::makeMemorySource(
        volume::makeModel("fuel-cell", {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 2}, {"even", 1}}), {});
}

// At any turn a lasso is one of the two coordinates of the picture, which are sums of all axes.
TEST_F(TesseractViews, ALassoAtAnyTurnSelectsTheSamplesInIt) {
    show(evenCell());
    tesseractView.hand = TesseractHand::Lasso;
    tesseractView.turn = {25, -35, 50};
    tesseractView.turn4 = {20, -30, 40};
    brushAtThisTurn(session, source->info(), tesseractView, frameOfView());
    EXPECT_TRUE(tesseractView.parallel);
    EXPECT_FALSE(vis::facedAxes(frameOfView().rotation));
    ASSERT_EQ(session.data.derived.size(), 2u);
    drag({{200, 150}, {300, 300}, {200, 300}});
    EXPECT_FALSE(taken) << "until they are computed";
    compute();
    const std::vector<ImVec2> corners{{250, 330}, {390, 300}, {370, 170}, {240, 190}};
    std::vector<ImVec2> places;
    for (std::size_t i = 0; i < 4; ++i)
        for (int step = 0; step < 12; ++step) {
            const ImVec2 from = corners[i], to = corners[(i + 1) % 4];
            const float share = float(step) / 12;
            places.push_back({from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share});
        }
    drag(places);
    EXPECT_TRUE(taken);
    ASSERT_EQ(session.selection.brushes.size(), 1u);
    const auto side = [&](std::size_t i, ImVec2 at) {
        const ImVec2 from = corners[i], to = corners[(i + 1) % 4];
        const float length = std::hypot(to.x - from.x, to.y - from.y);
        return ((to.y - from.y) * (at.x - from.x) - (to.x - from.x) * (at.y - from.y)) / length;
    };
    const auto inside = [&](ImVec2 at) {
        for (std::size_t i = 0; i < 4; ++i)
            if (side(i, at) < 0) return false;
        return true;
    };
    const auto atRim = [&](ImVec2 at) {
        for (std::size_t i = 0; i < 4; ++i)
            if (std::abs(side(i, at)) < 3) return true;
        return false;
    };
    EXPECT_GT(expectSelected(inside, atRim), 50u);
    // Turned on, the brush stays what it is, and another needs other coordinates.
    tesseractView.turn4 = {60, -30, 40};
    drag({{200, 150}, {300, 300}, {200, 300}});
    EXPECT_FALSE(taken);
    EXPECT_EQ(session.selection.brushes.size(), 1u);
    const auto body = [&] { draw("tesseract", tesseractView, drawTesseractView, {800, 600}); };
    frame(body);
    EXPECT_THAT(said(body), HasSubstr("Brush at this turn"));
    brushAtThisTurn(session, source->info(), tesseractView, frameOfView());
    EXPECT_THAT(said(body), HasSubstr("once its coordinates are computed"));
    EXPECT_EQ(session.data.derived.size(), 4u);
}

// A formula means a parameter of the name of a coordinate: then it cannot be of the coordinate.
TEST_F(TesseractViews, CoordinatesOfThePictureAreNotParametersOfTheirNames) {
    show(evenCell());
    tesseractView.turn = {25, -35, 50};
    tesseractView.turn4 = {20, -30, 40};
    const TesseractFrame seen = frameOfView();
    volume::DatasetInfo info = source->info();
    EXPECT_FALSE(turnedFormulas(info, seen)[0].empty());
    info.parameters.push_back(info.parameters[0]);
    for (const char* name : {"x", "t"}) {
        info.parameters.back().name = name;
        EXPECT_TRUE(turnedFormulas(info, seen)[0].empty()) << name;
    }
    info.parameters.back().name = "w";
    EXPECT_FALSE(turnedFormulas(info, seen)[0].empty());
}

TEST_F(TesseractViews, SaysWhyNoBrushCanBeDrawnAndTurnsThere) {
    show(fuelCell(volume::LatticeKind::CC));
    tesseractView.hand = TesseractHand::Box;
    const auto body = [&] { draw("tesseract", tesseractView, drawTesseractView, {800, 600}); };
    frame(body);
    EXPECT_THAT(said(body), HasSubstr("only where two axes lie along the picture's"));
    EXPECT_THAT(said(body), HasSubstr("Turn to x and t")) << "y is drawn by cells";
    tesseractView.turn = {0, 0, 0};
    tesseractView.parallel = true;
    EXPECT_THAT(said(body), HasSubstr("The axis y is drawn by cells"));
    EXPECT_THAT(said(body), HasSubstr("Turn to x and z"));
    turnToBrush(session, source->info(), tesseractView, frameOfView());
    EXPECT_THAT(said(body), HasSubstr("once position or time are computed"));
    const auto added = session.data.derived;
    session.data.derived.clear();
    EXPECT_THAT(said(body), HasSubstr("need position or time as parameters"));
    session.data.derived = added;
    compute();
    EXPECT_THAT(said(body), testing::Not(HasSubstr("position or time")));
}

TEST_F(TesseractViews, SaysWhichShareOfTheSamplesIsDrawn) {
    show(fuelCell(volume::LatticeKind::CC));
    const auto body = [&] { draw("tesseract", tesseractView, drawTesseractView, {800, 600}); };
    const auto words = [&] {
        for (int i = 0; i < 2; ++i) frame(body);
        std::string all;
        for (const DrawnText& text : drawnTexts()) all += text.text + "\n";
        return all;
    };
    EXPECT_THAT(words(), HasSubstr("100 % of the lattice"));
    tesseractView.points = 1000;
    EXPECT_THAT(words(), HasSubstr(formatShare(1000.0 / (7 * 9 * 21 * 2)) + " of the lattice"));
    tesseractView.points = 150000;
    tesseractView.samples = volume::SampleLattice::D4;
    EXPECT_THAT(words(), HasSubstr("50 % of the lattice; a D4* lattice"));
}

// Axes of parameters, with their names, units and the numbers at their ends.
TEST_F(TesseractViews, FurtherAxesHaveSlidersNamesAndNumbers) {
    show(fuelCell(volume::LatticeKind::CC));
    const volume::DatasetInfo& info = source->info();
    const int temperature = info.findChannel("T").value();
    tesseractView.more = {"T", "no such"};
    tesseractView.turnMore = {60, 0, 0, 0};
    const auto body = [&] { draw("tesseract", tesseractView, drawTesseractView, {900, 800}); };
    for (int i = 0; i < 2; ++i) frame(body);
    std::string all;
    for (const DrawnText& text : drawnTexts()) all += text.text + "\n";
    EXPECT_THAT(all, HasSubstr("5 axes"));
    EXPECT_THAT(all, HasSubstr("xT  60"));
    const Range range = info.channelRange(info.channel(temperature));
    const auto end = [&](double value) { return formatQuantity(value, "K", (range.hi - range.lo) / 100); };
    EXPECT_TRUE(all.find(end(range.lo)) != std::string::npos || all.find(end(range.hi)) != std::string::npos);
    // A turn by hand goes on in five dimensions.
    turn(tesseractView, 5, vis::planeRotation(0, 4, 0.3));
    EXPECT_EQ(tesseractView.turnMore.size(), 4u);
    const vis::RotationN turned = vis::rotationOf(anglesOf(tesseractView, 5));
    for (int row = 0; row < 5; ++row) EXPECT_NEAR((turned * turned.inverse()).at(row, row), 1, 1e-6);
}

} // namespace
} // namespace tessera::app
