#include "bench/bench.h"
#include "bench/growth/run_command.h"
#include "bench/growth/watched_screen.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cstdio>
#include <functional>

/// From a command to its answer, or to the picture of its window.
namespace tessera::app {

namespace {

constexpr int kStarts = 10;

double middle(std::vector<double> values) {
    std::ranges::sort(values);
    return values.empty() ? 0 : values[values.size() / 2];
}

/// Runs `once` with the files of a user who has never started the program, or with those of the start before.
void repeat(bool cold, const std::function<void(const std::string& home)>& once) {
    const BenchFolder warm;
    if (!cold) once(warm.file("home")); // fills the caches; counted by no one, since the caller starts after it
    for (int start = 0; start < kStarts; ++start) {
        const BenchFolder fresh;
        once(cold ? fresh.file("home") : warm.file("home"));
    }
}

std::vector<std::string> row(const std::string& what, bool cold, const std::vector<Moment>& moments) {
    std::vector<double> passed, processor;
    for (const Moment& each : moments) {
        passed.push_back(1000 * each.passed);
        processor.push_back(1000 * each.processor);
    }
    const auto least = [](const std::vector<double>& values) { return values.empty() ? 0 : std::ranges::min(values); };
    return {what,
            cold ? "cold" : "warm",
            decimals(middle(passed), 0),
            decimals(least(passed), 0),
            decimals(middle(processor), 0),
            decimals(least(processor), 0)};
}

void measureWindow(const std::string& name, const std::vector<std::string>& words, const WatchedScreen& screen,
                   BenchTable& table) {
    for (const bool cold : {true, false}) {
        std::vector<Moment> window, picture, rest;
        repeat(cold, [&](const std::string& home) {
            const WatchedStart start = screen.watch(words, home);
            if (!start.shown) throw MachineError("has shown nothing", name);
            window.push_back(start.window);
            picture.push_back(start.picture);
            rest.push_back(start.rest);
        });
        if (!cold)
            for (std::vector<Moment>* each : {&window, &picture, &rest}) each->erase(each->begin());
        table.rows.push_back(row(name + ": window", cold, window));
        table.rows.push_back(row(name + ": picture", cold, picture));
        table.rows.push_back(row(name + ": at rest", cold, rest));
    }
}

void measureCommand(const std::string& name, const std::vector<std::string>& words, BenchTable& table) {
    for (const bool cold : {true, false}) {
        std::vector<Moment> done;
        repeat(cold, [&](const std::string& home) {
            const CommandCost cost = runCommand(words, home);
            if (!cost.done) throw MachineError(cost.lastWords, name);
            done.push_back({cost.passed, cost.processor});
        });
        if (!cold) done.erase(done.begin());
        table.rows.push_back(row(name, cold, done));
    }
}

} // namespace

BenchTable benchStart() {
    BenchTable table;
    table.name = "start: milliseconds from the command, and of the processor, of ten starts";
    table.columns = {"what", "files of the user", "median", "least", "processor", "its least"};
    const BenchFolder data;
    const std::string tessera = programUnderTest(), archive = data.file("cell.tsr"), image = data.file("cell.vti");
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{tessera, "generate", "fuel-cell", "-o", archive},
          std::vector<std::string>{tessera, "generate", "fuel-cell", "--even", "--times", "1", "-o", image}})
        if (const CommandCost cost = runCommand(words, data.file("home")); !cost.done)
            throw Error(cost.lastWords, words[1]);
    measureCommand("tessera --version", {tessera, "--version"}, table);
    measureCommand("tessera info, archive", {tessera, "info", archive}, table);
    measureCommand("tessera info, built-in cell", {tessera, "info", "fuel-cell"}, table);
    if (!WatchedScreen::isAvailable()) {
        std::fprintf(stderr, "bench: no windows are measured without Xvfb\n");
        return table;
    }
    const WatchedScreen screen;
    measureWindow("tessera, built-in cell", {tessera}, screen, table);
    measureWindow("tessera, archive", {tessera, archive}, screen, table);
    if (const std::string peer = programOnPath("f3d"); !peer.empty())
        measureWindow("f3d, the same cell as an image", {peer, "--volume", image}, screen, table);
    return table;
}

} // namespace tessera::app
