#include "bench/bench.h"

#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "volume/import/import.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <random>
#include <tbb/global_control.h>
#include <unistd.h>

namespace tessera::app {

namespace {

namespace fs = std::filesystem;

double wallSeconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double cpuSeconds() {
    return double(std::clock()) / CLOCKS_PER_SEC;
}

/// The fastest of several runs.
template <class Body> double best(double (*clock)(), Body&& body) {
    double least = 1e300;
    for (int run = 0; run < 9; ++run) {
        const double start = clock();
        body();
        least = std::min(least, clock() - start);
    }
    return std::max(least, 1e-6);
}

void readAll(const codec::Archive& archive, int level) {
    const glm::ivec3 count = archive.grid().count();
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) (void)archive.read({0, 0, level, {x, y, z}});
}

} // namespace

BenchTable benchLevels() {
    BenchTable table;
    table.name = "codec: coarse levels and single bricks compared with the whole time";
    table.columns = {"data",       "half: % of time",       "% of bytes",       "quarter: % of time",
                     "% of bytes", "random bricks / share", "two threads / one"};
    const char* data = std::getenv("TESSERA_DATA");
    std::vector<fs::path> sidecars;
    std::error_code missing;
    if (data != nullptr)
        for (const auto& entry : fs::directory_iterator(fs::path(data) / "volumes", missing))
            if (entry.path().extension() == ".json") sidecars.push_back(entry.path());
    std::sort(sidecars.begin(), sidecars.end());
    const std::string path =
        (fs::temp_directory_path() / ("tessera-levels-" + std::to_string(::getpid()) + ".tsr")).string();
    for (const fs::path& sidecar : sidecars) {
        volume::Dataset dataset = volume::openFiles({sidecar.string()}, {});
        codec::PackOptions options;
        options.lattice = codec::StoredLattice::CC;
        codec::pack(dataset, options, path);
        const codec::Archive archive(path);
        std::remove(path.c_str());
        if (archive.grid().levels < 3) continue;
        double bytes[3] = {};
        for (int level = 0; level < archive.grid().levels; ++level)
            for (int upTo = 0; upTo < 3; ++upTo) bytes[upTo] += level >= upTo ? double(archive.levelBytes(level)) : 0;
        double times[3];
        for (int level = 0; level < 3; ++level) times[level] = best(cpuSeconds, [&] { readAll(archive, level); });
        // Every brick once, in any order.
        const glm::ivec3 count = archive.grid().count();
        std::mt19937 random(1);
        std::vector<glm::ivec3> bricks;
        for (int z = 0; z < count.z; ++z)
            for (int y = 0; y < count.y; ++y)
                for (int x = 0; x < count.x; ++x) bricks.emplace_back(x, y, z);
        std::shuffle(bricks.begin(), bricks.end(), random);
        const double scattered = best(cpuSeconds, [&] {
            for (const glm::ivec3& brick : bricks) (void)archive.read({0, 0, 0, brick});
        });
        const auto frame = [&] { (void)codec::readField(archive, 0, 0, 0); };
        const double two = best(wallSeconds, frame);
        double one = 0;
        {
            const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
            one = best(wallSeconds, frame);
        }
        table.rows.push_back({sidecar.stem().string(), decimals(100 * times[1] / times[0], 1),
                              decimals(100 * bytes[1] / bytes[0], 1), decimals(100 * times[2] / times[0], 1),
                              decimals(100 * bytes[2] / bytes[0], 1), decimals(scattered / times[0], 2),
                              decimals(one / two, 2)});
    }
    return table;
}

} // namespace tessera::app
