#include "app/command/command.h"

#include "app/data/import_options.h"
#include "app/data/open.h"
#include "app/ui/ticks.h"
#include "app/user_files/machines.h"
#include "app/user_files/state_dir.h"
#include "codec/archive/archive.h"
#include "codec/container/json_text.h"
#include "codec/remote/consent.h"
#include "volume/base/error.h"
#include "volume/base/printable.h"
#include "volume/base/terminal.h"
#include "volume/import/files/named_files.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>
#include <unistd.h>

namespace tessera::app {

namespace {

volatile std::sig_atomic_t interrupted = 0;

} // namespace

std::optional<double> TimeLeft::after(double fraction) {
    const auto now = std::chrono::steady_clock::now();
    if (!begun_) begun_ = now;
    const double seconds = std::chrono::duration<double>(now - *begun_).count();
    // No estimate before this share of the job is done, or in the first second.
    constexpr double kSure = 0.02, kNotYet = 1;
    if (fraction < kSure || fraction >= 1 || seconds < kNotYet) return std::nullopt;
    return seconds * (1 - fraction) / fraction;
}

Progress terminalProgress(const std::string& title) {
    static std::stop_source source;
    static std::mutex mutex;
    source = std::stop_source();
    interrupted = 0;
    std::signal(SIGINT, [](int) { interrupted = 1; });
    const bool terminal = isatty(STDERR_FILENO) != 0;
    Progress progress;
    progress.stop = source.get_token();
    progress.report = [terminal, title, last = -1, left = TimeLeft()](double fraction,
                                                                      const std::string& what) mutable {
        if (interrupted != 0) {
            source.request_stop();
            throw Cancelled();
        }
        if (!terminal) return;
        const std::lock_guard lock(mutex);
        const std::optional<double> seconds = left.after(fraction);
        const int percent = static_cast<int>(fraction * 100);
        if (percent == last) return;
        last = percent;
        const std::string rest = seconds ? ", " + std::to_string(std::lround(*seconds)) + " s left" : "";
        const std::string line = printable(title + " " + std::to_string(percent) + " %" + rest + " " + what);
        std::fprintf(stderr, "\r\033[K%s%s", line.c_str(), percent >= 100 ? "\r\033[K" : "");
        std::fflush(stderr);
    };
    return progress;
}

int parseAndRun(CLI::App& app, int argc, const char* const* argv, const std::function<void()>& before) {
    const std::string named = app.get_name();
    const char* const name = named.c_str();
    std::signal(SIGXFSZ, SIG_IGN); // a limit of file sizes is an error of the write, not the end of the program
    try {
        if (before) before();
        try {
            app.parse(argc, argv);
        } catch (const CLI::ParseError& error) {
            std::ostringstream help, problem; // either is empty
            const bool failed = app.exit(error, help, problem) != 0;
            say("%s", help.str().c_str());
            warn("%s", problem.str().c_str());
            if (failed) return 1;
        }
        finishOutput();
        return 0;
    } catch (const Cancelled&) {
        warn("%s: cancelled\n", name);
        return 130;
    } catch (const MachineError& error) {
        warn("%s: %s\n", name, printable(error.what()).c_str());
        return 3;
    } catch (const Error& error) {
        warn("%s: %s\n", name, printable(error.what()).c_str());
        return 2;
    } catch (const std::system_error& error) { // e.g. permission denied, or no more threads
        warn("%s: %s\n", name, printable(error.what()).c_str());
        return 3;
    } catch (const std::bad_alloc&) {
        warn("%s: not enough memory\n", name);
        return 3;
    } catch (const std::exception& error) { // a fault of the program
        warn("%s: internal error: %s\n", name, error.what());
        return 3;
    }
}

namespace {

/// Files that others made may name any machine: only those are asked that the user names on the command line, and those
/// that he has opened something of before.
void askOnlyKnownMachines(const std::vector<std::string>& words) {
    codec::requireConsent([](const std::string& machine) { return isKnownMachine(stateFolder(), machine); });
    // A window that packs in this process as its child may have been allowed to ask just once.
    const bool byHand = std::ranges::find(words, "--progress-json") == words.end();
    if (std::ranges::any_of(words, codec::isRemote)) allowNamed(words, byHand ? stateFolder() : std::string());
}

} // namespace

int runCommandLine(int argc, const char* const* argv) {
    askOnlyKnownMachines({argv + std::min(argc, 1), argv + argc});
    CLI::App app{"Tessera: a workbench for simulations with many values per point", "tessera"};
    app.set_version_flag("--version", std::string("tessera ") + TESSERA_VERSION);
    app.require_subcommand(0, 1);
    addWorkbench(app);
    addBenchCommand(app);
    addConvertCommand(app);
    addCompareCommand(app);
    addDiffCommand(app);
    addGenerateCommand(app);
    addInfoCommand(app);
    addMeshCommand(app);
    addPackCommand(app);
    addPiecesCommand(app);
    addPlotCommand(app);
    addRenderCommand(app);
    addReplayCommand(app);
    addStatsCommand(app);
    addUnpackCommand(app);
    addVerifyCommand(app);
    return parseAndRun(app, argc, argv, [&] {
        // A mistyped command is parsed as a file, so that the error would be about its options instead.
        const auto isFirst = [&](const CLI::App* command) { return command->check_name(argv[1]); };
        if (argc > 1 && argv[1][0] != '-' && app.get_subcommands(isFirst).empty()) requireFile(argv[1]);
    });
}

void addAloneOption(CLI::App& command, bool& alone) {
    command.add_flag(
        "--alone", alone,
        "Do everything by this process; otherwise the processes that mpirun or srun started share the work");
}

std::optional<Launched> sharing(bool alone) {
    return alone ? std::nullopt : std::optional(launched());
}

namespace {

/// An archive on another machine, as it is now: another text once it has grown or been replaced.
std::string remoteState(const std::string& address, const codec::RemoteOptions& options) {
    return address + " " + std::to_string(codec::Archive(address, options).fingerprint()) + "\n";
}

} // namespace

std::string aboutText(nlohmann::json work, const DataRef& data) {
    std::vector<DataFile> files = data.files;
    if (data.other) files.insert(files.end(), data.other->files.begin(), data.other->files.end());
    for (const DataFile& file : files)
        if (codec::isRemote(file.absolutePath)) work["remote"].push_back(remoteState(file.absolutePath, data.remote));
    return jsonText(work);
}

std::string inputsOf(const std::vector<std::string>& inputs, const volume::ImportOptions& import) {
    std::string text;
    for (const std::string& argument : importArguments(import)) text += argument + "\n";
    if (namesModel(inputs[0])) return text;
    if (codec::isRemote(inputs[0])) return text + remoteState(inputs[0], {});
    const auto add = [&](const std::filesystem::path& path, const std::string& name) {
        std::error_code missing;
        if (!std::filesystem::is_regular_file(path, missing)) return; // a folder changes with each result written to it
        const auto bytes = std::filesystem::file_size(path, missing);
        const auto changed = std::filesystem::last_write_time(path, missing).time_since_epoch().count();
        text += name + " " + std::to_string(bytes) + " " + std::to_string(changed) + "\n";
    };
    for (const std::string& stated : {import.raw, import.overTime}) add(stated, stated);
    for (const std::string& input : inputs) {
        add(input, input);
        // As seen from the input, so that all may be moved together.
        const auto folder = std::filesystem::absolute(input).lexically_normal().parent_path();
        for (const std::filesystem::path other : volume::filesNamedBy(input))
            add(other, other.lexically_relative(folder).string());
    }
    return text;
}

double timeWithin(const volume::DatasetInfo& info, double time) {
    for (const double end : {info.times.front(), info.times.back()})
        if (formatNumber(time) == formatNumber(end)) return end;
    if (time > info.times.front() && time < info.times.back()) return time;
    throw Error("is not in " + formatNumber(info.times.front()) + " .. " + formatNumber(info.times.back()), "--time",
                formatNumber(time));
}

void requireFolderOf(const std::string& file) {
    const auto folder = std::filesystem::absolute(file).parent_path();
    if (!std::filesystem::is_directory(folder)) throw MachineError("no such folder", folder.string());
}

std::string byProcess(const std::optional<Launched>& started) {
    if (!started || started->count == 1) return {};
    return " by process " + std::to_string(started->rank + 1) + " of " + std::to_string(started->count);
}

void sayShare(std::size_t own, std::size_t all, const std::string& what, const std::optional<Launched>& started) {
    if (const std::string by = byProcess(started); !by.empty())
        say("%zu of %zu %s%s\n", own, all, what.c_str(), by.c_str());
}

Progress jsonProgress(const Progress& terminal) {
    Progress progress = terminal;
    progress.report = [inner = terminal.report, last = -1.0, left = TimeLeft()](double fraction,
                                                                                const std::string& what) mutable {
        if (inner) inner(fraction, what); // notices Ctrl-C
        const std::optional<double> seconds = left.after(fraction);
        if (fraction - last < 0.005 && fraction < 1) return;
        last = fraction;
        nlohmann::json line{{"fraction", fraction}, {"what", what}};
        if (seconds) line["secondsLeft"] = *seconds;
        sayJson(jsonText(line));
        std::fflush(stdout);
    };
    return progress;
}

} // namespace tessera::app
