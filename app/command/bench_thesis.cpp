#include "app/command/bench.h"

#include "codec/archive.h"
#include "codec/pack.h"
#include "codec/thesis_coding.h"
#include "volume/import/import.h"
#include "volume/resample.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <unistd.h>

namespace tessera::app {

namespace {

namespace fs = std::filesystem;

template <class Body> double seconds(Body&& body) {
    const auto start = std::chrono::steady_clock::now();
    body();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string sizeText(glm::ivec3 size) {
    return std::to_string(size.x) + "x" + std::to_string(size.y) + "x" + std::to_string(size.z);
}

/// A file that disappears with the object.
struct Scratch {
    std::string path = (fs::temp_directory_path() / ("tessera-thesis-" + std::to_string(::getpid()) + ".tsr")).string();
    ~Scratch() { std::remove(path.c_str()); }
};

/// The volumes at hand, by name, as single frames of whole numbers.
std::vector<std::pair<std::string, volume::Dataset>> volumes() {
    std::vector<std::pair<std::string, volume::Dataset>> found;
    const char* data = std::getenv("TESSERA_DATA");
    std::vector<fs::path> sidecars;
    std::error_code missing;
    if (data)
        for (const auto& entry : fs::directory_iterator(fs::path(data) / "volumes", missing))
            if (entry.path().extension() == ".json") sidecars.push_back(entry.path());
    if (sidecars.empty())
        std::fprintf(stderr, "bench thesis: volumes are looked for in $TESSERA_DATA/volumes; there are none\n");
    std::sort(sidecars.begin(), sidecars.end());
    for (const fs::path& sidecar : sidecars) {
        volume::Dataset dataset = volume::openFiles({sidecar.string()}, {});
        const volume::ScalarType type = dataset.info.parameters[0].type;
        if (type != volume::ScalarType::F32 && type != volume::ScalarType::I32)
            found.emplace_back(sidecar.stem().string(), std::move(dataset));
    }
    return found;
}

struct ThesisTimes {
    const char* volume; ///< how the names of its files begin
    const char* bccSize;
    double resample, wavelet; ///< s, on its machine
};
constexpr ThesisTimes kThesisTimes[] = {{"nucleon", "29x29x58", 0.62, 0.02}, {"lobster", "213x229x79", 54.9, 8.5}};

} // namespace

BenchTable benchThesisSizes() {
    BenchTable table;
    table.name = "thesis: tables 6.1 and 6.2, sizes on BCC and seconds of pre-processing";
    table.columns = {
        "data", "CC", "BCC", "BCC (thesis)", "resample s", "resample s (thesis)", "code s", "wavelet s (thesis)"};
    for (auto& [name, dataset] : volumes()) {
        const volume::Field field = dataset.load(0, 0, 0);
        volume::Field bcc;
        const double resample = seconds([&] { bcc = volume::toBcc(field, false); });
        const Scratch file;
        const codec::PackSummary summary = codec::pack(dataset, {}, file.path);
        const auto of = [&, &known = name](const ThesisTimes& row) { return known.starts_with(row.volume); };
        const auto row = std::find_if(std::begin(kThesisTimes), std::end(kThesisTimes), of);
        const bool known = row != std::end(kThesisTimes);
        table.rows.push_back({name, sizeText(field.lattice.size), sizeText(bcc.lattice.size), known ? row->bccSize : "",
                              decimals(resample, 3), known ? decimals(row->resample, 2) : "",
                              decimals(summary.codeSeconds, 3), known ? decimals(row->wavelet, 2) : ""});
    }
    return table;
}

BenchTable benchThesisCoding() {
    using codec::Wavelet;
    BenchTable table;
    table.name = "thesis: table 6.4, three levels, soft threshold, run lengths (rows of frog and skull: its own)";
    table.columns = {"data",    "wavelet",          "threshold", "raw kB",
                     "runs kB", "best of three kB", "RMS error", "archive, lossless kB"};
    struct Row {
        const char *wavelet, *threshold, *frog, *skull;
    };
    const Row rows[] = {
        {"1,1", "0.0", "532.6", "701.1"}, {"1,1", "1.5", "495.2", "419.5"}, {"1,1", "5.5", "361.2", "184.5"},
        {"2,2", "0.0", "586.6", "705.6"}, {"2,2", "1.5", "532.9", "534.7"}, {"2,2", "5.5", "383.3", "233.4"},
        {"4,2", "0.0", "753.9", "696.6"}, {"4,2", "1.5", "700.2", "696.4"}, {"4,2", "5.5", "662.4", "696.5"}};
    for (const Row& row : rows)
        table.rows.push_back({"frog", row.wavelet, row.threshold, "30900", row.frog, "", "", ""});
    for (const Row& row : rows)
        table.rows.push_back({"skull", row.wavelet, row.threshold, "16000", row.skull, "", "", ""});
    for (auto& [name, dataset] : volumes()) {
        const volume::Field field = dataset.load(0, 0, 0);
        if (field.mask) continue;
        const Scratch file;
        codec::PackOptions options;
        options.lattice = codec::StoredLattice::CC;
        const codec::PackSummary summary = codec::pack(dataset, options, file.path);
        for (const Wavelet wavelet : {Wavelet::W11, Wavelet::W22, Wavelet::W42})
            for (const double value : {0.0, 1.5, 5.5}) {
                codec::ThesisCoding coding{wavelet, 3, codec::Threshold::Soft, value, false};
                const codec::ThesisResult one = codec::thesisCode(field, coding);
                coding.threeDirections = true;
                const codec::ThesisResult three = codec::thesisCode(field, coding);
                table.rows.push_back({name, std::string(codec::kWaveletNames[std::size_t(wavelet)]), decimals(value, 1),
                                      decimals(double(field.samples.size()) / 1e3, 1),
                                      decimals(double(one.bytes) / 1e3, 1), decimals(double(three.bytes) / 1e3, 1),
                                      decimals(one.rms, 3), decimals(double(summary.archiveBytes) / 1e3, 1)});
            }
    }
    return table;
}

BenchTable benchThesisFrames() {
    BenchTable table;
    table.name = "thesis: table 6.5, seconds to change the frame of a series of 90x90x80";
    table.columns = {"lattice", "frame s (median)", "frame s (thesis)"};
    volume::Dataset series;
    series.info.name = "moving blob";
    series.info.lattice.size = {90, 90, 80};
    series.info.bounds = {{0, 0, 0}, {89, 89, 79}};
    series.info.times = {0, 1, 2, 3};
    volume::Parameter parameter;
    parameter.name = "x";
    parameter.type = volume::ScalarType::U8;
    series.info.parameters = {parameter};
    series.load = [lattice = series.info.lattice](int, int, int time) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::U8);
        const auto samples = field.as<std::uint8_t>();
        std::size_t i = 0;
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x, ++i) {
                    const glm::dvec3 apart = glm::dvec3(x, y, z) - glm::dvec3(30 + 8 * time, 45, 40);
                    const double blob = std::exp(-glm::dot(apart, apart) / 500);
                    samples[i] = static_cast<std::uint8_t>(230 * blob + 10 * std::sin(0.9 * x) * std::cos(0.7 * y + z));
                }
        return field;
    };
    const std::pair<codec::StoredLattice, const char*> lattices[] = {
        {codec::StoredLattice::CC, "0.12"}, {codec::StoredLattice::BCC, ""}, {codec::StoredLattice::D4, "0.018"}};
    for (const auto& [lattice, thesis] : lattices) {
        const Scratch file;
        codec::PackOptions options;
        options.lattice = lattice;
        volume::Dataset copy = series;
        codec::pack(copy, options, file.path);
        const auto source = codec::openArchive(file.path);
        const glm::ivec3 count = source->grid().count();
        std::vector<double> times;
        for (int turn = 0; turn < 5; ++turn)
            for (int time = 0; time < int(source->info().times.size()); ++time)
                times.push_back(seconds([&] {
                    for (int z = 0; z < count.z; ++z)
                        for (int y = 0; y < count.y; ++y)
                            for (int x = 0; x < count.x; ++x) (void)source->read({0, time, 0, {x, y, z}});
                }));
        std::sort(times.begin(), times.end());
        table.rows.push_back({std::string(codec::kStoredLatticeNames[std::size_t(lattice)]),
                              decimals(times[times.size() / 2], 4), thesis});
    }
    return table;
}

} // namespace tessera::app
