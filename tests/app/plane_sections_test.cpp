#include "app/drawing/line_pieces.h"
#include "app/pages/plot_page.h"
#include "app/planes/plane_export.h"
#include "app/session/session_json.h"
#include "app/tools/plane_sections.h"
#include "app/views/slices/slice_layout.h"
#include "tests/app/fed_imgui.h"
#include "tests/volume/regions.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <numbers>
#include <random>
#include <regex>

/// Lenses, brushes and contour lines where they cross planes.
namespace tessera::app {
namespace {

const volume::Box kSectionBox{{-1, 0.5, 2}, {3, 1.5, 5}};

struct SectionRandom {
    std::mt19937 engine{5};
    double operator()(double lo, double hi) { return std::uniform_real_distribution(lo, hi)(engine); }
    PicturePlane plane() {
        const glm::dvec3 normal = unitNormal({(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)});
        const FlatAxes axes = flatAxes(normal, vis::worldFrame(kSectionBox, glm::dvec3(1)));
        return {{(*this)(-1, 3), (*this)(0.5, 1.5), (*this)(2, 5)}, axes.right, axes.up};
    }
};

volume::DatasetInfo sectionInfo() {
    volume::DatasetInfo info;
    info.bounds = kSectionBox;
    return info;
}

TEST(PlaneSections, OfABallLieOnItAndInThePlane) {
    SectionRandom random;
    int met = 0;
    for (int i = 0; i < 200; ++i) {
        const vis::SphereRegion ball{.center = {random(0, 2), random(0.7, 1.3), random(3, 4)},
                                     .radius = {random(0.2, 1), random(0.1, 0.4), random(0.2, 1)}};
        Session session;
        session.selection.brushes.resize(1);
        session.selection.brushes[0].region = ball;
        session.selection.brushes[0].enabled = i % 2 == 0;
        const PicturePlane plane = random.plane();
        const auto sections = planeSections(session, sectionInfo(), plane);
        // How near the plane comes to the middle, where the ball is round.
        const glm::dvec3 slant = plane.plane().normal * ball.radius;
        const double nearest = std::abs(plane.plane().distance(ball.center)) / glm::length(slant);
        ASSERT_EQ(sections.size(), nearest < 1 ? 1u : 0u) << nearest;
        if (sections.empty()) continue;
        ++met;
        EXPECT_EQ(sections[0].faint, i % 2 == 1);
        EXPECT_FALSE(sections[0].dashed);
        EXPECT_GE(sections[0].outline.size(), 32u);
        for (const glm::dvec2& point : sections[0].outline)
            EXPECT_NEAR(glm::length((plane.placeAt(point) - ball.center) / ball.radius), 1, 1e-9);
    }
    EXPECT_GT(met, 40);
}

TEST(PlaneSections, OfABoxAreItsPolygonInThePlane) {
    Session session;
    session.selection.brushes.resize(1);
    session.selection.brushes[0].region = vis::BoxRegion{.center = {1, 1, 3.5}, .radius = {0.5, 0.25, 1}};
    const auto across = planeSections(session, sectionInfo(), planeAcross(2, 1, 0, 1.2));
    ASSERT_EQ(across.size(), 1u);
    ASSERT_EQ(across[0].outline.size(), 4u);
    for (const glm::dvec2& corner : across[0].outline) {
        EXPECT_NEAR(std::abs(corner.x - 3.5), 1, 1e-12) << "z to the right";
        EXPECT_NEAR(std::abs(corner.y - 1), 0.25, 1e-12);
    }
    EXPECT_TRUE(planeSections(session, sectionInfo(), planeAcross(2, 1, 0, 1.6)).empty());
    const glm::dvec3 normal = unitNormal({1, 0, 1});
    const PicturePlane slanted{{1, 1, 3.5}, glm::normalize(glm::dvec3(1, 0, -1)), {0, 1, 0}};
    const auto tilted = planeSections(session, sectionInfo(), slanted);
    ASSERT_EQ(tilted.size(), 1u);
    ASSERT_EQ(tilted[0].outline.size(), 4u);
    for (const glm::dvec2& corner : tilted[0].outline) {
        const glm::dvec3 place = slanted.placeAt(corner);
        EXPECT_NEAR(glm::dot(place - glm::dvec3(1, 1, 3.5), normal), 0, 1e-12);
        EXPECT_NEAR(std::abs(place.x - 1), 0.5, 1e-12) << "it leaves by the faces across x";
        EXPECT_NEAR(std::abs(place.y - 1), 0.25, 1e-12);
    }
}

TEST(PlaneSections, OfALensAreDashedWithItsMiddle) {
    SectionRandom random;
    int met = 0;
    for (int i = 0; i < 60; ++i) {
        Session session;
        session.stretch = {random(0.5, 2), random(0.5, 2), random(0.5, 2)};
        session.lenses = {vis::Lens{.size = {0.3f, 0.2f, 0.25f}, .rotation = {30, 40, 50}}};
        session.lenses[0].center = {1, 1, 3.5};
        const vis::WorldFrame world = vis::worldFrame(kSectionBox, session.stretch);
        // Axes at right angles in the stretched world as well, as those of slices are.
        const glm::dvec3 normal = unitNormal({random(-1, 1), random(-1, 1), random(-1, 1)});
        const FlatAxes axes = flatAxes(normal, world);
        const PicturePlane plane{{random(0, 2), 1, random(3, 4)}, axes.right, axes.up};
        const vis::PlacedLens placed = vis::placeLenses(session.lenses, world, {}, {}).front();
        const auto sections = planeSections(session, sectionInfo(), plane);
        if (sections.empty()) continue;
        ++met;
        EXPECT_TRUE(sections[0].dashed);
        ASSERT_TRUE(sections[0].middle);
        EXPECT_LT(glm::distance(*sections[0].middle, plane.along({1, 1, 3.5})), 1e-6);
        for (const glm::dvec2& point : sections[0].outline)
            EXPECT_NEAR(placed.radius(world.toWorld(plane.placeAt(point))), 1, 1e-6);
        session.lenses[0].enabled = false;
        EXPECT_TRUE(planeSections(session, sectionInfo(), plane).empty());
    }
    EXPECT_GT(met, 20);
}

TEST(LinePieces, LieInThePolygonAndAreAllOfIt) {
    SectionRandom random;
    for (int i = 0; i < 200; ++i) {
        std::vector<glm::dvec2> polygon, line;
        const int corners = 3 + i % 4;
        for (int k = 0; k < corners; ++k) {
            const double angle = 2 * std::numbers::pi * (i % 2 ? k : -k) / corners;
            polygon.emplace_back(std::cos(angle), std::sin(angle));
        }
        const auto inside = [&](glm::dvec2 at, double slack) {
            for (int k = 0; k < corners; ++k) {
                const double angle = 2 * std::numbers::pi * (k + 0.5) / corners;
                if (glm::dot(at, {std::cos(angle), (i % 2 ? 1 : -1) * std::sin(angle)}) >
                    std::cos(std::numbers::pi / corners) + slack)
                    return false;
            }
            return true;
        };
        for (int k = 0; k < 6; ++k) line.emplace_back(random(-1.5, 1.5), random(-1.5, 1.5));
        double kept = 0, expected = 0;
        for (const auto& piece : piecesWithin(line, polygon))
            for (std::size_t k = 0; k < piece.size(); ++k) {
                EXPECT_TRUE(inside(piece[k], 1e-9));
                if (k > 0) kept += glm::distance(piece[k - 1], piece[k]);
            }
        constexpr int kSteps = 4000;
        for (std::size_t k = 1; k < line.size(); ++k)
            for (int s = 0; s < kSteps; ++s)
                if (inside(line[k - 1] + (line[k] - line[k - 1]) * ((s + 0.5) / kSteps), 0))
                    expected += glm::distance(line[k - 1], line[k]) / kSteps;
        EXPECT_NEAR(kept, expected, 5e-3);
    }
    const auto whole = piecesWithin({{0.1, 0.1}, {0.2, 0.1}, {0.2, 0.2}}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    ASSERT_EQ(whole.size(), 1u);
    EXPECT_EQ(whole[0].size(), 3u) << "one piece where nothing is cut";
    EXPECT_TRUE(piecesWithin({{0, 0}, {1, 1}}, {{0, 0}, {1, 0}}).empty());
}

TEST(LinePieces, DashesGoOnAroundCorners) {
    DashPattern dashes(3, 5);
    std::vector<glm::dvec2> ends;
    double drawn = 0;
    const auto each = [&](glm::dvec2 a, glm::dvec2 b) {
        ends.push_back(b);
        drawn += glm::distance(a, b);
    };
    dashes.line({0, 0}, {4, 0}, each); // 0..3
    dashes.line({4, 0}, {4, 7}, each); // 5..8 is from 1 to 4 of this one, 10..11 from 6
    ASSERT_EQ(ends.size(), 3u);
    EXPECT_NEAR(ends[0].x, 3, 0.01);
    EXPECT_NEAR(ends[1].y, 4, 0.01);
    EXPECT_NEAR(ends[2].y, 7, 0.01);
    EXPECT_NEAR(drawn, 7, 0.03);
}

/// A field that is linear in space, so that its lines in any plane are straight from edge to edge.
std::shared_ptr<const volume::BrickSource> linearData() {
    volume::Dataset data = volume::test::datasetOf([] {
        std::vector<volume::Field> fields;
        fields.push_back(volume::test::sampled<float>(volume::test::ccLattice({33, 25, 41}, glm::dvec3(0.1)),
                                                      [](glm::dvec3 p) { return 3 * p.x - 2 * p.y + p.z; }));
        return fields;
    }());
    data.info.parameters[0].name = "A";
    data.info.parameters[0].ranges = {{-4.8, 13.6}};
    return volume::makeMemorySource(std::move(data), {});
}

double linearValue(glm::dvec3 p) {
    return 3 * p.x - 2 * p.y + p.z;
}

TEST(ObliqueContours, RunToTheFacesOfTheDataAtTheirValue) {
    const auto source = linearData();
    const volume::Box& box = source->info().bounds;
    Session session = defaultSession(source->info(), {});
    session.cursor = box.center();
    for (const glm::dvec3 normal : {glm::dvec3(-1, 0, 1), glm::dvec3(0.5, 0.7, 0.3), glm::dvec3(1, 1, 1)}) {
        const PlanePicture flat = tiltedPlane(session, source->info(), normal, {});
        const ContourQuery query{0, flat.plane, flat.x, flat.y, {}, {2, 4, 6}};
        const Contours contours = readContours(*source, query);
        std::size_t levels = 0;
        for (const double level : query.levels) {
            double length = 0;
            for (const volume::ContourLine& line : contours.lines) {
                if (line.level != level) continue;
                for (std::size_t i = 0; i < line.points.size(); ++i) {
                    const glm::dvec3 place = flat.placeAt(line.points[i]);
                    EXPECT_NEAR(linearValue(place), level, 2e-3);
                    EXPECT_LT(glm::distance(glm::clamp(place, box.lo, box.hi), place), 1e-9) << "not beside the data";
                    if (i > 0) length += glm::distance(line.points[i - 1], line.points[i]);
                }
            }
            // From end to end of where the plane of this value meets the polygon.
            std::vector<glm::dvec3> ends;
            for (std::size_t i = 0; i < flat.corners.size(); ++i) {
                const glm::dvec3 a = flat.corners[i], b = flat.corners[(i + 1) % flat.corners.size()];
                const double from = linearValue(a) - level, to = linearValue(b) - level;
                if ((from < 0) != (to < 0)) ends.push_back(a + (b - a) * (from / (from - to)));
            }
            if (ends.size() != 2) continue;
            ++levels;
            EXPECT_NEAR(length, glm::distance(ends[0], ends[1]), 1e-3) << level;
        }
        EXPECT_GT(levels, 1u);
    }
}

/// The texts of contour lines in a figure of one panel, as place (in data units) and value.
std::vector<std::pair<glm::dvec2, double>> labelsIn(const std::string& svg, Range x, Range y) {
    std::vector<std::pair<glm::dvec2, double>> out;
    const std::regex text("<text x=\"([0-9.]+)\" y=\"([0-9.]+)\"[^>]*paint-order[^>]*>(-?[0-9.]+)</text>");
    for (auto at = std::sregex_iterator(svg.begin(), svg.end(), text); at != std::sregex_iterator(); ++at) {
        const glm::dvec2 share((std::stod((*at)[1]) - 62) / kFigurePlot.x,
                               1 - (std::stod((*at)[2]) - 22) / kFigurePlot.y);
        out.push_back({{std::lerp(x.lo, x.hi, share.x), std::lerp(y.lo, y.hi, share.y)}, std::stod((*at)[3])});
    }
    return out;
}

TEST(ObliqueContours, AFigureHasThemWithValuesAndTheOutlinesOfLensesAndBrushes) {
    const auto source = linearData();
    Session session = defaultSession(source->info(), {});
    session.cursor = source->info().bounds.center();
    const PlanePicture flat = tiltedPlane(session, source->info(), {-1, 0.3, 1}, {0, {12, "", true}});
    const auto plain = [&] { // with what the session has then
        return svgOf(planesPage(*source, {tiltedPlane(session, source->info(), {-1, 0.3, 1}, {})}, 1, {}));
    };
    const auto slices = [&] {
        std::vector<PlanePicture> pictures;
        for (const SliceAxes& axes : kSlicePlanes)
            pictures.push_back(axisPlane(session, source->info(), axes, session.cursor[axes.normal], {}));
        return svgOf(planesPage(*source, pictures, 2, {}));
    };
    std::string svg = svgOf(planesPage(*source, {flat}, 1, {}));
    EXPECT_NE(svg.find("lines: A, 2 apart"), std::string::npos);
    const auto labels = labelsIn(svg, flat.x, flat.y);
    EXPECT_GT(labels.size(), 3u);
    for (const auto& [place, value] : labels) EXPECT_NEAR(linearValue(flat.placeAt(place)), value, 0.1);
    const auto count = [&](const std::string& what) {
        std::size_t found = 0;
        for (std::size_t at = svg.find(what); at != std::string::npos; at = svg.find(what, at + 1)) ++found;
        return found;
    };
    const std::string brushed = "stroke=\"#b30000\"", lensed = "stroke=\"#0000b3\""; // seven tenths of pure colours
    EXPECT_EQ(count(brushed) + count(lensed), 0u);
    session.selection.brushes.resize(1);
    session.selection.brushes[0].color = {1, 0, 0};
    session.selection.brushes[0].region = vis::SphereRegion{.center = session.cursor, .radius = glm::dvec3(0.4)};
    session.lenses = {vis::Lens{}};
    session.lenses[0].color = {0, 0, 1};
    session.lenses[0].center = session.cursor;
    svg = plain();
    EXPECT_EQ(count(brushed), 1u) << "one whole line";
    EXPECT_GT(count(lensed), 10u) << "dashes";
    EXPECT_EQ(count("fill=\"#0000b3\""), 1u) << "its middle";
    svg = slices();
    EXPECT_EQ(count(brushed), 3u) << "in each of the three slices";
    EXPECT_EQ(count("fill=\"#0000b3\""), 3u);
    // A ball beyond the edge of the data ends at the edge of the picture.
    session.selection.brushes[0].region = vis::SphereRegion{.center = session.cursor, .radius = glm::dvec3(50)};
    svg = slices();
    EXPECT_EQ(count(brushed), 0u);
}

} // namespace
} // namespace tessera::app
