#include "bench/bench.h"
#include "bench/growth/made_inputs.h"
#include "bench/growth/run_command.h"

#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>

/// How the cost of commands grows with their input.
namespace tessera::app {

namespace {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;
constexpr int kPackMemoryMb = 500;

/// A kind of input that comes in several sizes, and what is measured of it.
struct Growing {
    const char* what;                                                  ///< in which unit sizes are
    std::vector<double> sizes;                                         ///< rising
    std::function<Words(const std::string& folder, double size)> make; ///< writes it; the words that open it
    std::vector<std::string> commands;
};

/// The words of one command.
Words wordsOf(const std::string& command, const Words& input, const BenchFolder& folder) {
    Words words{programUnderTest(), command};
    words.insert(words.end(), input.begin(), input.end());
    if (command == "stats") words.emplace_back("--all-times");
    if (command == "pack")
        words.insert(words.end(), {"-o", folder.file("out.tsr"), "--memory", std::to_string(kPackMemoryMb)});
    if (command == "render")
        words.insert(words.end(), {"-o", folder.file("out.png"), "--view", "volume", "--size", "512x512"});
    return words;
}

/// The exponent between two sizes: 1 is linear.
std::string exponent(double size, double cost, double formerSize, double formerCost) {
    return decimals(std::log(cost / formerCost) / std::log(size / formerSize), 2);
}

/// Costs are measured again where they are small, and the least counts.
CommandCost leastCost(const Words& words, const std::string& home) {
    constexpr double kSmall = 1; // s
    constexpr int kRuns = 3;
    CommandCost least = runCommand(words, home);
    for (int run = 1; run < kRuns && least.done && least.processor < kSmall; ++run) {
        const CommandCost again = runCommand(words, home);
        if (again.done && again.processor < least.processor) least = again;
    }
    return least;
}

void measure(const Growing& growing, BenchTable& table) {
    std::vector<std::optional<CommandCost>> former(growing.commands.size());
    double formerSize = 0;
    for (const double size : growing.sizes) {
        const BenchFolder folder;
        const Words input = growing.make(folder.path(), size);
        for (std::size_t c = 0; c < growing.commands.size(); ++c) {
            const CommandCost cost = leastCost(wordsOf(growing.commands[c], input, folder), folder.file("home"));
            std::vector<std::string> row{growing.what, decimals(size, 0), growing.commands[c]};
            if (!cost.done) {
                row.insert(row.end(), {"-", "-", "-", "-", cost.lastWords});
                former[c].reset();
                table.rows.push_back(std::move(row));
                continue;
            }
            row.insert(row.end(), {decimals(cost.processor, 3), decimals(cost.megabytes, 0)});
            if (former[c])
                row.insert(row.end(), {exponent(size, cost.processor, formerSize, former[c]->processor),
                                       exponent(size, cost.megabytes, formerSize, former[c]->megabytes), ""});
            else
                row.insert(row.end(), {"", "", ""});
            former[c] = cost;
            table.rows.push_back(std::move(row));
        }
        formerSize = size;
    }
}

/// What opens a path alone.
auto alone(std::string (*make)(const std::string&, int)) {
    return [make](const std::string& folder, double size) { return Words{make(folder, int(size))}; };
}

std::vector<Growing> allGrowing() {
    const std::vector<std::string> all{"info", "stats", "pack", "render"};
    const auto megabytes = [](std::string (*make)(const std::string&, double)) {
        return [make](const std::string& folder, double size) { return Words{make(folder, size * 1e6)}; };
    };
    const auto besideSeries = [](const std::string& folder, double columns) {
        constexpr int kTimes = 100;
        return Words{makeRawSeries(folder, kTimes), "--over-time", makeTimeTable(folder, int(columns), kTimes)};
    };
    return {{"raw file, MB", {1, 10, 100, 1000}, megabytes(makeRawFile), all},
            {"sparse raw file, MB", {100, 1000, 8000}, megabytes(makeSparseFile), {"info", "pack"}},
            {"series of raw files", {10, 100, 1000, 10000}, alone(makeRawSeries), all},
            {"series of VTK images", {10, 100, 1000, 10000}, alone(makeImageSeries), all},
            {"parameters", {1, 10, 100, 1000}, alone(makeParameters), all},
            {"rows of a table", {1e4, 1e5, 1e6, 1e7}, alone(makeTable), all},
            {"columns of a table", {10, 100, 1000}, alone(makeWideTable), all},
            {"times in names of columns", {20, 200, 2000}, alone(makeSweptTable), {"info", "stats", "pack"}},
            {"quantities over time", {20, 200, 2000}, besideSeries, {"info", "stats", "pack"}},
            {"cells of a mesh", {1e4, 1e5, 1e6}, alone(makeMesh), all}};
}

} // namespace

BenchTable benchGrowth(const std::string& only) {
    BenchTable table;
    table.name = "growth: processor seconds and most memory of commands, and the exponents from the size before";
    table.columns = {"input", "size", "command", "s", "MB", "exponent of s", "of MB", "failure"};
    for (const Growing& growing : allGrowing())
        if (std::string_view(growing.what).find(only) != std::string_view::npos) measure(growing, table);
    return table;
}

} // namespace tessera::app
