#include "vis/demand/hidden_bricks.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

namespace tessera {
namespace {

using vis::Camera;
using vis::HiddenInView;
using vis::kTerminationTile;
using vis::TerminationMap;

volume::BrickGrid gridOfHidden(volume::LatticeKind kind) {
    volume::BrickGrid grid;
    grid.lattice.size = {61, 47, 75};
    if (kind == volume::LatticeKind::BCC) grid.lattice = volume::bccFor(grid.lattice);
    grid.brickSize = 8;
    grid.levels = 3;
    return grid;
}

TerminationMap reachOf(const Camera& camera, glm::ivec2 size, float end) {
    TerminationMap map;
    map.camera = camera;
    map.frame = vis::worldFrame({glm::dvec3(0), glm::dvec3(60, 46, 74)}, glm::dvec3(1));
    map.size = size;
    map.farthest.assign(std::size_t(map.tiles().x) * std::size_t(map.tiles().y), end);
    return map;
}

// No place of a hidden brick lies before the end of any ray that passes it, however rays end and from wherever one
// looks; and with rays that end early something is hidden.
TEST(HiddenBricks, LieBehindTheEndsOfAllRays) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    int hiddenBricksFound = 0;
    for (int round = 0; round < 60; ++round) {
        const volume::BrickGrid grid =
            gridOfHidden(round % 2 == 0 ? volume::LatticeKind::CC : volume::LatticeKind::BCC);
        Camera camera;
        camera.projection = round % 4 < 2 ? vis::Projection::Perspective : vis::Projection::Orthographic;
        camera.distance = float(0.4 + 1.6 * unit(random));
        vis::orbit(camera, {0, 0}, {float(2 * unit(random)), float(unit(random))});
        const glm::ivec2 size(90, 70);
        TerminationMap map = reachOf(camera, size, 0);
        const double from = camera.distance - 0.5 + 0.4 * unit(random);
        for (float& end : map.farthest) end = unit(random) < 0.05 ? 1e6f : float(from + 0.3 * unit(random));
        const std::vector<std::uint8_t> hidden = hiddenBricks(map, grid);
        ASSERT_FALSE(hidden.empty());
        const glm::ivec3 count = grid.count();
        for (int n = 0; n < 4000; ++n) {
            const glm::dvec2 place(unit(random) * size.x, unit(random) * size.y);
            const vis::Ray ray = vis::cameraRay(camera, double(size.x) / size.y, place / glm::dvec2(size) * 2.0 - 1.0);
            const glm::ivec2 tile = glm::ivec2(place) / kTerminationTile;
            const double end = double(map.farthest[std::size_t(tile.y * map.tiles().x + tile.x)]);
            // Before its end: no hidden brick.
            const double t = std::min(end, 4.0) * unit(random);
            const glm::dvec3 at = ray.origin + t * ray.direction;
            if (glm::any(glm::greaterThan(glm::abs(at), map.frame.halfSize))) continue;
            const glm::dvec3 cell = grid.lattice.toCells(map.frame.toPhysical(at));
            const glm::ivec3 brick(glm::floor(cell / double(grid.brickSize)));
            if (glm::any(glm::lessThan(brick, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(brick, count)))
                continue;
            EXPECT_EQ(hidden[std::size_t((brick.z * count.y + brick.y) * count.x + brick.x)], 0);
        }
        for (const std::uint8_t each : hidden) hiddenBricksFound += each;
    }
    EXPECT_GT(hiddenBricksFound, 1000);
}

// A wall across the view hides what is a little farther away, in tiles of any brick size; rays without end hide
// nothing.
TEST(HiddenBricks, AWallHidesWhatIsFarther) {
    for (const vis::Projection projection : {vis::Projection::Perspective, vis::Projection::Orthographic}) {
        const volume::BrickGrid grid = gridOfHidden(volume::LatticeKind::CC);
        Camera camera;
        camera.projection = projection;
        camera.orientation = {1, 0, 0, 0}; // against z
        camera.distance = 3;
        EXPECT_TRUE(hiddenBricks(reachOf(camera, {64, 64}, 1e6f), grid).empty());
        const vis::Ray middle = vis::cameraRay(camera, 1, {0, 0});
        // The wall: the middle of the box.
        const double end = glm::dot(-middle.origin, middle.direction);
        const std::vector<std::uint8_t> hidden = hiddenBricks(reachOf(camera, {64, 64}, float(end)), grid);
        const glm::ivec3 count = grid.count();
        for (int z = 0; z < count.z; ++z) {
            // Bricks reach 3 cells towards the viewer, at z = 74; the wall is flat in parallel projection.
            const bool behind = (z + 1) * 8 + 3 < 37, before = (z + 1) * 8 > 38;
            const std::uint8_t is = hidden[std::size_t((z * count.y + count.y / 2) * count.x + count.x / 2)];
            if (behind || before) {
                EXPECT_EQ(is, behind ? 1 : 0) << z;
            }
        }
        // Rays that end at the eye hide all there is in the picture, and nothing beside it.
        camera.distance = 0.8f;
        camera.fieldOfView = 20;
        TerminationMap near = reachOf(camera, {64, 64}, 0);
        const std::vector<std::uint8_t> all = hiddenBricks(near, grid);
        EXPECT_EQ(all[std::size_t((count.z / 2 * count.y + count.y / 2) * count.x + count.x / 2)], 1);
        EXPECT_EQ(all[std::size_t((count.z / 2 * count.y) * count.x)], 0);
    }
}

/// Depth at which a ray enters the box of half edges `half` around the origin; 0 if it passes by.
double entryOf(const vis::Ray& ray, glm::dvec3 half) {
    const glm::dvec3 a = (-half - ray.origin) / ray.direction, b = (half - ray.origin) / ray.direction;
    const glm::dvec3 in = glm::min(a, b), out = glm::max(a, b);
    const double enter = std::max({in.x, in.y, in.z}), leave = std::min({out.x, out.y, out.z});
    return enter < leave ? enter : 0;
}

// A wall just before slanted faces hides whole bricks, although their nearest corners are closer than its far parts:
// parts of a brick are tried one by one. So does a wall before bricks that extend beyond the picture.
TEST(HiddenBricks, ASlantedWallHidesWhatIsJustBehindIt) {
    volume::BrickGrid grid;
    grid.lattice.size = {64, 64, 64};
    grid.brickSize = 32;
    for (const auto& [distance, apart] : {std::pair{2.5f, 0.35}, {1.6f, 0.3}}) {
        Camera camera;
        camera.projection = vis::Projection::Orthographic;
        camera.distance = distance;
        const glm::ivec2 size(160, 160);
        TerminationMap map = reachOf(camera, size, 0);
        map.frame = vis::worldFrame({glm::dvec3(0), glm::dvec3(63)}, glm::dvec3(1));
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const vis::Ray ray = vis::cameraRay(camera, 1, (glm::dvec2(x, y) + 0.5) / glm::dvec2(size) * 2.0 - 1.0);
                float& end = map.farthest[std::size_t(y / kTerminationTile * map.tiles().x + x / kTerminationTile)];
                end = std::max(end, float(entryOf(ray, map.frame.halfSize) - apart));
            }
        EXPECT_EQ(hiddenBricks(map, grid), std::vector<std::uint8_t>(8, 1)) << distance;
    }
}

// One picture after the other: hidden bricks come and go with scenes; in one scene what was seen after all stays seen.
TEST(HiddenBricks, StaySeenInOneScene) {
    HiddenInView view;
    view.learn({1, 1, 0, 0}, false);
    EXPECT_EQ(view.bricks(), (std::vector<std::uint8_t>{1, 1, 0, 0}));
    const std::uint64_t before = view.revision();
    view.learn({1, 1, 0, 0}, true);
    EXPECT_EQ(view.revision(), before);
    view.learn({1, 0, 1, 0}, true);
    EXPECT_EQ(view.bricks(), (std::vector<std::uint8_t>{1, 0, 1, 0}));
    EXPECT_NE(view.revision(), before);
    view.learn({1, 1, 1, 0}, true);
    EXPECT_EQ(view.bricks(), (std::vector<std::uint8_t>{1, 0, 1, 0})) << "not back";
    view.learn({}, true);
    EXPECT_TRUE(view.bricks().empty());
    view.learn({1, 1, 1, 1}, true);
    EXPECT_EQ(view.bricks(), (std::vector<std::uint8_t>{0, 0, 0, 1}));
    view.learn({1, 1, 1, 1}, false);
    EXPECT_EQ(view.bricks(), (std::vector<std::uint8_t>{1, 1, 1, 1})) << "another scene";
}

} // namespace
} // namespace tessera
