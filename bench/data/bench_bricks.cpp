#include "app/command/merge_layouts.h"
#include "bench/bench.h"
#include "bench/data/bench_archives.h"

#include "codec/archive/archive.h"
#include "codec/pack/pack.h"

#include <algorithm>

namespace tessera::app {

namespace {

/// Bytes of all bricks of an archive, without index and header.
std::uint64_t brickBytesOf(const codec::Archive& archive) {
    std::uint64_t sum = 0;
    for (int level = 0; level < archive.grid().levels; ++level) sum += archive.levelBytes(level);
    return sum;
}

std::string kilobytes(std::uint64_t bytes) {
    return decimals(double(bytes) / 1e3, 1);
}

} // namespace

BenchTable benchBricks() {
    BenchTable table;
    table.name = "thesis: section 4.2.2, bricks of 16 on BCC, lossless, merged up to four along an axis where their "
                 "importance differs by 0.1 at most";
    table.columns = {"data", "bricks", "importance >= 0.05", "uniform",        "mixed",
                     "best", "kB",     "kB, best as one",    "kB, all as one", "kB in bricks of 32",
                     "of 64"};
    for (auto& [name, dataset] : thesisVolumes()) {
        const auto packed = [&, &data = dataset](int brickSize) {
            const BenchFile file;
            codec::PackOptions options;
            options.lattice = codec::StoredLattice::BCC;
            options.brickSize = brickSize;
            options.levels = 3;
            codec::pack(data, options, file.path);
            return codec::Archive(file.path); // the mapping stays valid after the file is removed
        };
        const codec::Archive small = packed(16);
        const glm::ivec3 count = small.grid().count();
        const volume::MergeOptions options;
        const std::vector<MergeLayout> layouts = mergeLayouts(small, options, {});
        volume::MergeOptions everything = options;
        everything.alike = 1;
        const auto all = mergeLayouts(small, everything, {});
        const std::vector<float> importance = volume::mostImportant(small);
        const auto kept = std::ranges::count_if(importance, [](float value) { return value >= 0.05f; });
        table.rows.push_back({name, std::to_string(count.x * count.y * count.z), std::to_string(kept),
                              std::to_string(layouts[0].boxes.size()), std::to_string(layouts[1].boxes.size()),
                              std::to_string(layouts[2].boxes.size()), kilobytes(brickBytesOf(small)),
                              kilobytes(layouts[2].sum().together), kilobytes(all[0].sum().together),
                              kilobytes(brickBytesOf(packed(32))), kilobytes(brickBytesOf(packed(64)))});
    }
    return table;
}

} // namespace tessera::app
