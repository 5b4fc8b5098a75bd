#include "vis/demand/hidden_bricks.h"

#include "vis/demand/picture_bounds.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tessera::vis {

namespace {

constexpr double kReadBeyond = 3; ///< in cells: how far reconstruction and gradient read from a sample position
constexpr int kSplits = 2;        ///< number of octree subdivisions of a box, for a closer depth test
constexpr int kFewTiles = 4;

/// Depth tests of world-space boxes against the termination depths of a picture.
class RayEnds {
public:
    explicit RayEnds(const TerminationMap& termination)
        : termination_(termination), projection_(termination.camera, termination.size),
          toClip_(projectionMatrix(termination.camera, double(termination.size.x) / termination.size.y) *
                  viewMatrix(termination.camera)),
          perspective_(termination.camera.projection == Projection::Perspective) {
        const Ray middle = cameraRay(termination.camera, double(termination.size.x) / termination.size.y, {0, 0});
        eye_ = middle.origin;
        forward_ = middle.direction;
    }

    /// Whether a box lies inside the picture and is occluded.
    bool hide(glm::dvec3 lo, glm::dvec3 hi) const {
        if (seenInTheMiddle(lo, hi)) return false;
        const std::optional<Tiles> tiles = tilesOf(lo, hi);
        return tiles && !tiles->empty() && behind(lo, hi, kSplits);
    }

private:
    struct Tiles {
        glm::ivec2 begin, end;
        bool empty() const { return begin.x >= end.x || begin.y >= end.y; }
        int count() const { return (end.x - begin.x) * (end.y - begin.y); }
    };
    /// The tiles that a box covers; nullopt if it extends behind the eye.
    std::optional<Tiles> tilesOf(glm::dvec3 lo, glm::dvec3 hi) const {
        const glm::dvec3 half = 0.5 * (hi - lo);
        const std::optional<PictureBounds> bounds =
            projection_.bounds(0.5 * (lo + hi), glm::dmat3(half.x, 0, 0, 0, half.y, 0, 0, 0, half.z));
        if (!bounds) return std::nullopt;
        // Rays pass through pixel centres: include adjacent tiles.
        const glm::dvec2 top(termination_.tiles());
        return Tiles{glm::clamp(glm::floor((bounds->lo - 1.0) / double(kTerminationTile)), glm::dvec2(0), top),
                     glm::clamp(glm::ceil((bounds->hi + 1.0) / double(kTerminationTile)), glm::dvec2(0), top)};
    }
    float farthest(int x, int y) const { return termination_.farthest[std::size_t(y * termination_.tiles().x + x)]; }
    /// Quick test: most visible boxes are visible at their centre.
    bool seenInTheMiddle(glm::dvec3 lo, glm::dvec3 hi) const {
        const glm::dvec4 clip = toClip_ * glm::dvec4(0.5 * (lo + hi), 1);
        if (!(clip.w > 0)) return false;
        const glm::dvec2 pixel = (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(termination_.size);
        if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < termination_.size.x && pixel.y < termination_.size.y))
            return false;
        return double(farthest(int(pixel.x) / kTerminationTile, int(pixel.y) / kTerminationTile)) >= nearest(lo, hi);
    }
    double nearest(glm::dvec3 lo, glm::dvec3 hi) const {
        if (perspective_) return glm::length(glm::clamp(eye_, lo, hi) - eye_);
        const glm::dvec3 half = 0.5 * (hi - lo);
        return glm::dot(forward_, 0.5 * (lo + hi) - eye_) - glm::dot(glm::abs(forward_), half);
    }
    /// Parts of a box outside the picture are not visible.
    bool behind(glm::dvec3 lo, glm::dvec3 hi, int splits) const {
        const std::optional<Tiles> tiles = tilesOf(lo, hi);
        if (!tiles) return false;
        if (tiles->empty()) return true;
        const double distance = nearest(lo, hi);
        bool all = true;
        for (int y = tiles->begin.y; y < tiles->end.y && all; ++y)
            for (int x = tiles->begin.x; x < tiles->end.x && all; ++x) all = double(farthest(x, y)) < distance;
        if (all || splits == 0 || tiles->count() <= kFewTiles) return all;
        const glm::dvec3 half = 0.5 * (hi - lo);
        for (int part = 0; part < 8; ++part) {
            const glm::dvec3 from = lo + half * glm::dvec3(part & 1, part >> 1 & 1, part >> 2);
            if (!behind(from, from + half, splits - 1)) return false;
        }
        return true;
    }

    const TerminationMap& termination_;
    PictureProjection projection_;
    glm::dmat4 toClip_;
    bool perspective_;
    glm::dvec3 eye_{0}, forward_{0, 0, -1};
};

} // namespace

std::vector<std::uint8_t> hiddenBricks(const TerminationMap& termination, const volume::BrickGrid& grid) {
    const RayEnds ends(termination);
    const glm::ivec3 count = grid.count();
    const WorldFrame& frame = termination.frame;
    const volume::Lattice& lattice = grid.lattice;
    const auto world = [&](glm::dvec3 cell) { return frame.sheetToWorld(lattice.sheetOfCells(cell)); };
    const glm::dvec3 room = kReadBeyond * glm::abs(lattice.spacing * frame.scale);
    std::vector<std::uint8_t> hidden(std::size_t(count.x) * std::size_t(count.y) * std::size_t(count.z));
    parallelFor(std::size_t(count.y) * std::size_t(count.z), [&](std::size_t row) {
        for (int x = 0; x < count.x; ++x) {
            const glm::ivec3 brick(x, int(row % std::size_t(count.y)), int(row / std::size_t(count.y)));
            const glm::dvec3 a = world(glm::dvec3(brick * grid.brickSize)),
                             b = world(glm::dvec3((brick + 1) * grid.brickSize));
            // Nothing is sampled outside the box.
            const glm::dvec3 lo = glm::clamp(glm::min(a, b) - room, -frame.halfSize, frame.halfSize),
                             hi = glm::clamp(glm::max(a, b) + room, -frame.halfSize, frame.halfSize);
            hidden[row * std::size_t(count.x) + std::size_t(x)] = ends.hide(lo, hi);
        }
    });
    if (std::ranges::none_of(hidden, [](std::uint8_t each) { return each != 0; })) hidden.clear();
    return hidden;
}

void HiddenInView::learn(std::vector<std::uint8_t> found, bool sameScene) {
    if (!sameScene) revealed_.clear();
    revealed_.resize(std::max({revealed_.size(), bricks_.size(), found.size()}), 0);
    for (std::size_t i = 0; sameScene && i < bricks_.size(); ++i)
        if (bricks_[i] != 0 && (i >= found.size() || found[i] == 0)) revealed_[i] = 1;
    for (std::size_t i = 0; i < found.size(); ++i)
        if (revealed_[i] != 0) found[i] = 0;
    if (found == bricks_) return;
    bricks_ = std::move(found);
    ++revision_;
}

} // namespace tessera::vis
