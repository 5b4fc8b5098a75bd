#pragma once

#include "volume/base/progress.h"
#include "volume/system/launched.h"

#include <chrono>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}
namespace tessera::volume {
struct DatasetInfo;
struct ImportOptions;
}
namespace tessera::app {
struct DataRef;
}

/// The command line. Each subcommand is one file of app/command with one add function; its callback does the work and
/// throws: Error ends with status 2, MachineError with 3, also where standard output cannot take
/// what is printed, Cancelled with 130, wrong usage with 1.
namespace tessera::app {

void addBenchCommand(CLI::App& app);
void addConvertCommand(CLI::App& app);
void addCompareCommand(CLI::App& app);
void addDiffCommand(CLI::App& app);
void addGenerateCommand(CLI::App& app);
void addInfoCommand(CLI::App& app);
void addMeshCommand(CLI::App& app);
void addPackCommand(CLI::App& app);
void addPiecesCommand(CLI::App& app);
void addPlotCommand(CLI::App& app);
void addRenderCommand(CLI::App& app);
void addReplayCommand(CLI::App& app);
void addStatsCommand(CLI::App& app);
void addUnpackCommand(CLI::App& app);
void addVerifyCommand(CLI::App& app);
/// Without a subcommand: the workbench on FILE...
void addWorkbench(CLI::App& app);
/// Throws Error for an argument that is not a file. Without a dot or slash it may be a mistyped command: the message
/// then names the commands.
void requireFile(const std::string& word);

/// Adds --alone to a command whose work the processes of mpirun and srun can share; `alone` must outlive the
/// parsing.
void addAloneOption(CLI::App& command, bool& alone);
/// How the processes that share the work were started; nothing with --alone.
std::optional<Launched> sharing(bool alone);
/// " by process 2 of 4", "" for a process that was started alone.
std::string byProcess(const std::optional<Launched>& started);
/// Prints "3 of 9 pictures drawn by process 2 of 4"; nothing for a process that was started alone.
void sayShare(std::size_t own, std::size_t all, const std::string& what, const std::optional<Launched>& started);

/// What all processes that share a work on these data must have alike, for SharedWork::about; asks other machines for
/// the state of their archives.
std::string aboutText(nlohmann::json work, const DataRef& data);
/// What processes that pack these inputs must have alike: the files with all that they name, those that options name,
/// size and time of change of each (of an archive on another machine its state), and how they are read.
std::string inputsOf(const std::vector<std::string>& inputs, const volume::ImportOptions& import);
/// A time asked for by --time. One that reads as the first or the last one is that. Throws Error for one beyond.
double timeWithin(const volume::DatasetInfo& info, double time);
/// Throws MachineError where the folder of a file to write does not exist.
void requireFolderOf(const std::string& file);

/// Calls `before`, parses the arguments of a program and runs its callbacks; returns the exit status. Prints the reason
/// of a failure to stderr.
int parseAndRun(CLI::App& app, int argc, const char* const* argv, const std::function<void()>& before = {});
/// Parses the arguments of tessera and runs what they ask for; returns the exit status.
int runCommandLine(int argc, const char* const* argv);

/// Estimates the remaining time of a job from its progress so far.
class TimeLeft {
public:
    /// Remaining seconds; nothing until enough is done for an estimate. The clock starts at the first call.
    std::optional<double> after(double fraction);

private:
    std::optional<std::chrono::steady_clock::time_point> begun_;
};

/// Progress on the terminal: a line "title 42 %, 7 s left what" on stderr when it is a terminal, nothing otherwise.
/// Ctrl-C requests a stop through its token. Only one at a time.
Progress terminalProgress(const std::string& title);

/// The same as one JSON object per line on stdout, for a window that runs a command; `terminal` notices Ctrl-C.
Progress jsonProgress(const Progress& terminal);

} // namespace tessera::app
