#include "app/drawing/drawing.h"
#include "app/planes/contour_data.h"
#include "app/planes/contour_labels.h"
#include "app/planes/plane_export.h"
#include "app/session/session_json.h"
#include "app/views/slices/slice_layout.h"
#include "tests/volume/regions.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <numbers>
#include <regex>

namespace tessera::app {
namespace {

double second(glm::dvec3 p) {
    return 300 + 50 * p.x + 30 * p.y * p.y + 10 * p.z;
}

/// "A", and "B" by the formula above.
std::shared_ptr<const volume::BrickSource> twoParameters() {
    const volume::Lattice grid = volume::test::ccLattice({41, 31, 21}, glm::dvec3(0.05));
    std::vector<volume::Field> fields;
    fields.push_back(volume::test::sampled<float>(grid, [](glm::dvec3 p) { return p.x - p.y; }));
    fields.push_back(volume::test::sampled<float>(grid, second));
    volume::Dataset data = volume::test::datasetOf(std::move(fields));
    data.info.parameters[0].name = "A";
    data.info.parameters[0].ranges = {{-1.5, 2}};
    data.info.parameters[1].name = "B";
    data.info.parameters[1].unit = "K";
    data.info.parameters[1].ranges = {{300, 477.5}};
    return volume::makeMemorySource(std::move(data), {});
}

bool inside(const LineLabel& label, glm::dvec2 point) {
    const glm::dvec2 right(std::cos(label.angle), std::sin(label.angle)), away = point - label.at;
    return std::abs(glm::dot(away, right)) < label.half.x &&
           std::abs(away.y * right.x - away.x * right.y) < label.half.y;
}

/// Lines of B in the plane through the middle of z, on a page of 600 x 450.
struct Page {
    Page() {
        levels = contourLevels({300, 477.5}, 12);
        const volume::Box& box = source->info().bounds;
        const ContourQuery query{
            1, planeAcross(0, 1, 2, box.center().z), {box.lo.x, box.hi.x}, {box.lo.y, box.hi.y}, {}, levels.values};
        for (const volume::ContourLine& line : readContours(*source, query).lines) {
            lines.push_back({contourText(line.level, levels.step), {}});
            for (const glm::dvec2& point : line.points) lines.back().points.push_back(onPage(point));
        }
        labels = placeLabels(lines, {{0, 0}, {600, 450}, 13, [](const std::string& text) {
                                         return 7.0 * static_cast<double>(text.size());
                                     }});
    }
    static glm::dvec2 onPage(glm::dvec2 at) { return {at.x * 300, 450 - at.y * 300}; }
    static glm::dvec3 inData(glm::dvec2 at) { return {at.x / 300, (450 - at.y) / 300, 0.5}; }

