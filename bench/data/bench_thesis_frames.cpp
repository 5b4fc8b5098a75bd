#include "bench/bench.h"
#include "bench/data/bench_archives.h"

#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "volume/base/parallel.h"
#include "volume/export/export.h"
#include "volume/import/import.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

constexpr int kFrameTimes = 12;

double wallMilliseconds() {
    return 1000 * std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A blob that moves over a weave, 90 x 90 x 80 at some times, in bytes or floats.
volume::Dataset movingSeries(volume::ScalarType type) {
    volume::Dataset series;
    series.info.name = "moving blob";
    series.info.lattice.size = {90, 90, 80};
    series.info.bounds = {{0, 0, 0}, {89, 89, 79}};
    series.info.times.clear();
    for (int t = 0; t < kFrameTimes; ++t) series.info.times.push_back(t);
    volume::Parameter parameter;
    parameter.name = "x";
    parameter.type = type;
    series.info.parameters = {parameter};
    series.read = [type, lattice = series.info.lattice](int, int, int time) {
        volume::Field field = volume::makeField(lattice, type);
        volume::dispatch(type, [&]<class T>(T) {
            const auto samples = field.as<T>();
            std::size_t i = 0;
            for (int z = 0; z < lattice.size.z; ++z)
                for (int y = 0; y < lattice.size.y; ++y)
                    for (int x = 0; x < lattice.size.x; ++x, ++i) {
                        const glm::dvec3 apart = glm::dvec3(x, y, z) - glm::dvec3(25 + 4 * time, 45, 40);
                        const double blob = std::exp(-glm::dot(apart, apart) / 500);
                        samples[i] = static_cast<T>(12 + 230 * blob + 10 * std::sin(0.9 * x) * std::cos(0.7 * y + z));
                    }
        });
        return field;
    };
    return series;
}

/// Reads every brick of a time on all cores, as for upload to textures.
void readTime(const volume::BrickSource& source, int time) {
    const volume::BrickGrid& grid = source.grid();
    parallelFor(grid.brickCount(), [&](std::size_t n) { (void)source.read({0, time, 0, grid.indexOf(n)}); });
}

/// Median milliseconds to read one time. Each round opens the source anew, so that no frame is cached by it; the first
/// round only fills the system's file cache.
double medianMilliseconds(const std::function<std::shared_ptr<const volume::BrickSource>()>& open) {
    std::vector<double> times;
    for (int turn = 0; turn < 4; ++turn) {
        const auto source = open();
        for (int time = 0; time < int(source->info().times.size()); ++time) {
            const double start = wallMilliseconds();
            readTime(*source, time);
            if (turn > 0) times.push_back(wallMilliseconds() - start);
        }
    }
    std::nth_element(times.begin(), times.begin() + std::ptrdiff_t(times.size() / 2), times.end());
    return times[times.size() / 2];
}

} // namespace

BenchTable benchThesisFrames() {
    BenchTable table;
    table.name = "thesis: table 6.5, going to another time of a series of 90x90x80, until its bricks are ready to "
                 "become textures";
    table.columns = {"samples", "from", "kB a time", "ms (median)", "raw / this", "ms (thesis)"};
    struct Row {
        codec::StoredLattice lattice;
        const char *name, *thesis;
    };
    const Row rows[] = {{codec::StoredLattice::CC, "archive on CC", ""},
                        {codec::StoredLattice::BCC, "archive on BCC", ""},
                        {codec::StoredLattice::D4, "archive on D4*, shown as BCC", "18"}};
    for (const volume::ScalarType type : {volume::ScalarType::U8, volume::ScalarType::F32}) {
        const std::string name(volume::name(type));
        volume::Dataset series = movingSeries(type);
        const BenchFile raw(".raw");
        volume::exportDataset(series, {}, raw.path);
        const std::string sidecar = raw.path.substr(0, raw.path.size() - 4) + ".json";
        const double rawTime = medianMilliseconds(
            [&] { return volume::makeMemorySource(volume::openFiles({sidecar}, {}), {.budget = 1}); });
        std::remove(sidecar.c_str());
        const double bytes = double(series.info.lattice.count() * volume::byteSize(type));
        table.rows.push_back({name, "raw file, CC", decimals(bytes / 1e3, 0), decimals(rawTime, 2), "1.00",
                              type == volume::ScalarType::U8 ? "120" : ""});
        for (const Row& row : rows) {
            const BenchFile file;
            codec::PackOptions options;
            options.lattice = row.lattice;
            if (type == volume::ScalarType::F32) options.maxError = 1e-3;
            codec::pack(series, options, file.path);
            const double time = medianMilliseconds([&] { return codec::openArchive(file.path); });
            const codec::Archive archive(file.path);
            table.rows.push_back(
                {name, row.name, decimals(double(archive.fileBytes()) / 1e3 / double(archive.info().times.size()), 0),
                 decimals(time, 2), decimals(rawTime / time, 2), type == volume::ScalarType::U8 ? row.thesis : ""});
        }
    }
    return table;
}

} // namespace tessera::app
