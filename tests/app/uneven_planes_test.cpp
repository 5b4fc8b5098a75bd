#include "app/pages/plot_page.h"
#include "app/pane/axes3d.h"
#include "app/pane/scale_bar.h"
#include "app/planes/contour_data.h"
#include "app/planes/plane_export.h"
#include "app/planes/plane_picture.h"
#include "app/views/curves/profile_data.h"
#include "tests/app/uneven_layers.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

/// Slices, profiles and exports of data with uneven axes: what names a place names it in space.
namespace tessera::app {
namespace {

using volume::AxisMap;
using volume::test::layeredLattice;

TEST(UnevenPlanes, NamePlacesInSpace) {
    for (const auto of : {AxisMap::Of::Cells, AxisMap::Of::Points}) {
        const auto source = unevenLayers(of);
        const volume::DatasetInfo& info = source->info();
        Session session = defaultSession(info, {});
        UnevenPlaces random;
        for (int i = 0; i < 100; ++i) {
            session.cursor = random.drawn(info);
            const int normal = i % 3, right = (normal + 1) % 3, up = (normal + 2) % 3;
            const PlanePicture across =
                axisPlane(session, info, {right, up, normal}, session.cursor[normal], {.channel = 0});
            const PlanePicture tilted =
                tiltedPlane(session, info, {random(-1, 1), random(-1, 1), random(-1, 1)}, {.channel = 0});
            for (const PlanePicture& picture : {across, tilted}) {
                ASSERT_TRUE(picture.cursor);
                const glm::dvec3 place = picture.placeAt(*picture.cursor);
                // To a hundredth of a cell, and by far.
                EXPECT_LT(glm::length((place - session.cursor) / info.lattice.lengthsAt(session.cursor)), 1e-5);
                EXPECT_GE(picture.cursor->x, picture.x.lo - 1e-12);
                EXPECT_LE(picture.cursor->x, picture.x.hi + 1e-12);
                const glm::dvec3 nearest = nearestPlace(picture, info.bounds, *picture.cursor);
                EXPECT_LT(glm::length((nearest - session.cursor) / info.lattice.lengthsAt(session.cursor)), 1e-5);
                // Corners are places of the box.
                for (const glm::dvec3& corner : picture.corners)
                    for (int axis = 0; axis < 3; ++axis) {
                        EXPECT_GE(corner[axis], info.bounds.lo[axis] - 1e-12);
                        EXPECT_LE(corner[axis], info.bounds.hi[axis] + 1e-12);
                    }
            }
            // The number at the cross-hair on each axis is its place.
            const double shown = across.right.scale().number(across.cursor->x * across.right.unit.perUnit);
            EXPECT_NEAR(shown, session.cursor[right] * across.right.unit.perUnit, 1e-6);
        }
    }
}

TEST(UnevenPlanes, CellsAreEquallyThickInThem) {
    const auto source = unevenLayers(AxisMap::Of::Cells);
    const volume::DatasetInfo& info = source->info();
    const Session session = defaultSession(info, {});
    const PlanePicture picture = axisPlane(session, info, {0, 2, 1}, session.cursor.y, {.channel = 0});
    for (int k = 0; k + 1 < info.lattice.size.z; ++k) {
        const double a = picture.along(info.lattice.position({0, 0, k})).y,
                     b = picture.along(info.lattice.position({0, 0, k + 1})).y;
        EXPECT_NEAR((b - a) / (picture.y.hi - picture.y.lo), 1.0 / info.lattice.size.z, 1e-9);
    }
}

TEST(UnevenPlanes, TheWheelStepsBySamples) {
    const auto source = unevenLayers(AxisMap::Of::Cells);
    const volume::DatasetInfo& info = source->info();
    Session session = defaultSession(info, {});
    session.cursor = info.lattice.position({4, 4, 0});
    for (int k = 1; k < info.lattice.size.z; ++k) {
        const PlanePicture picture = axisPlane(session, info, {0, 1, 2}, session.cursor.z, {.channel = 0});
        stepAcross(session, info, picture, 1);
        EXPECT_EQ(info.lattice.nearest(session.cursor), glm::ivec3(4, 4, k));
        EXPECT_NEAR(session.cursor.z, info.lattice.position({4, 4, k}).z, 1e-10);
    }
    const PlanePicture last = axisPlane(session, info, {0, 1, 2}, session.cursor.z, {.channel = 0});
    stepAcross(session, info, last, 3);
    EXPECT_NEAR(session.cursor.z, info.bounds.hi.z, 1e-12) << "stays in the data";
}

TEST(UnevenPlanes, TitlesTellNeighbouringCellsApart) {
    const auto source = unevenLayers(AxisMap::Of::Cells);
    const volume::DatasetInfo& info = source->info();
    Session session = defaultSession(info, {});
    std::string before;
    for (int k = 0; k < info.lattice.size.z; ++k) {
        session.cursor = info.lattice.position({4, 4, k});
        const std::string place = axisPlane(session, info, {0, 1, 2}, session.cursor.z, {.channel = 0}).place;
        EXPECT_NE(place, before);
        const double told = std::stod(place.substr(place.find("= ") + 2)) / 1000; // mm
        EXPECT_NEAR(told, session.cursor.z, info.lattice.lengthsAt(session.cursor).z / 2) << place;
        before = place;
    }
}

TEST(UnevenPlanes, TiltedOnesHaveNoNumbersAcrossUnevenAxes) {
    const auto source = unevenLayers(AxisMap::Of::Cells);
    const volume::DatasetInfo& info = source->info();
    const Session session = defaultSession(info, {});
    const PlanePicture tilted = tiltedPlane(session, info, {1, 0, 1}, {.channel = 0});
    EXPECT_TRUE(tilted.right.blank) << "along x and z, both uneven";
    EXPECT_FALSE(tilted.up.blank) << "along y, which is even";
    EXPECT_EQ(tilted.place.find(" at "), std::string::npos) << tilted.place;
    EXPECT_EQ(unevenText(tilted), "x, z by cells");
    const PlanePicture facing = tiltedPlane(session, info, {0, 0, 1}, {.channel = 0});
    EXPECT_FALSE(facing.right.blank || facing.up.blank);
    const PlanePicture across = axisPlane(session, info, {0, 1, 2}, session.cursor.z, {.channel = 0});
    EXPECT_EQ(unevenText(across), "x by cells");
    const Table table = planesTable(*source, {tilted}, {0}, {});
    for (const TableColumn& column : table.columns) EXPECT_NE(column.name, "u");
    // The values belong to the positions beside them: of a field that is linear in space.
    const auto column = [&](const std::string& name) -> const TableColumn& {
        return *std::ranges::find(table.columns, name, &TableColumn::name);
    };
    const double perUnit = tilted.positions[0].unit.perUnit;
    ASSERT_GT(column("T").numbers.size(), 500u);
    for (std::size_t i = 0; i < column("T").numbers.size(); ++i) {
        const glm::dvec3 place =
            glm::dvec3(column("x").numbers[i], column("y").numbers[i], column("z").numbers[i]) / perUnit;
        const double value = column("T").numbers[i];
        if (std::isnan(value)) continue;
        // Within the value of one cell to each side: how a probe interpolates is not of this test.
        const glm::dvec3 cell = info.lattice.lengthsAt(place);
        EXPECT_NEAR(value, unevenLinear(place), 1e3 * cell.x + 500 * cell.y + 2e4 * cell.z);
    }
}

TEST(UnevenPlanes, ContourLinesLieWhereTheirValueIs) {
    for (const auto of : {AxisMap::Of::Cells, AxisMap::Of::Points}) {
        const auto source = unevenLayers(of);
        const volume::DatasetInfo& info = source->info();
        const Session session = defaultSession(info, {});
        const PlanePicture picture =
            axisPlane(session, info, {0, 2, 1}, session.cursor.y, {.channel = 0, .lines = {8, "", true}});
        const Contours contours = readContours(*source, contourQuery(picture), {});
        ASSERT_GE(contours.lines.size(), 3u);
        int points = 0;
        for (const volume::ContourLine& line : contours.lines)
            for (const glm::dvec2& point : line.points) {
                const glm::dvec3 place = picture.placeAt(point), cell = info.lattice.lengthsAt(place);
                EXPECT_NEAR(unevenLinear(place), line.level, 0.75 * (1e3 * cell.x + 2e4 * cell.z));
                ++points;
            }
        EXPECT_GT(points, 100);
    }
}

TEST(UnevenPlanes, PagesSayThatTheyAreNotToScale) {
    const auto source = unevenLayers(AxisMap::Of::Cells);
    const volume::DatasetInfo& info = source->info();
    const Session session = defaultSession(info, {});
    const PlanePicture across = axisPlane(session, info, {0, 2, 1}, session.cursor.y, {.channel = 0});
    PageForm form;
    const std::string page = svgOf(planesPage(*source, {across}, 1, form, {}));
    EXPECT_NE(page.find("x, z by cells"), std::string::npos);
    const Plot even{};
    EXPECT_TRUE(even.x.scale.isEven());
}

TEST(UnevenProfiles, AreStraightInSpaceAndReachThinCells) {
    const auto source = unevenLayers(AxisMap::Of::Cells);
    const volume::DatasetInfo& info = source->info();
    const glm::dvec3 from(1.2e-3, 7e-4, info.bounds.lo.z), to(2.4e-3, 1.5e-3, info.bounds.hi.z);
    const Profile profile = readProfile(*source, {.channels = {0}, .corners = {from, to}, .samples = 100});
    ASSERT_EQ(profile.positions.size(), 100u);
    EXPECT_LT(glm::distance(profile.positions.front(), from), 1e-12);
    EXPECT_LT(glm::distance(profile.positions.back(), to), 1e-12);
    const glm::dvec3 way = glm::normalize(to - from);
    std::vector<int> met(std::size_t(info.lattice.size.z), 0);
    for (std::size_t i = 0; i < profile.positions.size(); ++i) {
        const glm::dvec3 away = profile.positions[i] - from;
        EXPECT_NEAR(glm::length(away), profile.distance[i], 1e-12);
        EXPECT_LT(glm::length(away - way * glm::dot(away, way)), 1e-12);
        EXPECT_GE(profile.distance[i], profile.distance[i > 0 ? i - 1 : 0]);
        ++met[std::size_t(info.lattice.nearest(profile.positions[i]).z)];
    }
    for (const int count : met) EXPECT_GE(count, 1) << "every cell has a place, the membrane too";
}

TEST(UnevenScaleBar, IsOnlyAlongEvenAxes) {
    const volume::DatasetInfo info = unevenLayers(AxisMap::Of::Cells)->info();
    const vis::WorldFrame world = vis::worldFrame(info, glm::dvec3(1));
    vis::Camera camera;
    camera.projection = vis::Projection::Orthographic;
    camera.orientation = vis::standardOrientation(vis::StandardView::Front); // x to the right, which is uneven
    EXPECT_EQ(scaleBar(camera, world, glm::dvec3(1), "m", 600, 150).pixels, 0);
    camera.orientation = vis::standardOrientation(vis::StandardView::Left); // z to the right
    EXPECT_EQ(scaleBar(camera, world, glm::dvec3(1), "m", 600, 150).pixels, 0);
    vis::Camera turned = camera;
    turned.orientation = glm::angleAxis(glm::radians(90.0f), glm::vec3(0, 0, 1)); // y to the right, which is even
    const ScaleBar bar = scaleBar(turned, world, glm::dvec3(1), "m", 600, 150);
    EXPECT_GT(bar.pixels, 50);
    EXPECT_NE(bar.text.find(" along y"), std::string::npos) << "not along the others: " << bar.text;
}

TEST(UnevenBadge, SaysWhichAxesAreDrawnByCells) {
    const volume::AxisMaps axes = layeredLattice(AxisMap::Of::Cells).axes;
    EXPECT_EQ(stretchText(glm::dvec3(1)), "");
    EXPECT_EQ(stretchText({1, 5, 2}), "stretch 1 : 5 : 2");
    EXPECT_EQ(stretchText({1, 5, 2}, axes), "stretch 1 : 5 : 2, x, z by cells");
    EXPECT_EQ(stretchText(glm::dvec3(1), axes), "x, z by cells");
}

} // namespace
} // namespace tessera::app
