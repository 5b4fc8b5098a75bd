#pragma once

#include "volume/base/cpu.h"
#include "volume/base/describe.h"
#include "volume/base/pieces.h"
#include "volume/bricks/brick_grid.h"
#include "volume/bricks/brick_stats.h"
#include "volume/field/dataset.h"
#include "volume/field/field.h"

#include <functional>
#include <glm/vec3.hpp>
#include <vector>

/// Importance of bricks and their change over time: they decide which bricks are loaded first, at which level, and
/// whether they must be read again. (Röber 2002, sections 4.2.2 and 4.2.3.)
namespace tessera::volume {

struct ImportanceOptions {
    double borderWeight = 2;
    double neighbours = 0.25;

    bool operator==(const ImportanceOptions&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.borderWeight,
              FieldInfo{.key = "borderWeight",
                        .doc = "Weight of the samples at the faces of a brick; those inside have weight 1",
                        .range = Range{1, 16}});
        visit(
            self.neighbours,
            FieldInfo{
                .key = "neighbours",
                .doc = "Share of the difference to its most important neighbour that is added to a brick's importance",
                .range = Range{0, 1}});
    }
};

/// Importance of every brick, x fastest, of the samples smoothed by a Gaussian (binomial, of one sample) and read at
/// every second one of each sublattice. With g the value as part of `range`, held within 0..1, and 256 tones:
///
///     importance = cube root of mean(g) * 4 variance(g) * entropy(g) / its largest possible
///     detail     = RMS of what the mean of two neighbours, along each axis, leaves of a sample
///
/// The cube root keeps the order and spreads the product over 0..1. Labels are neither smoothed nor ordered: of
/// `categorical` both are the entropy alone. Absent samples and floats that are not finite take no part; a brick
/// without samples, or of one value among such, has 0. A range of nothing: that of the samples. The result does not
/// depend on `cpu`.
std::vector<BrickImportance> importanceOfBricks(const BrickGrid& grid, const Field& field, Range range,
                                                bool categorical, const ImportanceOptions& options = {},
                                                Cpu cpu = bestCpu());

/// The same for a frame that is read in slices, `layers` layers of bricks at a time plus a few slices around them.
/// `read(first, count, part)` replaces `part` by slices.
std::vector<BrickImportance> importanceOfBricks(const BrickGrid& grid,
                                                const std::function<void(int first, int count, Field& part)>& read,
                                                int layers, Range range, bool categorical,
                                                const ImportanceOptions& options = {},
                                                const Pieces& pieces = piecesHere);

/// Largest and RMS difference between two frames within a brick, of the decoded values. Both frames have the lattice of
/// the grid and the same type; scale and offset may differ.
BrickChange changeOfBrick(const BrickGrid& grid, glm::ivec3 brick, const Field& before, const Field& after);

} // namespace tessera::volume
