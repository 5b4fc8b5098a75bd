#include "codec/pack/pack.h"
#include "app/command/command.h"
#include "app/data/import_options.h"
#include "app/data/open.h"
#include "app/described/describe_cli.h"
#include "app/growing/follow.h"
#include "app/growing/frame_stream.h"
#include "app/user_files/import_memory.h"
#include "codec/blocks/join.h"
#include "codec/blocks/pack_blocks.h"
#include "codec/container/exactness.h"
#include "codec/container/json_text.h"
#include "codec/remote/address.h"
#include "codec/unpack/unpack.h"
#include "volume/base/byte_text.h"
#include "volume/base/terminal.h"
#include "volume/import/files/series.h"
#include "volume/system/free_memory.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sys/resource.h>

namespace tessera::app {

namespace {

struct PackRequest {
    std::vector<std::string> inputs;
    std::string output;
    volume::ImportOptions import;
    codec::PackOptions options;
    bool append = false, json = false, progressJson = false;
    bool keepsLattice = false; ///< of an archive, where none is stated
    bool follows = false;
    ArrivalTimes arrival;
    std::optional<double> untilIdle;
    double timeStep = 1;
    bool timesGiven = false;
    std::optional<std::size_t> blockTimes;
    bool blockParameters = false, blockSlabs = false, alone = false;
};

codec::StoredLattice storedLattice(const std::string& path) {
    const codec::Archive archive(path);
    if (archive.metadata().alternating) return codec::StoredLattice::D4;
    return archive.info().lattice.kind == volume::LatticeKind::BCC ? codec::StoredLattice::BCC
                                                                   : codec::StoredLattice::CC;
}

/// The lattice of the archive to write, or of an existing one.
codec::StoredLattice latticeOf(const PackRequest& request) {
    return request.append ? storedLattice(request.output) : request.options.lattice;
}

struct PackInput {
    volume::Dataset data;
    codec::PackedBefore before;
    volume::ImportOptions import = {}; ///< stated, and remembered
};

PackInput open(const PackRequest& request, const Progress& progress) {
    if (request.inputs.size() == 1 && namesModel(request.inputs[0]))
        return {modelNamed(request.inputs[0], request.import, progress), {}};
    if (request.inputs.size() == 1 && codec::namesArchive(request.inputs[0])) {
        const auto archive = std::make_shared<const codec::Archive>(request.inputs[0]);
        const bool asGrid = latticeOf(request) != codec::StoredLattice::BCC || archive->metadata().alternating;
        const bool asStored =
            !asGrid || (archive->info().lattice.kind == volume::LatticeKind::CC && !archive->metadata().alternating);
        const codec::PackedBefore before = codec::packedBefore(archive);
        return {asStored ? codec::storedDataset(archive) : codec::gridDataset(archive, 0), before};
    }
    requireData(request.inputs);
    const volume::ImportOptions options = recallOptions(request.inputs, request.import, progress);
    sayRemembered(request.import, options);
    volume::Dataset data = volume::openFiles(request.inputs, options, progress, false);
    rememberStated(request.import, data.info.name);
    return {std::move(data), {}, options};
}

void checkOutput(const PackRequest& request) {
    std::error_code ignored;
    for (const std::string& input : request.inputs)
        if (std::filesystem::equivalent(input, request.output, ignored))
            throw Error("the output would replace an input", request.output);
    if (!request.append) return;
    codec::PackOptions given = request.options;
    given.memoryMb = 0;
    if (given != codec::PackOptions())
        throw Error("--append uses the options that the archive was packed with; only --memory can be given",
                    request.output);
    if (!std::filesystem::exists(request.output, ignored))
        throw Error("there is no archive to append to", request.output);
}

/// Makes the heap return frames to the system as soon as they are freed, so that its reserve does not exceed the memory
/// plan. Only used where memory is limited: the extra page faults make packing up to twice as slow.
void keepNoFreedFrames() {
    constexpr std::size_t kLargest = 4 << 20, kMost = 1 << 17; // the heap keeps smaller buffers, such as bricks
    volume::keepFreeMemory(kMost, kLargest);
}

/// Peak memory of this process, including mapped files.
std::uint64_t peakMemory() {
    rusage usage{};
    constexpr std::uint64_t kKibi = 1024;
    return ::getrusage(RUSAGE_SELF, &usage) == 0 ? std::uint64_t(usage.ru_maxrss) * kKibi : 0;
}

std::string exactnessOf(const std::string& path) {
    return codec::exactnessText(codec::Archive(path).metadata());
}

nlohmann::json reportOf(const codec::PackSummary& summary, const std::string& path) {
    const auto stage = [](const char* name, double seconds, std::uint64_t bytes) {
        return nlohmann::json{{"name", name}, {"seconds", seconds}, {"bytes", bytes}};
    };
    return {{"file", path},
            {"sourceBytes", summary.sourceBytes},
            {"sourceSamples", summary.sourceSamples},
            {"storedSamples", summary.storedSamples},
            {"archiveBytes", summary.archiveBytes},
            {"addedBytes", summary.addedBytes},
            {"maxError", summary.maxError},
            {"exactness", exactnessOf(path)},
            {"bricks", summary.bricks},
            {"discardedBricks", summary.discardedBricks},
            {"weakenedBricks", summary.weakenedBricks},
            {"repeatedBricks", summary.repeatedBricks},
            {"repeatedBytes", summary.repeatedBytes},
            {"notes", summary.notes},
            {"seconds", summary.seconds},
            {"waitSeconds", summary.waitSeconds},
            {"trials", summary.trials},
            {"peakMemory", peakMemory()},
            {"stages",
             {stage("read", summary.loadSeconds, summary.sourceBytes),
              stage("resample", summary.resampleSeconds, summary.storedBytes),
              stage("code", summary.codeSeconds, summary.addedBytes),
              stage("write", summary.writeSeconds, summary.addedBytes)}}};
}

/// Whether the input is frames on standard input.
bool isStream(const PackRequest& request) {
    return std::ranges::find(request.inputs, "-") != request.inputs.end();
}

/// The inputs that grow while they are packed.
void runGrowing(const PackRequest& request) {
    const GrowingRequest archive{request.output, request.import, request.options, request.json};
    if (request.follows) {
        if (request.inputs.size() > 1)
            throw Error("--follow needs one pattern in quotes, such as 'run_*.vti'", request.inputs[1]);
        return follow({request.inputs[0], archive, request.arrival, request.untilIdle});
    }
    if (request.inputs.size() > 1) throw Error("frames on standard input (-) are packed alone", request.inputs[1]);
    if (request.progressJson) throw Error("nobody knows how many frames will come", {}, "--progress-json");
    packStream({archive, request.append, request.timeStep, request.timesGiven});
}

void sayNotes(const codec::PackSummary& summary) {
    for (const std::string& note : summary.notes) warn("tessera: %s\n", note.c_str());
}

/// Packs in blocks of times, which processes share.
void runBlocks(const PackRequest& request, const Launched& started, const PackInput& input, const Progress& progress) {
    const volume::DatasetInfo& info = input.data.info;
    const std::size_t times = info.times.size(), parameters = info.parameters.size();
    const auto processes = request.blockTimes || request.blockSlabs ? 0 : std::size_t(started.count); // to be occupied
    const bool byParameter = (request.blockParameters || processes > times) && parameters > 1;
    const bool bySlab = request.blockSlabs || (processes > times * parameters && input.data.read.inParts() &&
                                               !codec::hasThreshold(request.options));
    const codec::BlockSummary summary = codec::packInBlocks(
        input.data, request.options, request.output,
        {request.blockTimes.value_or(0), started, inputsOf(request.inputs, input.import), byParameter, bySlab},
        progress, input.before);
    if (request.json || request.progressJson) {
        nlohmann::json report = reportOf(summary.own, request.output);
        report.update({{"blocks", summary.blocks}, {"ownBlocks", summary.packed}, {"rank", started.rank}});
        sayJson(jsonText(report, request.progressJson ? -1 : 1));
        return;
    }
    sayNotes(summary.own);
    std::string text = std::to_string(summary.packed) + " of " + std::to_string(summary.blocks) + " blocks packed" +
                       byProcess(started);
    text += ", " + textOfBytes(double(summary.own.sourceBytes));
    if (summary.last)
        text += "; " + request.output + ": " + textOfBytes(double(summary.own.archiveBytes)) + ", " +
                exactnessOf(request.output);
    say("%s\n", text.c_str());
}

/// Prints what was packed.
void sayPacked(const PackRequest& request, const codec::PackSummary& summary) {
    if (request.json || request.progressJson) {
        sayJson(jsonText(reportOf(summary, request.output), request.progressJson ? -1 : 1));
        return;
    }
    sayNotes(summary);
    if (summary.discardedBricks > 0)
        say("%llu of %llu bricks are less important than the limit and are left out\n",
            static_cast<unsigned long long>(summary.discardedBricks), static_cast<unsigned long long>(summary.bricks));
    if (summary.repeatedBricks > 0)
        say("%llu bricks equal those of the time before, which saves %s\n",
            static_cast<unsigned long long>(summary.repeatedBricks),
            textOfBytes(double(summary.repeatedBytes)).c_str());
    const double source = double(summary.sourceBytes), stored = double(summary.archiveBytes);
    if (request.append) {
        say("%s: now %s, %s of it from %s, %.2f s (%s/s)\n", request.output.c_str(), textOfBytes(stored).c_str(),
            textOfBytes(double(summary.addedBytes)).c_str(), textOfBytes(source).c_str(), summary.seconds,
            textOfBytes(source / summary.seconds).c_str());
        return;
    }
    say("%s: %s from %s (%.2f : 1), %.1f %% of the samples, %.2f s (%s/s)\n", request.output.c_str(),
        textOfBytes(stored).c_str(), textOfBytes(source).c_str(), source / stored,
        100.0 * double(summary.storedSamples) / double(summary.sourceSamples), summary.seconds,
        textOfBytes(source / summary.seconds).c_str());
    say("%s\n", exactnessOf(request.output).c_str());
}

/// Whether an archive is appended to one that was packed alike: then nothing is coded again.
bool joins(const PackRequest& request) {
    return request.append && request.inputs.size() == 1 && codec::namesArchive(request.inputs[0]) &&
           !codec::isRemote(request.inputs[0]) && codec::canJoin(request.output, request.inputs[0]);
}

void run(PackRequest request) {
    if (!codec::namesArchive(request.output)) throw Error("the name of an archive ends with .tsr", request.output);
    const bool whole = !request.append && !request.follows && !isStream(request);
    const char* const blocks = request.blockTimes        ? "--block-times"
                               : request.blockParameters ? "--block-parameters"
                               : request.blockSlabs      ? "--block-slabs"
                                                         : nullptr;
    if (blocks && !whole) throw Error("blocks are those of a whole series, without --append and --follow", {}, blocks);
    if (!request.follows) checkOutput(request);
    if (request.options.memoryMb > 0) keepNoFreedFrames();
    if (request.follows || isStream(request)) return runGrowing(request);
    if (request.timesGiven || request.timeStep != 1)
        throw Error("is for frames on standard input (IN is -); state the times of files by --times", {},
                    request.timesGiven ? "--times-given" : "--time-step");
    if (request.keepsLattice) request.options.lattice = storedLattice(request.inputs[0]);
    const Progress terminal = terminalProgress("pack");
    const Progress progress = request.progressJson ? jsonProgress(terminal) : terminal;
    if (joins(request)) return sayPacked(request, codec::join(request.output, request.inputs[0]));
    PackInput input = open(request, progress.part(0, 0.02));
    const Progress rest = progress.part(0.02, 1);
    const Launched started = launched();
    if (whole && !request.alone && (started.count > 1 || blocks)) return runBlocks(request, started, input, rest);
    sayPacked(request, request.append
                           ? codec::append(input.data, request.output, request.options.memoryMb, rest, input.before)
                           : codec::pack(input.data, request.options, request.output, rest, input.before));
}

/// Throws where samples are asked for bit for bit, and an error bound too.
void refuseContradiction(const CLI::App& command, const codec::PackOptions& options) {
    const CLI::Option& lossless = *command.get_option("--lossless");
    if (lossless.count() == 0 || !lossless.as<bool>()) return;
    if (options.maxError > 0 || options.absError > 0 || options.psnr > 0 || options.sizeMb > 0)
        throw Error("contradicts a bound on the error or the size (--max-error, --abs-error, --psnr, --target-size, or "
                    "that of a preset)",
                    {}, "--lossless");
}

/// Whether the lattice of the archive is stated, by itself or by a preset.
bool statesLattice(const CLI::App& command) {
    const CLI::Option& preset = *command.get_option("--preset");
    return command.count("--lattice") > 0 ||
           (preset.count() > 0 && codec::PackOptions::presetHasLattice(preset.results().back()));
}

void addFollowOptions(CLI::App& command, PackRequest& request) {
    CLI::Option* const follow =
        command
            .add_flag("--follow", request.follows,
                      "Append files as another program writes them: IN is a pattern in quotes ('run_*.vti'), each file "
                      "that fits a later time, in the order of the numbers. Prints a line for each time; ends by "
                      "Ctrl-C or --until-idle; the same command again continues the archive")
            ->excludes("--append")
            ->excludes("--progress-json")
            ->group("Follow");
    command.add_option("--until-idle", request.untilIdle, "End after so many seconds without a new file")
        ->check(CLI::NonNegativeNumber)
        ->needs(follow)
        ->group("Follow");
    const auto seconds = [&](const char* name, ArrivalTimes::Duration& value, const char* help) {
        command
            .add_option_function<double>(
                name, [&value](double given) { value = ArrivalTimes::Duration(given); }, help)
            ->check(CLI::NonNegativeNumber)
            ->default_str(std::to_string(std::lround(value.count())))
            ->needs(follow)
            ->group("Follow");
    };
    seconds("--settle", request.arrival.settle, "A file is read once it has not changed for so many seconds");
    seconds("--retry", request.arrival.retry,
            "A file that cannot be read is tried again for so many seconds before later ones go ahead");
}

void addBlocksOption(CLI::App& command, PackRequest& request) {
    command
        .add_option("--block-times", request.blockTimes,
                    "Pack in blocks of so many times, which several processes share that are started alike (mpirun, "
                    "srun, or by hand on machines that see the same folder), and which are joined to one archive. "
                    "Processes of mpirun or srun do so by themselves, in blocks of 16 times, or fewer so that each has "
                    "one")
        ->check(CLI::Range(1, 1000000))
        ->group("Several processes");
    command
        .add_flag("--block-parameters", request.blockParameters,
                  "Pack each parameter of a block by itself, so that processes also share a time; so by itself where "
                  "mpirun or srun starts more processes than there are times, unless --block-times is stated")
        ->group("Several processes");
    command
        .add_flag("--block-slabs", request.blockSlabs,
                  "Pack each parameter of a time by all processes together, which share its layers of bricks; so by "
                  "itself where mpirun or srun starts more processes than there are parameters at all times, unless "
                  "--block-times is stated. For raw files, uncompressed NRRD files, and archives on their lattice")
        ->group("Several processes");
    addAloneOption(command, request.alone);
    for (const char* const shared : {"--block-times", "--block-parameters", "--block-slabs"})
        command.get_option("--alone")->excludes(shared)->group("Several processes");
}

void addStreamOptions(CLI::App& command, PackRequest& request) {
    CLI::Option* const step = command
                                  .add_option("--time-step", request.timeStep,
                                              "Time from one frame on standard input to the next (default: 1); the "
                                              "first one is at 0, or follows those "
                                              "of the archive")
                                  ->check(CLI::PositiveNumber)
                                  ->group("Standard input");
    command
        .add_flag("--times-given", request.timesGiven,
                  "Each frame on standard input begins with its time, a 64-bit floating-point number")
        ->excludes(step)
        ->excludes("--follow")
        ->group("Standard input");
    step->excludes("--follow");
}

} // namespace

void addPackCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("pack", "Import, brick and compress data into one archive");
    const auto request = std::make_shared<PackRequest>();
    command
        ->add_option(
            "IN", request->inputs,
            "Data files that belong together (parameters, times), a built-in model, or - for frames of raw samples "
            "on standard input, each a later time, of the layout that --raw states")
        ->required();
    command->add_option("-o,--output", request->output, "Archive to write (.tsr)")->required();
    command->add_flag("--append", request->append,
                      "Append to the archive: later times, or further parameters at all its times, with the options it "
                      "was packed with; the archive stays readable meanwhile, even after a crash");
    command->add_flag("--json", request->json, "Print the summary as JSON");
    command->add_flag("--progress-json", request->progressJson, "Print progress and summary as JSON lines");
    addFollowOptions(*command, *request);
    addStreamOptions(*command, *request);
    addBlocksOption(*command, *request);
    addDescribed(*command, request->options);
    addImportOptions(*command, request->import);
    command->callback([request, command] {
        refuseContradiction(*command, request->options);
        const bool again = request->inputs.size() == 1 && codec::namesArchive(request->inputs[0]);
        request->keepsLattice = again && !request->append && !statesLattice(*command);
        run(*request);
    });
}

void addConvertCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "convert", "Pack an archive again, with other options or in the newest version of the format");
    const auto request = std::make_shared<PackRequest>();
    command->add_option("IN", request->inputs, "Archive (.tsr); new errors add to those it has")
        ->required()
        ->expected(1);
    command->add_option("-o,--output", request->output, "Archive to write (.tsr)")->required();
    command->add_flag("--json", request->json, "Print the summary as JSON");
    command->add_flag("--progress-json", request->progressJson, "Print progress and summary as JSON lines");
    addBlocksOption(*command, *request);
    addDescribed(*command, request->options);
    command->callback([request, command] {
        if (!codec::namesArchive(request->inputs[0])) throw Error("not an archive (.tsr)", request->inputs[0]);
        refuseContradiction(*command, request->options);
        request->keepsLattice = !statesLattice(*command);
        run(*request);
    });
}

} // namespace tessera::app
