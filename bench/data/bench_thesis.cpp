#include "bench/bench.h"
#include "bench/data/bench_archives.h"

#include "bench/data/thesis_coding.h"
#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "volume/resample/series_dataset.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <glm/vec4.hpp>
#include <map>

namespace tessera::app {

namespace {

std::string sizeText(glm::ivec3 size) {
    return std::to_string(size.x) + "x" + std::to_string(size.y) + "x" + std::to_string(size.z);
}

/// A data set of Tables 6.1 and 6.2: sizes, and the seconds its machine took.
struct ThesisData {
    const char* name;
    glm::ivec4 size;  ///< x, y, z, times
    const char* bcc;  ///< its size on BCC or D4*
    const char* file; ///< prefix of its file names; "": not available, replaced by a synthetic volume of the same size
    double resample, wavelet;
};
constexpr ThesisData kThesisData[] = {{"nucleon", {41, 41, 41, 1}, "29x29x58", "nucleon", 0.62, 0.02},
                                      {"lobster", {301, 324, 56, 1}, "213x229x79", "lobster", 54.9, 8.5},
                                      {"statue leg", {341, 341, 90, 1}, "241x241x127", "", 106.4, 5.7},
                                      {"engine", {256, 256, 128, 1}, "181x181x181", "", 87.8, 5.2},
                                      {"brain", {256, 256, 145, 1}, "181x181x205", "", 109.6, 5.9},
                                      {"kidney", {90, 90, 80, 64}, "63x63x56x90", "", 967.9, 8.5}};

/// Bytes as large as a data set of the thesis: a tomogram of three materials, or a signal that moves.
volume::Dataset madeAsLarge(const ThesisData& row) {
    std::map<std::string, double> settings{{"nx", row.size.x}, {"ny", row.size.y}, {"nz", row.size.z}};
    if (row.size.w == 1) return volume::makeModel("casting", settings);
    settings["times"] = row.size.w;
    settings["bits"] = 8;
    volume::Dataset made = volume::makeModel("marschner-lobb", settings);
    std::vector<volume::Field> frames; // computed before anything is timed
    for (int t = 0; t < row.size.w; ++t) frames.push_back(made.read(0, 0, t));
    made.read = [frames = std::move(frames)](int, int, int time) { return frames[std::size_t(time)]; };
    return made;
}

} // namespace

BenchTable benchThesisSizes() {
    BenchTable table;
    table.name = "thesis: tables 6.1 and 6.2, sizes on BCC and D4* and seconds of pre-processing";
    table.columns = {"data",       "CC",
                     "BCC, D4*",   "BCC, D4* (thesis)",
                     "resample s", "resample s (thesis)",
                     "code s",     "wavelet s (thesis)"};
    std::vector<std::pair<std::string, volume::Dataset>> atHand = thesisVolumes();
    const auto add = [&](const std::string& name, volume::Dataset& dataset, const ThesisData* known) {
        const BenchFile file;
        codec::PackOptions options;
        const bool moves = volume::whyNotD4(dataset.info).empty();
        options.lattice = moves ? codec::StoredLattice::D4 : codec::StoredLattice::BCC;
        const codec::PackSummary summary = codec::pack(dataset, options, file.path);
        const codec::Archive archive(file.path);
        const std::string times = std::to_string(dataset.info.times.size());
        table.rows.push_back(
            {name, sizeText(dataset.info.lattice.size) + (moves ? "x" + times : ""),
             sizeText(archive.info().lattice.size) + (moves ? "x" + std::to_string(archive.info().times.size()) : ""),
             known ? known->bcc : "", decimals(summary.resampleSeconds + (moves ? summary.loadSeconds : 0), 3),
             known ? decimals(known->resample, 2) : "", decimals(summary.codeSeconds, 3),
             known ? decimals(known->wavelet, 2) : ""});
    };
    for (const ThesisData& row : kThesisData) {
        const std::string begin = row.file;
        const auto found = std::find_if(atHand.begin(), atHand.end(), [&](const auto& entry) {
            return !begin.empty() && entry.first.starts_with(begin);
        });
        if (found != atHand.end()) {
            add(found->first, found->second, &row);
            atHand.erase(found);
        } else {
            volume::Dataset made = madeAsLarge(row);
            add("as large as " + std::string(row.name), made, &row);
        }
    }
    for (auto& [name, dataset] : atHand) add(name, dataset, nullptr);
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
    for (auto& [name, dataset] : thesisVolumes()) {
        const volume::Field field = dataset.read(0, 0, 0);
        if (field.mask) continue;
        const BenchFile file;
        codec::PackOptions options;
        options.lattice = codec::StoredLattice::CC;
        const codec::PackSummary summary = codec::pack(dataset, options, file.path);
        for (const Wavelet wavelet : {Wavelet::W11, Wavelet::W22, Wavelet::W42})
            for (const double value : {0.0, 1.5, 5.5}) {
                ThesisCoding coding{wavelet, 3, codec::Threshold::Soft, value, false};
                const ThesisResult one = thesisCode(field, coding);
                coding.threeDirections = true;
                const ThesisResult three = thesisCode(field, coding);
                table.rows.push_back({name, std::string(codec::kWaveletNames[std::size_t(wavelet)]), decimals(value, 1),
                                      decimals(double(field.samples.size()) / 1e3, 1),
                                      decimals(double(one.bytes) / 1e3, 1), decimals(double(three.bytes) / 1e3, 1),
                                      decimals(one.rms, 3), decimals(double(summary.archiveBytes) / 1e3, 1)});
            }
    }
    return table;
}

} // namespace tessera::app
