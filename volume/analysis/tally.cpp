#include "volume/analysis/tally.h"

#include "volume/base/parallel.h"
#include "volume/bricks/cell_lengths.h"
#include "volume/bricks/sample_position.h"

#include <array>
#include <atomic>
#include <limits>
#include <mutex>

namespace tessera::volume {

namespace {

using Tallies = std::map<std::uint64_t, Tally>;

/// Lengths of cells along each axis, of each sublattice.
using TallyLengths = std::array<std::array<std::vector<double>, 3>, 2>;

Tallies tallyBrick(const BrickSource& source, const TallyQuery& query, const TallyLengths& lengths, int sublattices,
                   glm::ivec3 index) {
    const BrickGrid& grid = source.grid();
    std::vector<BrickSamples> columns;
    for (const int channel : query.channels) columns.push_back(source.read({channel, query.time, query.level, index}));
    const glm::ivec3 size = grid.brickSamples(index, query.level), first = grid.levelBegin(index, query.level);
    SamplePositions position(grid, index, query.level);
    std::vector<double> values(columns.size());
    Tallies out;
    std::uint64_t last = 0;
    Tally* own = nullptr; // neighbours are mostly of one group
    std::size_t i = 0;
    for (int z = first.z; z < first.z + size.z; ++z) {
        const auto& cells = lengths[std::size_t(z % sublattices)];
        const double depth = cells[2][std::size_t(z / sublattices)] / sublattices;
        for (int y = first.y; y < first.y + size.y; ++y)
            for (int x = first.x; x < first.x + size.x; ++x, ++i, position.next()) {
                for (std::size_t c = 0; c < columns.size(); ++c) {
                    const bool there = columns[c].isPresent(i);
                    values[c] = there ? columns[c].exact(i) : std::numeric_limits<double>::quiet_NaN();
                }
                const std::uint64_t group = query.groupOf(values, position.at());
                if (!own || group != last) own = &out[group];
                last = group;
                *own += {1, depth * cells[1][std::size_t(y)] * cells[0][std::size_t(x)]};
            }
    }
    return out;
}

} // namespace

Tallies tallySamples(const BrickSource& source, const TallyQuery& query, const Progress& progress) {
    const BrickGrid& grid = source.grid();
    const int sublattices = grid.lattice.kind == LatticeKind::BCC ? 2 : 1;
    TallyLengths lengths;
    for (int s = 0; s < sublattices; ++s)
        for (int axis = 0; axis < 3; ++axis)
            lengths[std::size_t(s)][std::size_t(axis)] = cellLengths(grid, source.info().bounds, query.level, s, axis);
    const std::size_t bricks = grid.brickCount();
    std::vector<Tallies> parts(bricks); // added up in order, so that rounding is the same each time
    std::atomic<std::size_t> done = 0;
    std::mutex reporting;
    parallelFor(bricks, [&](std::size_t i) {
        if (progress.stop.stop_requested()) throw Cancelled();
        parts[i] = tallyBrick(source, query, lengths, sublattices, grid.indexOf(i));
        const std::size_t finished = ++done;
        if (const std::unique_lock lock(reporting, std::try_to_lock); lock)
            progress.advance(double(finished) / double(bricks), "counting samples");
    });
    Tallies all;
    for (const Tallies& part : parts)
        for (const auto& [group, tally] : part) all[group] += tally;
    return all;
}

} // namespace tessera::volume
