#include "app/pane/plot.h"
#include "app/views/scatter/scatter_layout.h"
#include "app/views/shadow_cube/wall_projection.h"
#include "tests/app/beacon.h"
#include "tests/app/formula_view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

/// Where views show one bright place of the data: at the pixel that follows from the camera or the axes, and nowhere
/// else.
namespace tessera::app {
namespace {

using beacon::Area;

class Orientation : public FormulaView {
protected:
    Orientation() : FormulaView(false) {} // a scene fills the picture
    void show(const ViewState& view, const std::function<void(Session&)>& change = {}) {
        install(beacon::makeBeacon, view, [&](Session& session) {
            beacon::color(session);
            session.stretch = {1, 1, 1};
            session.time = 0;
            session.cursor = beacon::position(0);
            if (change) change(session);
        });
    }
};

/// Pixel of a place of the world by the camera's matrices, in a picture that it fills.
glm::dvec2 pixelOf(const vis::Camera& camera, glm::ivec2 size, glm::dvec3 world) {
    const glm::dvec4 clip =
        vis::projectionMatrix(camera, double(size.x) / size.y) * vis::viewMatrix(camera) * glm::dvec4(world, 1);
    return {(clip.x / clip.w + 1) / 2 * size.x, (1 - clip.y / clip.w) / 2 * size.y};
}

/// How many pixels the bright part reaches from its middle: somewhat more than a sample along each axis.
double reachOf(const vis::Camera& camera, glm::ivec2 size, const vis::WorldFrame& world, glm::dvec3 place) {
    double reach = 0;
    const glm::dvec2 middle = pixelOf(camera, size, world.toWorld(place));
    for (int axis = 0; axis < 3; ++axis)
        for (const double samples : {-1.7, 1.7}) {
            glm::dvec3 end = place;
            end[axis] += samples * beacon::kSpacing[axis];
            reach = std::max(reach, glm::distance(middle, pixelOf(camera, size, world.toWorld(end))));
        }
    return reach + 2;
}

TEST_F(Orientation, OfVolumesIsThatOfTheCamera) {
    VolumeView view;
    view.showBox = view.showAxes = view.showLegend = view.showCursor = view.showGizmo = view.showScaleBar =
        view.showLenses = false;
    show(view);
    constexpr glm::ivec2 kSize{240, 180};
    for (const vis::Projection projection : {vis::Projection::Perspective, vis::Projection::Orthographic})
        for (const glm::dvec3 stretch : {glm::dvec3(1), glm::dvec3(2, 0.7, 1.5)})
            for (int time = 0; time < 3; ++time) {
                SCOPED_TRACE(time);
                Session session = start;
                session.stretch = stretch;
                session.time = beacon::kTimes[time];
                session.camera.projection = projection;
                session.camera.target = {0.03f, -0.05f, 0.02f};
                const vis::WorldFrame world = vis::worldFrame(workbench.source()->info(), stretch);
                const glm::dvec3 place = beacon::position(time);
                const vis::Image image = picture(session, kSize);
                beacon::expectBrightAt(image, beacon::whole(image),
                                       {pixelOf(session.camera, kSize, world.toWorld(place))},
                                       reachOf(session.camera, kSize, world, place));
            }
}

/// Pixels that the bright part reaches from its middle in a slice.
double sliceReach(const Area& area, int right, int up) {
    return std::max(1.7 * (area.max.x - area.min.x) / (beacon::kSize[right] - 1),
                    1.7 * (area.max.y - area.min.y) / (beacon::kSize[up] - 1)) +
           2;
}

TEST_F(Orientation, OfSlicesIsThatOfTheirAxes) {
    show(SlicesView{});
    for (int time = 0; time < 3; ++time) {
        SCOPED_TRACE(time);
        Session session = start;
        session.time = beacon::kTimes[time];
        session.cursor = beacon::position(time);
        const vis::Image image = picture(session, {560, 520});
        const std::vector<Area> areas = beacon::mappedAreas(image);
        ASSERT_EQ(areas.size(), 3u);
        constexpr int kAxes[3][2] = {{0, 1}, {2, 1}, {0, 2}}; // to the right and up
        for (std::size_t i = 0; i < 3; ++i) {
            SCOPED_TRACE(i);
            const auto [right, up] = kAxes[i];
            // As wide and high as the data.
            const glm::dvec3 size = beacon::kSpacing * glm::dvec3(beacon::kSize - 1);
            EXPECT_NEAR(double(areas[i].max.x - areas[i].min.x) / (areas[i].max.y - areas[i].min.y),
                        size[right] / size[up], 0.04);
            beacon::expectBrightAt(image, areas[i], {areas[i].at(beacon::share(time, right), beacon::share(time, up))},
                                   sliceReach(areas[i], right, up));
        }
    }
}

TEST_F(Orientation, OfAMatrixOfSlicesIsWithTheLongerAxisLevel) {
    // Planes across an axis, of which one goes through the bright place of a time.
    struct Case {
        volume::SpaceAxis axis;
        int planes, bright, time, right, up;
    };
    for (const Case& each : {Case{volume::SpaceAxis::Z, 2, 0, 0, 1, 0}, Case{volume::SpaceAxis::Z, 3, 2, 2, 1, 0},
                             Case{volume::SpaceAxis::Y, 2, 1, 1, 0, 2}, Case{volume::SpaceAxis::X, 3, 2, 0, 1, 2}}) {
        SCOPED_TRACE(each.planes);
        SliceMatrixView view;
        view.channels = {"beacon"};
        view.axis = each.axis;
        view.planes = each.planes;
        show(view, [&](Session& session) { session.time = beacon::kTimes[each.time]; });
        const vis::Image image = picture(start, {640, 300});
        const std::vector<Area> areas = beacon::mappedAreas(image, 1);
        ASSERT_EQ(areas.size(), std::size_t(each.planes));
        for (int i = 0; i < each.planes; ++i) {
            const Area& area = areas[std::size_t(i)];
            std::vector<glm::dvec2> places;
            if (i == each.bright)
                places = {area.at(beacon::share(each.time, each.right), beacon::share(each.time, each.up))};
            beacon::expectBrightAt(image, area, places, sliceReach(area, each.right, each.up));
        }
    }
}

TEST_F(Orientation, OfTheWallsOfTheShadowCubeIsThatOfTheDataBeforeThem) {
    const Wall wall{"beacon", WallKind::Maximum};
    ShadowCubeView view;
    view.left = view.right = view.bottom = view.top = view.back = view.front = wall;
    view.showAxes = false; // the cube fills the picture
    show(view, [](Session& session) { session.layers.clear(); });
    constexpr glm::ivec2 kSize{300, 420}; // the legend has its place below the cube or above it
    const vis::WorldFrame world = vis::worldFrame(workbench.source()->info(), glm::dvec3(1));
    const glm::dvec3 half = world.halfSize + double(view.gap);
    int seen = 0;
    for (const int time : {0, 1}) {
        SCOPED_TRACE(time);
        Session session = start;
        session.time = beacon::kTimes[time];
        // The second looks from the other side of everything.
        if (time == 1)
            session.camera.orientation =
                glm::angleAxis(glm::radians(180.0f), glm::vec3(0, 1, 0)) * session.camera.orientation;
        const vis::Camera camera = cubeCamera(view, session.camera, half, double(kSize.x) / kSize.y);
        const glm::dvec3 eye(glm::inverse(vis::viewMatrix(camera)) * glm::dvec4(0, 0, 0, 1));
        std::vector<glm::dvec2> places;
        for (int axis = 0; axis < 3; ++axis)
            for (const int side : {-1, 1}) {
                if (side * eye[axis] > half[axis]) continue; // seen from outside
                glm::dvec3 place = world.toWorld(beacon::position(time));
                place[axis] = side * half[axis];
                places.push_back(pixelOf(camera, kSize, place));
                seen |= 1 << (2 * axis + (side > 0));
            }
        const vis::Image image = picture(session, kSize);
        beacon::expectBrightAt(image, {{0, 60}, {kSize.x, 340}}, places, 24);
    }
    EXPECT_EQ(seen, 63) << "all faces";
}

/// How much a pixel differs from another.
int difference(glm::ivec3 a, glm::ivec3 b) {
    const glm::ivec3 d = glm::abs(a - b);
    return std::max({d.r, d.g, d.b});
}

TEST_F(Orientation, OfScatterplotsHasLowValuesAtTheLowerLeft) {
    ScatterMatrixView view;
    view.channels = {"a", "b"};
    view.bins = 16;
    show(view);
    const vis::Image image = picture(start, {460, 400});
    const auto* cache = dynamic_cast<const ScatterLayoutCache*>(workbench.cache("pane"));
    ASSERT_NE(cache, nullptr);
    ASSERT_EQ(cache->layout.infos[0].name, "a");
    const PlotFrame cell = cache->layout.cell(0, 1); // a to the right, b up
    const Area area{{int(cell.min.x) + 2, int(cell.min.y) + 2}, {int(cell.max.x) - 2, int(cell.max.y) - 2}};
    const beacon::Pixels pixels{image};
    const auto at = [&](double a, double b) { // a fiftieth of room at either end
        return area.at((a - 2 + 0.16) / 8.32, (b - 1 + 0.4) / 20.8);
    };
    const glm::dvec2 clusters[] = {at(2, 1), at(10, 5), at(2, 21)};
    const glm::dvec2 empty = area.at(0.5, 0.9);
    const glm::ivec3 ground = pixels.at(int(empty.x), int(empty.y));
    double most[3] = {};
    const double bin = std::max(cell.width(), cell.height()) / 16.0;
    int stray = 0;
    for (int y = area.min.y; y < area.max.y; ++y)
        for (int x = area.min.x; x < area.max.x; ++x) {
            const int much = difference(pixels.at(x, y), ground);
            if (much < 12) continue;
            std::size_t own = 3;
            for (std::size_t i = 0; i < 3; ++i)
                if (glm::distance(clusters[i], glm::dvec2(x, y)) < 1.6 * bin) own = i;
            if (own == 3)
                ++stray;
            else
                most[own] = std::max(most[own], double(much));
        }
    EXPECT_EQ(stray, 0);
    EXPECT_GT(most[0], 40);
    EXPECT_GT(most[1], 40);
    EXPECT_GT(most[2], 12);
    EXPECT_GT(most[1], most[2] + 10) << "a third of the samples is denser than one";
}

TEST_F(Orientation, OfProfilesOverTimeIsTheLineToTheRightAndTimeUp) {
    for (const bool backwards : {false, true})
        for (int time = 0; time < 3; ++time) {
            SCOPED_TRACE(time);
            ProfileView view;
            view.channels = {"beacon"};
            view.over = ProfileOver::LineAndTime;
            glm::dvec3 from = beacon::position(time), to = from;
            from.x = beacon::kOrigin.x, to.x = beacon::kOrigin.x + beacon::kSpacing.x * (beacon::kSize.x - 1);
            if (backwards) std::swap(from, to);
            view.points = {from, to};
            show(view, [&](Session& session) {
                session.cursor = {0.0223, 0, 0.01};
                session.time = 2;
            });
            const vis::Image image = picture(start, {420, 300});
            const std::vector<Area> areas = beacon::mappedAreas(image);
            ASSERT_EQ(areas.size(), 1u);
            // A row reaches half way to the times before and after it.
            constexpr double kLow[] = {0, 0.125, 0.625}, kHigh[] = {0.125, 0.625, 1};
            const double along = beacon::share(time, 0);
            const Area& area = areas[0];
            const glm::dvec2 place = area.at(backwards ? 1 - along : along, (kLow[time] + kHigh[time]) / 2);
            const double half = (kHigh[time] - kLow[time]) / 2 * (area.max.y - area.min.y);
            beacon::expectBrightAt(image, area, {place}, std::hypot(half, 0.15 * (area.max.x - area.min.x)) + 3);
        }
}

TEST_F(Orientation, OfHistogramsIsBarsThatStandOnTheirValues) {
    HistogramView view;
    view.channel = "a";
    view.bins = 20;
    // The bar of the values between two, in the colour of the brush, without the brush's one pixel wide edges.
    const auto barOf = [&](double lo, double hi) {
        show(view, [&](Session& session) {
            session.selection.brushes = {vis::rangeBrush({{.channel = "a", .lo = lo, .hi = hi}})};
            session.selection.brushes[0].color = {1, 0, 1};
            session.cursor = {0.0265, 0, 0.01};
        });
        const vis::Image image = picture(start, {400, 300});
        const beacon::Pixels pixels{image};
        Area area{image.size, {0, 0}};
        for (int y = 0; y + 2 < image.size.y; ++y)
            for (int x = 2; x + 2 < image.size.x; ++x) {
                bool bar = true; // and no letter of the names
                for (int near = 0; near < 15; ++near) bar = bar && pixels.bright(x - 2 + near % 5, y + near / 5);
                if (!bar) continue;
                area.min = glm::min(area.min, glm::ivec2(x - 2, y));
                area.max = glm::max(area.max, glm::ivec2(x + 3, y + 3));
            }
        return area;
    };
    const Area low = barOf(1, 3), high = barOf(9, 11);
    const double width = low.max.x - low.min.x;
    ASSERT_GT(width, 8);
    EXPECT_NEAR(high.max.x - high.min.x, width, 2);
    EXPECT_NEAR(high.max.x - low.min.x, 20 * width, 25) << "the first and the last of twenty";
    EXPECT_NEAR(low.max.y, high.max.y, 1) << "on one line";
    // Seven and four of eleven planes of samples.
    EXPECT_NEAR(double(low.max.y - low.min.y) / (high.max.y - high.min.y), 7.0 / 4, 0.06);
    EXPECT_GT(low.max.y - low.min.y, 150);
}

} // namespace
} // namespace tessera::app
