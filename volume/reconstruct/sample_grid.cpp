#include "volume/reconstruct/sample_grid.h"

#include "volume/base/parallel.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/reconstruct/reconstruct.h"

#include <algorithm>
#include <atomic>
#include <utility>

namespace tessera::volume {

namespace {

/// Means of the sample pairs of a coarse BCC level; for labels the even samples.
SampleGrid pairMeans(const BrickGrid& bricks, int level, const SampleGrid& fine, bool isLabel) {
    const glm::ivec3 stored = bricks.levelSamples(level);
    SampleGrid out;
    out.lattice.size = {stored.x, stored.y, (stored.z + 1) / 2};
    const double step = double(1 << level);
    out.lattice.spacing = bricks.lattice.spacing * step;
    out.lattice.axes = bricks.lattice.axes;
    out.lattice.origin = bricks.lattice.sheetOfCells(glm::dvec3(bricks.levelPhase(level) + 0.25));
    out.values.resize(out.lattice.count());
    if (!fine.present.empty()) out.present.resize(out.values.size());
    const std::size_t slice = std::size_t(stored.x) * std::size_t(stored.y);
    for (std::size_t i = 0; i < out.values.size(); ++i) {
        const std::size_t even = i / slice * 2 * slice + i % slice, odd = even + slice;
        const bool hasEven = fine.isPresent(even);
        const bool hasOdd = odd < fine.values.size() && fine.isPresent(odd);
        const float a = fine.values[even], b = hasOdd ? fine.values[odd] : a;
        const bool alike = !isLabel && (fine.parts.empty() || (hasOdd && fine.parts[even] == fine.parts[odd]));
        out.values[i] = hasEven && hasOdd && alike ? 0.5f * (a + b) : hasEven ? a : b;
        if (!fine.parts.empty()) out.parts.push_back(fine.parts[hasEven || !hasOdd ? even : odd]);
        if (!fine.present.empty()) out.present[i] = hasEven || hasOdd;
    }
    return out;
}

/// The stored samples of a level.
SampleGrid readStored(const BrickSource& source, int channel, int time, int level, const Progress& progress) {
    const BrickGrid& bricks = source.grid();
    const bool bcc = bricks.lattice.kind == LatticeKind::BCC;
    const glm::ivec3 size = bricks.levelSamples(level), count = bricks.count();
    SampleGrid out;
    out.lattice = bricks.lattice;
    out.lattice.size = size;
    if (level > 0 && !bcc) {
        out.lattice.spacing = bricks.lattice.spacing * double(1 << level);
        out.lattice.origin = bricks.lattice.sheetOfCells(glm::dvec3(bricks.levelPhase(level)));
    }
    out.values.resize(out.lattice.count());
    out.present.assign(out.values.size(), 1);
    std::atomic<bool> someAbsent{false};
    std::atomic<int> done{0};
    const std::size_t total = std::size_t(count.x) * std::size_t(count.y) * std::size_t(count.z);
    parallelFor(total, [&](std::size_t n) {
        if (progress.stop.stop_requested()) throw Cancelled();
        const glm::ivec3 index(int(n % std::size_t(count.x)), int(n / std::size_t(count.x) % std::size_t(count.y)),
                               int(n / std::size_t(count.x) / std::size_t(count.y)));
        const BrickSamples brick = source.read({channel, time, level, index});
        const glm::ivec3 first = bricks.levelBegin(index, level);
        for (int z = 0; z < brick.size.z; ++z)
            for (int y = 0; y < brick.size.y; ++y) {
                const std::size_t from = (std::size_t(z) * std::size_t(brick.size.y) + std::size_t(y)) *
                                         std::size_t(brick.size.x),
                                  to = out.lattice.index(first + glm::ivec3(0, y, z));
                std::copy_n(brick.values.begin() + std::ptrdiff_t(from), brick.size.x,
                            out.values.begin() + std::ptrdiff_t(to));
                if (!brick.present.empty())
                    std::copy_n(brick.present.begin() + std::ptrdiff_t(from), brick.size.x,
                                out.present.begin() + std::ptrdiff_t(to));
            }
        if (!brick.present.empty()) someAbsent = true;
        if (progress.report) progress.report(double(++done) / double(total), "");
    });
    if (!someAbsent) out.present.clear();
    return out;
}

} // namespace

SampleGrid readSamples(const BrickSource& source, int channel, int time, int level, const Progress& progress) {
    const Channel known = source.info().channel(channel);
    const Parameter& parameter = source.info().parameters[std::size_t(known.parameter)];
    const std::optional<int> label = labelChannel(source.info(), parameter);
    SampleGrid out = readStored(source, channel, time, level, label ? progress.part(0, 0.5) : progress);
    if (label) {
        SampleGrid labels = readStored(source, *label, time, level, progress.part(0.5, 1));
        out.parts =
            partsOfSamples({labels.lattice.size, std::move(labels.values), std::move(labels.present)}, parameter.parts);
    }
    const bool pairs = source.grid().lattice.kind == LatticeKind::BCC && level > 0;
    return pairs ? pairMeans(source.grid(), level, out, parameter.categorical) : out;
}

SampleGrid ofPart(SampleGrid grid, std::size_t part) {
    if (grid.parts.empty()) return grid;
    if (grid.present.empty()) grid.present.assign(grid.values.size(), 1);
    for (std::size_t i = 0; i < grid.parts.size(); ++i)
        if (grid.parts[i] != part) grid.present[i] = 0;
    grid.parts.clear();
    return grid;
}

SampleGrid padded(const SampleGrid& grid) {
    const int slices = grid.lattice.kind == LatticeKind::BCC ? 2 : 1;
    SampleGrid out;
    out.lattice = grid.lattice;
    out.lattice.size += glm::ivec3(2, 2, 2 * slices);
    out.lattice.origin -= grid.lattice.spacing;
    out.values.resize(out.lattice.count());
    if (!grid.present.empty()) out.present.resize(out.values.size());
    if (!grid.parts.empty()) out.parts.resize(out.values.size());
    const glm::ivec3 size = out.lattice.size;
    parallelFor(std::size_t(size.z), [&](std::size_t z) {
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const glm::ivec3 at(x, y, int(z));
                const std::size_t to = out.lattice.index(at),
                                  from = grid.lattice.index(clampToLattice(grid.lattice.kind, grid.lattice.size,
                                                                           at - glm::ivec3(1, 1, slices)));
                out.values[to] = grid.values[from];
                if (!grid.present.empty()) out.present[to] = grid.present[from];
                if (!grid.parts.empty()) out.parts[to] = grid.parts[from];
            }
    });
    return out;
}

} // namespace tessera::volume
