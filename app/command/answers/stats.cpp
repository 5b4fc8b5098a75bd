#include "app/command/answers/stats_answer.h"
#include "app/command/command.h"
#include "app/command/derive_option.h"
#include "app/data/format.h"
#include "app/data/import_options.h"
#include "app/data/open.h"
#include "app/described/describe_cli.h"
#include "app/pages/plot_page.h"
#include "app/ui/ticks.h"
#include "app/user_files/import_memory.h"
#include "codec/blocks/share_results.h"
#include "codec/container/json_text.h"
#include "volume/base/error.h"
#include "volume/base/terminal.h"
#include "volume/system/atomic_file.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

namespace tessera::app {

namespace {

bool isFigure(const std::string& path) {
    return hasEnding(path, ".svg") || hasEnding(path, ".pdf");
}

DataRef measuredData(const StatsRequest& request, const Progress& progress) {
    DataRef data = dataNamed(request.inputs, request.import, progress);
    data.lattice = PictureLattice::Grid; // nothing is drawn, so no resampling for pictures
    data.derived = request.derived;
    data.remote = request.remote;
    return data;
}

Sources openInput(const DataRef& data, const Progress& progress) {
    std::vector<std::string> messages;
    Sources sources = openSources(data, messages, progress);
    checkDerived(data.derived, volume::underived(sources.numbers)->info());
    for (const std::string& message : messages) warn("tessera: %s\n", message.c_str());
    return sources;
}

std::string stateOf(const Question& question) {
    const glm::ivec3 size = question.source->grid().lattice.size;
    return question.info().name + ", " + std::to_string(size.x) + " x " + std::to_string(size.y) + " x " +
           std::to_string(size.z) + " samples, numbers " + question.origin();
}

/// Throws Error for an option, by name, that would change nothing.
void checkUsed(const StatsRequest& request) {
    const StatsOptions& options = request.options;
    const auto refuse = [&](const char* option, bool unused, const char* reason) {
        if (unused && std::ranges::count(request.given, option) > 0) throw Error(reason, {}, option);
    };
    refuse("--time", options.allTimes, "with --all-times there is no single time");
    refuse("--along", !options.line.empty(), "with --line the planes lie across that: give one of the two");
    refuse("--planes", options.line.empty(), "counts the planes of --line; those of --along are the grid's");
    for (const char* option : {"--show", "--weight"})
        refuse(option, !options.planesAcross(), "is of averages over planes, with --along or --line");
}

void check(const StatsRequest& request) {
    checkUsed(request);
    const StatsOptions& options = request.options;
    const bool sections = options.planesAcross();
    if (!request.output.empty() && !isFigure(request.output) && !hasEnding(request.output, ".csv") &&
        !hasEnding(request.output, ".json"))
        throw Error("statistics are written as .csv, .svg, .pdf or .json", request.output);
    if (!request.output.empty()) requireFolderOf(request.output);
    if (sections && !options.balance.empty())
        throw Error("balances are of whole regions: omit --along and --line", "--balance");
}

std::string jsonOf(const Question& question, const Answer& answer) {
    return jsonText({{"kind", "statistics"},
                     {"data", question.info().name},
                     {"samples", stateOf(question)},
                     {"lengthUnit", question.info().lengthUnit},
                     {"timeUnit", question.info().timeUnit},
                     {"units", answer.units},
                     {"notes", answer.notes},
                     {"rows", answer.json}},
                    1) +
           "\n";
}

std::string figureFile(const StatsRequest& request, const Question& question, const std::vector<Plot>& panels) {
    VectorPage drawing = plotPage(panels, 2, {});
    drawing.numbers = question.origin();
    return fileOf(drawing, hasEnding(request.output, ".pdf") ? "pdf" : "svg");
}

/// Writes the answer for all requested times to the file asked for, if any.
void write(const StatsRequest& request, const Question& question, const Answer& answer) {
    const std::string& path = request.output;
    if (path.empty() || (isFigure(path) && request.options.planesAcross()))
        return; // that is drawn for all times at once
    const std::string line = "# numbers: " + question.origin() + "\n";
    const auto figure = [&] { return figureFile(request, question, figureOf(question, answer.json)); };
    writeAtomically(path, isFigure(path)            ? figure()
                          : hasEnding(path, ".csv") ? line + answer.csv
                                                    : jsonOf(question, answer));
}

void print(const StatsRequest& request, const Question& question, const Answer& answer) {
    if (request.options.json) {
        std::fputs(jsonOf(question, answer).c_str(), stdout);
    } else if (request.output.empty()) {
        say("%s\n%s", stateOf(question).c_str(), answer.text.c_str());
        for (const std::string& note : answer.notes) say("  %s\n", note.c_str());
    }
}

void run(const StatsRequest& request) {
    check(request);
    const Progress progress = terminalProgress("stats");
    const DataRef data = measuredData(request, progress.part(0, 0.1));
    const Question question = questionOf(request, openInput(data, progress.part(0.1, 0.3)));
    rememberStated(request.import, question.info().name);
    const Progress rest = progress.part(0.3, 1);
    if (isFigure(request.output) && request.options.planesAcross()) {
        writeAtomically(request.output, figureFile(request, question, sectionFigure(request, question, rest)));
        if (!request.options.json) return progress.advance(1);
    }
    if (question.times.size() == 1) {
        const Answer answer = answerAt(request, question, question.times.front(), true, rest);
        write(request, question, answer);
        progress.advance(1);
        return print(request, question, answer);
    }
    const auto compute = [&](std::size_t t, const Progress& part) {
        return textOf(answerAt(request, question, question.times[t], t == 0, part));
    };
    Answer answer;
    const auto finish = [&](const std::vector<std::string>& texts, const Progress&) {
        for (const std::string& text : texts) addAnswer(answer, text);
        write(request, question, answer);
    };
    // Numbers that are only printed are given by every process.
    const std::optional<Launched> started = sharing(request.alone || request.output.empty());
    const std::string about = aboutText({{"data", toJson(data)}, {"options", toJson(request.options)}}, data);
    const codec::SharedResults done =
        codec::shareResults({request.output, about, started}, question.times.size(), compute, finish, rest);
    if (done.last) print(request, question, answer);
    if (!request.options.json) sayShare(done.own, question.times.size(), "times computed", started);
}

} // namespace

void addStatsCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("stats", "Statistics of every region: mean and standard deviation by "
                                                    "volume, volume; averages along an axis or line; balances. With "
                                                    "--all-times and -o, processes of mpirun or srun share the times");
    const auto request = std::make_shared<StatsRequest>();
    command->add_option("IN", request->inputs, "Archive, data files that belong together, or a built-in model")
        ->required();
    command->add_option("-o,--output", request->output, "File to write: .csv, .svg, .pdf or .json");
    addDescribed(*command, request->options);
    command->get_option("--time")->expected(1)->delimiter(',')->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    addDeriveOption(*command, request->derived);
    addImportOptions(*command, request->import);
    addRemoteOptions(*command, request->remote);
    addAloneOption(*command, request->alone);
    command->callback([request, command] {
        for (const CLI::Option* option : command->get_options())
            if (option->count() > 0) request->given.push_back(option->get_name());
        run(*request);
    });
}

} // namespace tessera::app
