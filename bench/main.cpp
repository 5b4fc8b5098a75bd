#include "app/command/command.h"
#include "bench/bench.h"
#include "volume/base/error.h"
#include "volume/system/free_memory.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

namespace tessera::app {

namespace {

struct NamedBench {
    const char* name;
    BenchTable (*measure)() = nullptr;
    BenchTable (*measureVolumes)(const std::string& volume) = nullptr;
};
constexpr NamedBench kBenches[] = {{"growth", nullptr, benchGrowth},
                                   {"start", benchStart},
                                   {"lattice", benchLattice},
                                   {"lattice", benchResample},
                                   {"lattice", benchBccTransforms},
                                   {"lattice", benchLatticeBytes},
                                   {"lattice", benchSignalBytes},
                                   {"codec", benchCodec},
                                   {"codec", benchBounded},
                                   {"codec", benchLevels},
                                   {"codec", benchPeers},
                                   {"thesis", benchThesisSizes},
                                   {"thesis", benchBricks},
                                   {"thesis", benchThesisCoding},
                                   {"thesis", benchThesisFrames},
                                   {"thesis", benchThesisPictures},
                                   {"render", nullptr, benchRender},
                                   {"render", nullptr, benchModes},
                                   {"styles", benchStyles},
                                   {"refined", nullptr, benchRefined},
                                   {"link", benchLink},
                                   {"link", benchScatter},
                                   {"playing", benchNewData},
                                   {"playing", benchPlaying},
                                   {"large", benchLarge}};

/// Columns of texts to the left, of numbers to the right.
void print(const BenchTable& table) {
    std::vector<std::size_t> widths;
    std::vector<bool> numeric;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        widths.push_back(table.columns[c].size());
        numeric.push_back(true);
        for (const std::vector<std::string>& row : table.rows) {
            widths[c] = std::max(widths[c], row[c].size());
            numeric[c] =
                numeric[c] && (row[c].empty() || std::string("-+.0123456789").find(row[c][0]) != std::string::npos);
        }
    }
    const auto line = [&](const std::vector<std::string>& cells) {
        std::string text;
        for (std::size_t c = 0; c < cells.size(); ++c) {
            const std::string pad(widths[c] - cells[c].size(), ' ');
            text += (c > 0 ? "  " : "") + (numeric[c] ? pad + cells[c] : cells[c] + pad);
        }
        text.erase(text.find_last_not_of(' ') + 1);
        std::printf("%s\n", text.c_str());
    };
    std::printf("%s\n", table.name.c_str());
    line(table.columns);
    for (const std::vector<std::string>& row : table.rows) line(row);
    std::printf("\n");
    std::fflush(stdout);
}

struct Options {
    std::vector<std::string> names;
    std::string volume;
    bool json = false;
};

bool isWanted(const NamedBench& bench, const Options& options) {
    return options.names.empty() || std::ranges::find(options.names, bench.name) != options.names.end();
}

void measure(const Options& options) {
    const auto usesVolume = [&](const NamedBench& bench) { return bench.measureVolumes && isWanted(bench, options); };
    if (!options.volume.empty() && std::ranges::none_of(kBenches, usesVolume))
        throw tessera::Error(
            "chooses among the volumes of render and refined and the inputs of growth, none of which are measured", {},
            "--volume");
    nlohmann::json tables = nlohmann::json::array();
    for (const NamedBench& bench : kBenches) {
        if (!isWanted(bench, options)) continue;
        const BenchTable table = bench.measure ? bench.measure() : bench.measureVolumes(options.volume);
        if (options.json)
            tables.push_back({{"name", table.name}, {"columns", table.columns}, {"rows", table.rows}});
        else
            print(table);
    }
    if (options.json) std::printf("%s\n", nlohmann::json{{"tables", tables}}.dump(2).c_str());
}

} // namespace
} // namespace tessera::app

int main(int argc, char** argv) try {
    using namespace tessera::app;
    tessera::volume::keepFreeMemory(); // as the program does
    CLI::App app{"Measure the tables of docs/benchmarks.md on this machine", "tessera bench"};
    Options options;
    std::vector<std::string> known;
    for (const NamedBench& bench : kBenches)
        if (known.empty() || known.back() != bench.name) known.emplace_back(bench.name);
    app.add_option("name", options.names, "Which tables (default: all)")->check(CLI::IsMember(known));
    app.add_option("--volume", options.volume,
                   "With render, refined and growth: only volumes, or inputs, whose name contains this text");
    app.add_flag("--json", options.json, "Print JSON with stable keys");
    app.callback([&] { measure(options); });
    return parseAndRun(app, argc, argv);
} catch (const std::exception& error) { // of the lines before parseAndRun(), which reports what it runs
    std::fprintf(stderr, "tessera bench: internal error: %s\n", error.what());
    return 3;
}
