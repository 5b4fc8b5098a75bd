#include "bench/bench.h"
#include "bench/data/bench_archives.h"

#include "codec/archive/archive.h"
#include "codec/bytes/entropy.h"
#include "codec/pack/pack.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <ctime>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

namespace tessera::app {

namespace {

/// CPU seconds that `body` takes, which hardly depend on other load of the machine.
template <class Body> double cpuSeconds(Body&& body) {
    const std::clock_t start = std::clock();
    body();
    return std::max(double(std::clock() - start), 1.0) / CLOCKS_PER_SEC;
}

/// Calls `visit` with every frame of a data set.
template <class Visit> void forFrames(const volume::DatasetInfo& info, Visit&& visit) {
    for (int t = 0; t < int(info.times.size()); ++t)
        for (int p = 0; p < int(info.parameters.size()); ++p)
            for (int c = 0; c < info.parameters[std::size_t(p)].components; ++c) visit(p, c, t);
}

void measure(const std::string& name, volume::Dataset dataset, BenchTable& table) {
    codec::Bytes raw;
    forFrames(dataset.info, [&](int p, int c, int t) {
        const volume::Field field = dataset.read(p, c, t);
        raw.insert(raw.end(), field.samples.begin(), field.samples.end());
    });
    const double bytes = double(raw.size());

    codec::Compressor zstd(19);
    codec::Bytes packed = zstd.compress(raw);
    if (packed.empty()) packed = raw;
    codec::Bytes unpacked(raw.size());
    const double zstdDecode = cpuSeconds([&] { (void)codec::decompress(packed, unpacked); });

    constexpr int kUsual = 5, kLongest = 9;
    for (const auto& [lattice, effort] : {std::pair(codec::StoredLattice::CC, kUsual),
                                          {codec::StoredLattice::BCC, kUsual},
                                          {codec::StoredLattice::CC, kLongest},
                                          {codec::StoredLattice::BCC, kLongest}}) {
        const BenchFile file;
        codec::PackOptions options;
        options.lattice = lattice;
        options.effort = effort;
        codec::PackSummary summary;
        volume::Dataset copy = dataset;
        const double packSeconds = cpuSeconds([&] { summary = codec::pack(copy, options, file.path); });
        const codec::Archive archive(file.path);
        double stored = 0;
        const double decodeSeconds = cpuSeconds([&] {
            forFrames(archive.info(), [&](int p, int c, int t) {
                stored += double(codec::readField(archive, p, c, t).samples.size());
            });
        });
        const double size = double(summary.archiveBytes);
        const double decode = stored / 1e6 / decodeSeconds, peer = bytes / 1e6 / zstdDecode;
        table.rows.push_back({name, lattice == codec::StoredLattice::CC ? "CC" : "BCC", std::to_string(effort),
                              decimals(bytes / 1e6, 2), decimals(size / 1e6, 3), decimals(bytes / size, 2),
                              decimals(bytes / double(packed.size()), 2), decimals(double(packed.size()) / size, 2),
                              decimals(bytes / 1e6 / packSeconds, 1), decimals(decode, 0), decimals(peer, 0),
                              decimals(decode / peer, 2)});
    }
}

/// Packing within an error bound, of frames in memory.
void measureBounded(const std::string& name, volume::Dataset dataset, codec::StoredLattice lattice, double maxError,
                    BenchTable& table) {
    double bytes = 0;
    std::map<std::tuple<int, int, int>, volume::Field> fields;
    forFrames(dataset.info, [&](int p, int c, int t) {
        volume::Field& field = fields[{p, c, t}] = dataset.read(p, c, t);
        bytes += double(field.samples.size());
    });
    dataset.read = [shared = std::make_shared<const decltype(fields)>(std::move(fields))](int p, int c, int t) {
        return shared->at({p, c, t});
    };
    const BenchFile file;
    codec::PackOptions options;
    options.lattice = lattice;
    options.lossless = false;
    options.maxError = maxError;
    codec::PackSummary summary;
    const double seconds = cpuSeconds([&] { summary = codec::pack(dataset, options, file.path); });
    table.rows.push_back({name, lattice == codec::StoredLattice::CC ? "CC" : "BCC", decimals(maxError, 3),
                          decimals(bytes / 1e6, 2), decimals(double(summary.archiveBytes) / 1e3, 1),
                          decimals(bytes / double(summary.archiveBytes), 2), decimals(seconds, 2),
                          decimals(bytes / 1e6 / seconds, 1)});
}

} // namespace

BenchTable benchBounded() {
    BenchTable table;
    table.name = "codec: within an error bound";
    table.columns = {"data", "lattice", "bound", "raw MB", "archive kB", "ratio", "pack CPU s", "pack MB/CPU s"};
    const volume::Dataset cell = volume::makeModel("fuel-cell", {{"times", 6}, {"even", 1}});
    for (const auto lattice : {codec::StoredLattice::CC, codec::StoredLattice::BCC})
        measureBounded("fuel-cell, 6 times, parts", cell, lattice, 1e-3, table);
    for (auto& [name, dataset] : volumeFiles())
        if (dataset.info.parameters[0].type == volume::ScalarType::F32)
            measureBounded(name, std::move(dataset), codec::StoredLattice::CC, 1e-3, table);
    return table;
}

BenchTable benchCodec() {
    BenchTable table;
    table.name = "codec";
    table.columns = {"data",          "lattice",         "effort",         "raw MB",
                     "archive MB",    "ratio",           "zstd -19 ratio", "over zstd",
                     "pack MB/CPU s", "decode MB/CPU s", "zstd decode",    "decode over zstd"};
    const auto cubic = [](double n) { return std::map<std::string, double>{{"nx", n}, {"ny", n}, {"nz", n}}; };
    measure("marschner-lobb 64^3", volume::makeModel("marschner-lobb", cubic(64)), table);
    for (auto& [name, dataset] : volumeFiles()) measure(name, std::move(dataset), table);
    return table;
}

} // namespace tessera::app
