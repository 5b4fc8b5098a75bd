#include "vis/demand/covered_pixels.h"

#include "vis/demand/picture_bounds.h"

#include <algorithm>
#include <cstdint>

namespace tessera::vis {

namespace {

constexpr int kGroup = 8;       ///< blocks along an edge of a group
constexpr double kMargin = 1.5; ///< pixels

} // namespace

std::vector<OccupiedBox> occupiedBoxes(const BlockDistances& distances, const BlockRanges& blocks,
                                       const volume::BrickGrid& grid, const WorldFrame& frame) {
    const glm::ivec3 count = distances.count, groups = (count + kGroup - 1) / kGroup;
    std::vector<std::uint8_t> occupied(std::size_t(groups.x) * std::size_t(groups.y) * std::size_t(groups.z));
    std::size_t at = 0;
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x)
                if (distances.distance[at++] == 0)
                    occupied[(std::size_t(z / kGroup) * std::size_t(groups.y) + std::size_t(y / kGroup)) *
                                 std::size_t(groups.x) +
                             std::size_t(x / kGroup)] = 1;
    const double edge = double(1 << blocks.level) * blocks.edge, phase = grid.levelPhase(blocks.level);
    const auto world = [&](glm::ivec3 group) { // the lower corner
        const glm::dvec3 cells = glm::dvec3(group * kGroup) * edge + phase;
        return frame.sheetToWorld(grid.lattice.sheetOfCells(cells));
    };
    std::vector<OccupiedBox> boxes;
    at = 0;
    for (int z = 0; z < groups.z; ++z)
        for (int y = 0; y < groups.y; ++y)
            for (int x = 0; x < groups.x; ++x) {
                if (occupied[at++] == 0) continue;
                const glm::ivec3 group(x, y, z);
                const glm::dvec3 a = world(group), b = world(group + 1);
                OccupiedBox box{glm::min(a, b), glm::max(a, b)};
                for (int axis = 0; axis < 3; ++axis) {
                    const bool flipped = a[axis] > b[axis];
                    const bool first = group[axis] == 0, last = group[axis] == groups[axis] - 1;
                    if (flipped ? last : first) box.lo[axis] = -frame.halfSize[axis];
                    if (flipped ? first : last) box.hi[axis] = frame.halfSize[axis];
                }
                boxes.push_back(box);
            }
    return boxes;
}

std::vector<Tile> coveredPixels(const Camera& camera, std::span<const OccupiedBox> boxes, glm::ivec2 size) {
    const PictureProjection projection(camera, size);
    const glm::ivec2 cells = (size + kCoverCell - 1) / kCoverCell;
    std::vector<std::uint8_t> covered(std::size_t(cells.x) * std::size_t(cells.y));
    for (const OccupiedBox& box : boxes) {
        const glm::dvec3 half = (box.hi - box.lo) * 0.5;
        const auto found =
            projection.bounds((box.lo + box.hi) * 0.5, glm::dmat3(half.x, 0, 0, 0, half.y, 0, 0, 0, half.z));
        if (!found) return {{{0, 0}, size}};
        const glm::dvec2 top(size); // nothing is drawn beyond it
        const glm::ivec2 begin(glm::floor(glm::clamp(found->lo - kMargin, glm::dvec2(0), top) / double(kCoverCell)));
        const glm::ivec2 end = glm::min(
            glm::ivec2(glm::ceil(glm::clamp(found->hi + kMargin, glm::dvec2(0), top) / double(kCoverCell))), cells);
        for (int y = begin.y; y < end.y; ++y)
            for (int x = begin.x; x < end.x; ++x) covered[std::size_t(y) * std::size_t(cells.x) + std::size_t(x)] = 1;
    }
    // Runs of cells per row; a run that equals the one below extends that rectangle.
    std::vector<Tile> tiles;
    for (int y = 0; y < cells.y; ++y)
        for (int x = 0; x < cells.x; ++x) {
            const auto on = [&](int i) { return covered[std::size_t(y) * std::size_t(cells.x) + std::size_t(i)] != 0; };
            if (!on(x)) continue;
            const int from = x;
            while (x < cells.x && on(x)) ++x;
            const Tile run{glm::ivec2(from, y) * kCoverCell, glm::min(glm::ivec2(x, y + 1) * kCoverCell, size)};
            const auto below = std::find_if(tiles.begin(), tiles.end(), [&](const Tile& tile) {
                return tile.begin.x == run.begin.x && tile.end.x == run.end.x && tile.end.y == run.begin.y;
            });
            if (below != tiles.end())
                below->end.y = run.end.y;
            else
                tiles.push_back(run);
        }
    return tiles;
}

} // namespace tessera::vis