    std::shared_ptr<const volume::BrickSource> source = twoParameters();
    ContourLevels levels;
    std::vector<PageLine> lines;
    std::vector<LineLabel> labels;
};

TEST(ContourLevels, AreRoundAndInsideOfTheRange) {
    EXPECT_EQ(contourLevels(Range{0, 1}, 5).values, (std::vector<double>{0.2, 0.4, 0.6, 0.8}));
    EXPECT_EQ(contourLevels({300, 391}, 10).step, 10);
    EXPECT_EQ(contourLevels({310, 390}, 1).values, std::vector<double>{350}) << "a range has at least one";
    EXPECT_TRUE(contourLevels({2, 2}, 5).values.empty());
    EXPECT_TRUE(contourLevels(Range{0, 1}, 0).values.empty());
    for (int count = 1; count <= 50; ++count)
        EXPECT_LE(contourLevels({-3.7, 12.1}, count).values.size(), unsigned(count));
    EXPECT_EQ(contourText(0.30000000000000004, 0.1), "0.3");
    EXPECT_EQ(contourText(-1e-18, 1e-5), "0");
}

TEST(ContourLabels, AreTheValueOfTheFieldWhereTheyLie) {
    const Page page;
    ASSERT_EQ(page.levels.step, 20);
    ASSERT_GE(page.labels.size(), 6u);
    for (const LineLabel& label : page.labels) {
        EXPECT_NEAR(second(Page::inData(label.at)), std::stod(label.text), 0.2);
        EXPECT_EQ(label.text, page.lines[label.line].text);
        // Along the line, and upright: the field does not change in the direction of the text.
        EXPECT_GT(label.angle, -std::numbers::pi / 2);
        EXPECT_LE(label.angle, std::numbers::pi / 2);
        const glm::dvec2 reach = glm::dvec2(std::cos(label.angle), std::sin(label.angle)) * label.half.x;
        for (const glm::dvec2 end : {label.at - reach, label.at + reach})
            EXPECT_NEAR(second(Page::inData(end)), std::stod(label.text), 2) << label.text;
    }
}

TEST(ContourLabels, TheLabelOfAStraightLineStandsInItsMiddle) {
    const LabelPage page{{0, 0}, {600, 450}, 13, [](const std::string& text) { return 7.0 * double(text.size()); }};
    for (const glm::dvec2 end : {glm::dvec2(320, 60), glm::dvec2(100, 210), glm::dvec2(220, 160)}) {
        const glm::dvec2 begin(100, 60);
        const std::vector<LineLabel> labels = placeLabels({{"340", {begin, end}}}, page);
        ASSERT_EQ(labels.size(), 1u);
        EXPECT_LT(glm::distance(labels[0].at, (begin + end) / 2.0), page.height / 2 + 1e-9) << end.x << ' ' << end.y;
    }
}

TEST(ContourLabels, NeitherMeetEachOtherNorOtherLinesNorLeaveThePage) {
    const Page page;
    for (const LineLabel& label : page.labels) {
        const glm::dvec2 right(std::cos(label.angle), std::sin(label.angle)), down(-right.y, right.x);
        for (double u = -1; u <= 1; u += 0.1)
            for (double v = -1; v <= 1; v += 0.25) {
                const glm::dvec2 at = label.at + right * (u * label.half.x) + down * (v * label.half.y);
                EXPECT_TRUE(at.x > -1e-9 && at.y > -1e-9 && at.x < 600 + 1e-9 && at.y < 450 + 1e-9);
                for (const LineLabel& other : page.labels)
                    EXPECT_FALSE(&other != &label && inside(other, at)) << label.text << " and " << other.text;
            }
        for (std::size_t l = 0; l < page.lines.size(); ++l)
            for (const glm::dvec2& point : page.lines[l].points)
                EXPECT_FALSE(l != label.line && inside(label, point)) << label.text << " on " << page.lines[l].text;
    }
    // Beneath a text its own line is broken, elsewhere lines are whole.
    const auto pieces = linesAround(page.lines, page.labels);
    EXPECT_EQ(pieces.size(), page.lines.size() + page.labels.size());
    double whole = 0, left = 0, texts = 0;
    const auto lengthOf = [](const std::vector<glm::dvec2>& points) {
        double length = 0;
        for (std::size_t i = 1; i < points.size(); ++i) length += glm::distance(points[i - 1], points[i]);
        return length;
    };
    for (const PageLine& line : page.lines) whole += lengthOf(line.points);
    for (const LineLabel& label : page.labels) texts += 2 * label.half.x;
    for (const std::vector<glm::dvec2>& piece : pieces) {
        left += lengthOf(piece);
        for (const glm::dvec2& point : piece)
            for (LineLabel label : page.labels) {
                label.half *= 0.95;
                EXPECT_FALSE(inside(label, point)) << label.text;
            }
    }
    EXPECT_NEAR(whole - left, texts, 1e-6 * whole);
}

TEST(ContourLabels, AreLeftOutWhereALineIsShortOrBentOrCrowded) {
    const LabelPage page{{0, 0}, {400, 400}, 10, [](const std::string&) { return 30.0; }};
    std::vector<glm::dvec2> ring;
    for (int i = 0; i <= 60; ++i)
        ring.emplace_back(200 + 15 * std::cos(i * std::numbers::pi / 30),
                          200 + 15 * std::sin(i * std::numbers::pi / 30));
    EXPECT_TRUE(placeLabels({{"1", {{100, 100}, {150, 100}}}}, page).empty()) << "short";
    EXPECT_TRUE(placeLabels({{"1", ring}}, page).empty()) << "bent";
    EXPECT_TRUE(placeLabels({{"1", {{0, 2}, {400, 2}}}}, page).empty()) << "at the edge of the page";
    const std::vector<PageLine> crowd{{"1", {{0, 100}, {400, 100}}}, {"2", {{0, 103}, {400, 103}}}};
    EXPECT_TRUE(placeLabels(crowd, page).empty()) << "the other line runs through the text";
    const auto two = placeLabels({{"1", {{0, 100}, {390, 100}}}, {"2", {{399, 300}, {0, 300}}}}, page);
    ASSERT_EQ(two.size(), 2u);
    for (const LineLabel& label : two) EXPECT_EQ(label.angle, 0) << "upright, whichever way the line runs";
    EXPECT_GT(placeLabels({{"1", {{0, 100}, {2000, 100}}}}, {{0, 0}, {2000, 400}, 10, page.width}).size(), 3u);
}

TEST(Contours, StayInTheirRegion) {
    const volume::Lattice grid = volume::test::ccLattice({24, 20, 16}, glm::dvec3(1));
    const volume::test::TwoRegions regions;
    volume::Dataset data = volume::test::twoRegions(grid, volume::test::linearIn, regions);
    data.info.parameters[0].ranges = {{-2, 70}};
    const auto source = volume::makeMemorySource(std::move(data), {});
    // 30 lies in neither region, only between them.
    const volume::Box& box = source->info().bounds;
    const ContourQuery query{
        0, planeAcross(0, 2, 1, 9.5), {box.lo.x, box.hi.x}, {box.lo.z, box.hi.z}, {}, {4, 5, 30, 57}};
    const Contours contours = readContours(*source, query);
    std::size_t air = 0, fuel = 0;
    for (const volume::ContourLine& line : contours.lines) {
        const int region = line.level < 10 ? 1 : 3;
        (region == 1 ? air : fuel) += 1;
        for (const glm::dvec2& at : line.points) {
            const glm::dvec3 place(at.x, 9.5, at.y);
            EXPECT_NEAR(volume::test::linearIn(region, place), line.level, 0.05);
            // The region of the nearest sample is the point's: half a cell beyond the oblique border at most.
            EXPECT_EQ(regions.at(glm::round(place)), region);
        }
    }
    EXPECT_GT(air, 0u);
    EXPECT_GT(fuel, 0u);
}

TEST(Contours, AreInTheSvgWithTheirValuesAndBothNames) {
    const auto source = twoParameters();
    Session session = defaultSession(source->info(), {});
    SlicesView view;
    view.lines.count = 10;
    view.lines.channel = "B";
    const auto page = [&](const Progress& progress) {
        std::vector<PlanePicture> slices;
        for (const SliceAxes& axes : kSlicePlanes)
            slices.push_back(axisPlane(session, source->info(), axes, session.cursor[axes.normal], {0, view.lines}));
        return svgOf(planesPage(*source, slices, 2, {.legend = false}, progress));
    };
    const std::string plain = page({});
    EXPECT_EQ(plain.find("paint-order"), std::string::npos);
    EXPECT_NE(plain.find("<path"), std::string::npos);
    view.lines.values = true;
    std::vector<double> told;
    Progress progress;
    progress.report = [&](double fraction, const std::string&) { told.push_back(fraction); };
    const std::string svg = page(progress);
    EXPECT_GT(told.size(), 3u);
    EXPECT_TRUE(std::ranges::is_sorted(told)) << "progress never goes back";
    EXPECT_NE(svg.find("lines: B [K], 20 apart"), std::string::npos);
    EXPECT_NE(svg.find(", A "), std::string::npos) << "the parameter of the colours";
    const std::regex text("<text x=\"([0-9.]+)\" y=\"([0-9.]+)\"[^>]*paint-order[^>]*>([0-9.]+)</text>");
    int found[3] = {};
    for (auto at = std::sregex_iterator(svg.begin(), svg.end(), text); at != std::sregex_iterator(); ++at) {
        const double x = std::stod((*at)[1]), y = std::stod((*at)[2]);
        const int panel = (x > 300 ? 1 : 0) + (y > 240 ? 2 : 0);
        ++found[panel];
        const glm::dvec2 share((x - 300 * (panel % 2) - 62) / 226, 1 - (y - 240 * (panel / 2) - 22) / 176);
        // kSlicePlanes: (x, y), (z, y), (x, z); the axes are in the data's unit times what suits it.
        glm::dvec3 place = session.cursor;
        const SliceAxes& axes = kSlicePlanes[std::size_t(panel)];
        const glm::dvec3 size = source->info().bounds.size();
        place[axes.right] = share.x * size[axes.right];
        place[axes.up] = share.y * size[axes.up];
        EXPECT_NEAR(second(place), std::stod((*at)[3]), 0.5) << (*at)[0];
    }
    for (const int each : found) EXPECT_GT(each, 1);
}

TEST(Contours, SettingsAreKeptInASession) {
    const auto source = twoParameters();
    Session session = defaultSession(source->info(), {});
    SlicesView view;
    view.lines = {7, "B", true};
    session.views["lined"] = view;
    ObliqueView tilted;
    tilted.lines = view.lines;
    session.views["tilted"] = tilted;
    Session back;
    std::vector<JsonIssue> issues;
    fromJson(back, toJson(session), issues, "");
    EXPECT_TRUE(issues.empty());
    EXPECT_EQ(std::get<SlicesView>(back.views.at("lined")), view);
    EXPECT_EQ(std::get<ObliqueView>(back.views.at("tilted")), tilted);
    EXPECT_EQ(toJson(session)["views"]["tilted"]["contourOf"], "B") << "without a section around them";
    ContourSettings& lines = view.lines;
    EXPECT_EQ(contourChannel(source->info(), lines, 0), 1);
    lines.channel = "gone";
    EXPECT_FALSE(contourChannel(source->info(), lines, 0));
    const auto note = [&] {
        return planeNote(source->info(), axisPlane(session, source->info(), {}, session.cursor.z, {0, lines}));
    };
    EXPECT_EQ(note(), "no contour lines: there is no gone");
    lines.channel = "";
    EXPECT_EQ(contourChannel(source->info(), lines, 0), 0);
    lines.values = false;
    EXPECT_EQ(note(), "") << "the renderer draws them";
    lines.count = 0;
    EXPECT_FALSE(contourChannel(source->info(), lines, 0));
    const PlaneContent stroked{.channel = 0, .lines = lines, .strokes = {.vector = "gone"}};
    EXPECT_EQ(planeNote(source->info(), axisPlane(session, source->info(), {}, session.cursor.z, stroked)),
              "no strokes: there is no vector gone");
}

} // namespace
} // namespace tessera::app
