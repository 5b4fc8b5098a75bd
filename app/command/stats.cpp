#include "app/command/command.h"
#include "app/command/derive_option.h"
#include "app/command/stats_answer.h"
#include "app/data/format.h"
#include "app/data/import_options.h"
#include "app/data/open.h"
#include "app/described/describe_cli.h"
#include "app/ui/ticks.h"
#include "app/user_files/import_memory.h"
#include "volume/base/error.h"
#include "volume/system/atomic_file.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

namespace tessera::app {

namespace {

Sources openInput(const StatsRequest& request, const Progress& progress) {
    DataRef data = dataNamed(request.inputs, request.import, progress.part(0, 0.2));
    data.lattice = PictureLattice::Grid; // nothing is drawn, so no resampling for pictures
    data.derived = request.derived;
    data.remote = request.remote;
    std::vector<std::string> messages;
    Sources sources = openSources(data, messages, progress.part(0.2, 1));
    checkDerived(request.derived, volume::underived(sources.numbers)->info());
    for (const std::string& message : messages) std::fprintf(stderr, "tessera: %s\n", message.c_str());
    return sources;
}

std::string stateOf(const Question& question) {
    const glm::ivec3 size = question.source->grid().lattice.size;
    return question.info().name + ", " + std::to_string(size.x) + " x " + std::to_string(size.y) + " x " +
           std::to_string(size.z) + " samples, numbers " +
           originText(question.origin, question.info(), question.channels);
}

void run(const StatsRequest& request) {
    const StatsOptions& options = request.options;
    const bool sections = options.planesAcross(), pdf = hasEnding(request.output, ".pdf"),
               figure = pdf || hasEnding(request.output, ".svg");
    if (!request.output.empty() && !figure && !hasEnding(request.output, ".csv") && !hasEnding(request.output, ".json"))
        throw Error("statistics are written as .csv, .svg, .pdf or .json", request.output);
    if (sections && !options.balance.empty())
        throw Error("balances are of whole regions: omit --along and --line", "--balance");
    if (figure && !sections && !options.allTimes && options.balance.empty())
        throw Error("figures need --along, --line, --balance or --all-times", request.output);
    if (figure && sections && options.allTimes)
        throw Error("a figure shows one time: choose it with --time", request.output);
    const Progress progress = terminalProgress("stats");
    const Question question = questionOf(request, openInput(request, progress.part(0, 0.3)));
    rememberStated(request.import, question.info().name);
    Answer answer;
    const double count = double(question.times.size());
    for (std::size_t t = 0; t < question.times.size(); ++t) {
        const double time = question.times[t];
        const Progress part = progress.part(0.3 + 0.7 * double(t) / count, 0.3 + 0.7 * double(t + 1) / count);
        if (question.several()) answer.text += "t = " + formatQuantity(time, question.info().timeUnit) + "\n";
        addAnswer(answer, request, question, time, part);
    }
    if (figure && !sections) answer.panels = figureOf(request, question, {});
    progress.advance(1);
    const std::string state = stateOf(question);
    const std::string json = Json{{"kind", "statistics"},
                                  {"data", question.info().name},
                                  {"samples", state},
                                  {"lengthUnit", question.info().lengthUnit},
                                  {"timeUnit", question.info().timeUnit},
                                  {"notes", answer.notes},
                                  {"rows", std::move(answer.json)}}
                                 .dump(1) +
                             "\n";
    if (!request.output.empty()) {
        AtomicFile file(request.output);
        const std::string origin = originText(question.origin, question.info(), question.channels);
        const std::string line = originLine(question.origin, question.info(), question.channels);
        VectorPage drawing = drawingOf(answer.panels, 2);
        drawing.numbers = origin;
        file.write(figure                              ? fileOf(drawing, pdf ? "pdf" : "svg")
                   : hasEnding(request.output, ".csv") ? line + answer.csv
                                                       : json);
        file.commit();
    }
    if (options.json) {
        std::fputs(json.c_str(), stdout);
    } else if (request.output.empty()) {
        std::printf("%s\n%s", state.c_str(), answer.text.c_str());
        for (const std::string& note : answer.notes) std::printf("  %s\n", note.c_str());
    }
}

} // namespace

void addStatsCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "stats",
        "Statistics of every region: mean, standard deviation, volume; averages along an axis or line; balances");
    const auto request = std::make_shared<StatsRequest>();
    command->add_option("IN", request->inputs, "Archive, data files that belong together, or a built-in model")
        ->required();
    command->add_option("-o,--output", request->output, "File to write: .csv, .svg, .pdf or .json");
    addDescribed(*command, request->options);
    addDeriveOption(*command, request->derived);
    addImportOptions(*command, request->import);
    addRemoteOptions(*command, request->remote);
    command->callback([request] { run(*request); });
}

} // namespace tessera::app
