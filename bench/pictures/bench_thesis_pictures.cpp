#include "bench/bench.h"
#include "bench/data/bench_archives.h"
#include "bench/pictures/bench_frames.h"
#include "vis/gl/headless.h"
#include "volume/base/error.h"
#include "volume/sources/memory_source.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string_view>

namespace tessera::app {

namespace {

/// A volume of Table 6.3: its size, and pictures a second on CC and BCC there.
struct ThesisPictures {
    std::string_view name;
    glm::ivec3 size;
    std::string_view file; ///< prefix of its file names; "": not available, replaced by a casting of the same size
    double cc, bcc;
};
constexpr ThesisPictures kThesisPictures[] = {{"nucleon", {41, 41, 41}, "nucleon", 73.2, 82.6},
                                              {"lobster", {301, 324, 56}, "lobster", 13.1, 9.4},
                                              {"statue leg", {341, 341, 90}, "", 27.6, 15.06},
                                              {"engine", {256, 256, 128}, "", 31.6, 7.1},
                                              {"brain", {256, 256, 145}, "", 20.88, 7.6}};

volume::Dataset dataOf(const ThesisPictures& row, std::vector<std::pair<std::string, volume::Dataset>>& atHand,
                       std::string& name) {
    const auto found = std::ranges::find_if(
        atHand, [&](const auto& entry) { return !row.file.empty() && entry.first.starts_with(row.file); });
    name = found != atHand.end() ? found->first : "as large as " + std::string(row.name);
    volume::Dataset data =
        found != atHand.end()
            ? std::move(found->second)
            : volume::makeModel("casting", {{"nx", row.size.x}, {"ny", row.size.y}, {"nz", row.size.z}});
    data.info.parameters.resize(1);
    data.info.parameters.front().name = "v"; // what benchScene() shows
    return data;
}

} // namespace

BenchTable benchThesisPictures() {
    BenchTable table;
    table.name = "thesis: table 6.3, pictures of 512x512 that are translucent and whole, a sample per voxel";
    std::optional<vis::HeadlessContext> context;
    try {
        context.emplace();
    } catch (const Error& error) {
        std::fprintf(stderr, "table 6.3 is left out: %s\n", error.what());
        return table;
    }
    table.columns = {"data", "lattice", "samples MB", timeColumn(benchClock()), "CC / this", "per second (thesis)"};
    std::vector<std::pair<std::string, volume::Dataset>> atHand = thesisVolumes();
    const vis::Scene scene = benchScene(vis::VolumeLayer{.channel = "v", .shaded = false}, {{0, 0}, {1, 0.1f}});
    for (const ThesisPictures& row : kThesisPictures) {
        std::string name;
        const volume::Dataset data = dataOf(row, atHand, name);
        const double each = double(volume::byteSize(data.info.parameters.front().type));
        double first = 0;
        for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
            const bool bcc = kind == volume::LatticeKind::BCC;
            const std::shared_ptr<const volume::BrickSource> source = volume::makeMemorySource(data, {.lattice = kind});
            vis::Renderer renderer;
            renderer.setSource(source);
            const double milliseconds = timeFrames(renderer, scene);
            if (!bcc) first = milliseconds;
            table.rows.push_back({name, std::string(volume::kLatticeNames[std::size_t(kind)]),
                                  decimals(double(source->grid().lattice.count()) * each / 1e6, 2),
                                  decimals(milliseconds, 1), decimals(first / milliseconds, 2),
                                  decimals(bcc ? row.bcc : row.cc, 1)});
        }
    }
    return table;
}

} // namespace tessera::app
