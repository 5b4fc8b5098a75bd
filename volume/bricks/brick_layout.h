#pragma once

#include "volume/base/describe.h"
#include "volume/bricks/brick_source.h"

#include <span>
#include <string_view>
#include <vector>

/// Merging of bricks by importance: which bricks are omitted, and which neighbours form a larger brick. One layout
/// serves all parameters and times. (Röber 2002, section 4.2.2.)
namespace tessera::volume {

/// Shape of merged bricks, and the algorithm that finds them.
enum class MergeShape : std::uint8_t {
    Uniform, ///< cubes of 1, 2, 4, ... bricks a side: along x, y and z, or not at all
    Mixed,   ///< boxes: along x as far as it goes, then whole rows along y, then whole slices along z
    Best     ///< boxes: the fewest of sweeps in every order of the axes and of always joining the most alike
};
inline constexpr std::string_view kMergeShapeNames[] = {"uniform", "mixed", "best"};

struct MergeOptions {
    double discardBelow = 0; ///< importance, 0..1
    double alike = 0.1;      ///< most by which the importance of merged bricks differs
    int mostBricks = 4;      ///< along an axis
    MergeShape shape = MergeShape::Best;

    bool operator==(const MergeOptions&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.discardBelow, FieldInfo{.key = "discardBelow",
                                           .doc = "Omit bricks less important than this; 0 = none",
                                           .unit = "importance",
                                           .range = Range{0, 1}});
        visit(self.alike, FieldInfo{.key = "alike",
                                    .doc = "Largest difference in importance between bricks that are merged",
                                    .unit = "importance",
                                    .range = Range{0, 1}});
        visit(self.mostBricks, FieldInfo{.key = "mostBricks",
                                         .doc = "Edge of the largest merged brick",
                                         .unit = "bricks",
                                         .range = Range{1, 64}});
        visit(self.shape, FieldInfo{.key = "shape",
                                    .doc = "Shape of merged bricks: cubes (uniform), boxes grown along x, then y, then "
                                           "z (mixed), boxes grown in any direction (best)",
                                    .names = kMergeShapeNames});
    }
};

/// A box of bricks [begin, end) of the grid.
struct MergedBrick {
    glm::ivec3 begin{0}, end{0};
    float importance = 0; ///< the largest of its bricks
    bool operator==(const MergedBrick&) const = default;
};

/// Boxes that cover each brick that is not discarded exactly once, and no other; ordered by their first brick, x
/// fastest. `importance`: one value per brick of a grid of `count` bricks, x fastest.
std::vector<MergedBrick> mergeBricks(glm::ivec3 count, std::span<const float> importance, const MergeOptions& options);

/// For every brick the larger of importance and detail, maximised over all stored components and times; 1 where
/// unknown.
std::vector<float> mostImportant(const BrickSource& source);

} // namespace tessera::volume
