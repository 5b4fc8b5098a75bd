#include "bench/data/bench_archives.h"
#include "bench/data/enlarged_cell.h"
#include "bench/pictures/timed_workbench.h"
#include "codec/pack/pack.h"

#include <chrono>
#include <fstream>
#include <unistd.h>

/// A full model of 250x250x1000 samples: from opening the archive to interaction.
namespace tessera::app {

namespace {

/// Resident memory of the process in MB.
double residentMegabytes() {
    std::ifstream file("/proc/self/statm");
    double all = 0, resident = 0;
    file >> all >> resident;
    return resident * double(::sysconf(_SC_PAGESIZE)) / 1e6;
}

} // namespace

BenchTable benchLarge() {
    BenchTable table{"full model, 250x250x1000 samples from an archive", {"what", "value"}, {}};
    const BenchFile archive;
    {
        volume::Dataset cell = enlargedCell({250, 250, 1000}, 1, 0.001);
        const codec::PackSummary packed = codec::pack(cell, {}, archive.path, {});
        table.rows.push_back({"source, MB", decimals(double(packed.sourceBytes) / 1e6, 0)});
        table.rows.push_back({"archive, MB", decimals(double(packed.archiveBytes) / 1e6, 0)});
    }
    TimedWorkbench timed;
    const double before = residentMegabytes();
    const auto begin = std::chrono::steady_clock::now();
    timed.workbench().install(open({.paths = {archive.path}, .layout = "overview", .data = {}, .import = {}}));
    const double opened = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    table.rows.push_back({"opened, ms", decimals(opened, 0)});
    const std::map<std::string, double> shown = timed.untilShown();
    for (const auto& [pane, milliseconds] : shown)
        table.rows.push_back({"first picture of " + pane + ", ms", decimals(opened + milliseconds, 0)});
    table.rows.push_back({"everything refined, s", decimals(timed.untilRest() / 1e3, 1)});
    const Followed camera = timed.drag([](Session& session, double) {
        vis::orbit(session.camera, {0, 0}, {0.05f, 0});
    });
    table.rows.push_back({"camera dragged, ms until every view shows it", decimals(median(camera.all), 0)});
    const volume::Box box = timed.workbench().source()->info().bounds;
    const Followed cursor =
        timed.drag([&](Session& session, double share) { session.cursor = box.lo + box.size() * (0.3 + 0.4 * share); });
    table.rows.push_back({"cursor dragged, ms until every view shows it", decimals(median(cursor.all), 0)});
    for (const auto& [pane, milliseconds] : cursor.shown)
        table.rows.push_back({"cursor dragged, ms until shown by " + pane, decimals(median(milliseconds), 0)});
    const vis::ResidencyInfo held = timed.workbench().renderer()->residency();
    table.rows.push_back({"textures, MB of budget", decimals(double(held.textureBytes) / 1e6, 0) + " of " +
                                                        decimals(double(held.textureBudget) / 1e6, 0)});
    table.rows.push_back({"decoded bricks, MB of budget", decimals(double(held.memoryBytes) / 1e6, 0) + " of " +
                                                              decimals(double(held.memoryBudget) / 1e6, 0)});
    table.rows.push_back({"memory more than before, MB", decimals(residentMegabytes() - before, 0)});
    return table;
}

} // namespace tessera::app
