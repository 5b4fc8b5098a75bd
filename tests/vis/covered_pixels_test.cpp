#include "vis/demand/covered_pixels.h"

#include "vis/optics/ray_setup.h"

#include <gtest/gtest.h>
#include <random>

namespace tessera {
namespace {

using vis::OccupiedBox;
using vis::Tile;

bool holds(const std::vector<Tile>& tiles, glm::ivec2 pixel) {
    int found = 0;
    for (const Tile& tile : tiles)
        found += glm::all(glm::lessThanEqual(tile.begin, pixel)) && glm::all(glm::lessThan(pixel, tile.end)) ? 1 : 0;
    EXPECT_LE(found, 1) << "tiles overlap at " << pixel.x << ", " << pixel.y;
    return found > 0;
}

bool meets(const vis::Ray& ray, const OccupiedBox& box, bool perspective) {
    vis::Ray moved = ray;
    moved.origin -= 0.5 * (box.lo + box.hi);
    return vis::clipToBox(moved, 0.5 * (box.hi - box.lo), perspective).has_value();
}

// Every ray that meets a box is drawn, wherever in its pixel it starts, and not much else.
TEST(CoveredPixels, HoldEveryRayThatMeetsABox) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    const glm::ivec2 size(150, 117);
    for (int round = 0; round < 40; ++round) {
        vis::Camera camera;
        const bool perspective = round % 2 == 0;
        camera.projection = perspective ? vis::Projection::Perspective : vis::Projection::Orthographic;
        camera.distance = float(1.6 + 0.8 * unit(random));
        vis::orbit(camera, {0, 0}, {float(unit(random)), float(unit(random))});
        std::vector<OccupiedBox> boxes;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 at(0.4 * unit(random), 0.4 * unit(random), 0.4 * unit(random));
            boxes.push_back({at - 0.04, at + 0.04});
        }
        const std::vector<Tile> tiles = vis::coveredPixels(camera, boxes, size);
        int drawn = 0;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const bool held = holds(tiles, {x, y});
                drawn += held;
                if (held) continue;
                const glm::dvec2 pixel = glm::dvec2(x, y) + 0.5 + 0.5 * glm::dvec2(unit(random), unit(random));
                const vis::Ray ray =
                    vis::cameraRay(camera, double(size.x) / size.y, pixel / glm::dvec2(size) * 2.0 - 1.0);
                for (const OccupiedBox& box : boxes) ASSERT_FALSE(meets(ray, box, perspective)) << x << ", " << y;
            }
        EXPECT_LT(drawn, size.x * size.y * 3 / 4) << round;
    }
    EXPECT_TRUE(vis::coveredPixels({}, {}, size).empty());
}

// Each occupied block lies in a box, whichever way an axis runs; at the border the box reaches the faces of the data's.
TEST(CoveredPixels, BoxesHoldTheOccupiedBlocks) {
    volume::BrickGrid grid;
    grid.lattice.size = {70, 40, 90};
    grid.lattice.origin = {0, 39, 0};
    grid.lattice.spacing = {1, -1, 1};
    const vis::WorldFrame frame = vis::worldFrame({glm::dvec3(0), glm::dvec3(69, 39, 89)}, glm::dvec3(1));
    vis::BlockRanges blocks;
    blocks.count = {18, 10, 23};
    vis::BlockDistances distances;
    distances.count = blocks.count;
    distances.distance.assign(18 * 10 * 23, 3);
    for (const glm::ivec3 block : {glm::ivec3(0, 0, 0), glm::ivec3(10, 5, 14), glm::ivec3(17, 9, 22)})
        distances.distance[std::size_t((block.z * 10 + block.y) * 18 + block.x)] = 0;
    const std::vector<OccupiedBox> boxes = vis::occupiedBoxes(distances, blocks, grid, frame);
    ASSERT_EQ(boxes.size(), 3u);
    const auto inside = [&](glm::dvec3 cells) {
        const glm::dvec3 world = frame.toWorld(grid.lattice.origin + cells * grid.lattice.spacing);
        return std::any_of(boxes.begin(), boxes.end(), [&](const OccupiedBox& box) {
            return glm::all(glm::lessThanEqual(box.lo, world + 1e-9)) &&
                   glm::all(glm::lessThanEqual(world - 1e-9, box.hi));
        });
    };
    EXPECT_TRUE(inside({0, 0, 0}));
    EXPECT_TRUE(inside({40.5, 20.5, 56.5}));
    EXPECT_TRUE(inside({43.5, 23.5, 59.5}));
    EXPECT_TRUE(inside({69, 39, 89}));
    EXPECT_FALSE(inside({35, 5, 5}));
    EXPECT_FALSE(inside({69, 2, 89}));
}

} // namespace
} // namespace tessera
