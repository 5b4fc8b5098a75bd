#include "app/command/command.h"
#include "app/command/derive_option.h"
#include "app/data/format.h"
#include "app/data/import_options.h"
#include "app/data/open.h"
#include "app/described/describe_cli.h"
#include "app/pages/plot_page.h"
#include "app/views/pieces/pieces_data.h"
#include "volume/base/error.h"
#include "volume/base/terminal.h"
#include "volume/flow/flow_channels.h"
#include "volume/system/atomic_file.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>

namespace tessera::app {

namespace {

struct PiecesOptions {
    std::string channel;
    std::optional<double> iso;
    bool below = false;
    double leastVolume = 0;
    static void describe(auto& self, auto&& visit) {
        visit(self.channel, FieldInfo{"channel", "Parameter whose pieces are followed (default: the only one)"});
        visit(self.iso, FieldInfo{"iso", "Value that samples of pieces reach, in the parameter's unit (default: the "
                                         "middle of its range)"});
        visit(self.below, FieldInfo{"below", "Pieces of at most the value, not of at least"});
        visit(self.leastVolume, FieldInfo{.key = "leastVolume",
                                          .doc = "Volume that a piece has when it is largest, in cubes of the unit of "
                                                 "lengths; smaller ones are left out",
                                          .range = Range{0, 1e30}});
    }
};

struct PiecesRequest {
    std::vector<std::string> inputs;
    std::string output;
    PiecesOptions pieces;
    std::vector<volume::DerivedParameter> derived;
    volume::ImportOptions import;
};

PiecesQuestion askedPieces(const PiecesRequest& request, const volume::DatasetInfo& info) {
    const std::string known = volume::channelNames(info);
    const std::string& name = request.pieces.channel.empty() ? known : request.pieces.channel;
    const std::optional<int> channel = info.findChannel(name);
    if (!channel)
        throw Error(request.pieces.channel.empty() ? "name a parameter with --channel; there are " + known
                                                   : "there is no parameter \"" + name + "\"; there are " + known,
                    request.inputs[0]);
    PiecesView view;
    view.of = request.pieces.below ? PiecesOf::Below : PiecesOf::Above;
    view.value = request.pieces.iso;
    view.leastVolume = request.pieces.leastVolume;
    return piecesQuestion({}, info, view, *channel);
}

void runPieces(const PiecesRequest& request) {
    const std::string& path = request.output;
    const bool figure = hasEnding(path, ".svg") || hasEnding(path, ".pdf");
    if (!path.empty() && !figure && !hasEnding(path, ".csv"))
        throw Error("pieces are written as .csv, .svg or .pdf", path);
    if (!path.empty()) requireFolderOf(path);
    const Progress progress = terminalProgress("pieces");
    DataRef data = dataNamed(request.inputs, request.import, progress.part(0, 0.1));
    data.lattice = PictureLattice::Grid; // nothing is drawn, so no resampling for pictures
    data.derived = request.derived;
    std::vector<std::string> messages;
    const Sources sources = openSources(data, messages, progress.part(0.1, 0.3));
    checkDerived(data.derived, volume::underived(sources.numbers)->info());
    for (const std::string& message : messages) warn("tessera: %s\n", message.c_str());
    const volume::DatasetInfo& info = sources.numbers->info();
    const PiecesQuestion question = askedPieces(request, info);
    const volume::PieceGraph graph = readPieces(*sources.numbers, question, 0, progress.part(0.3, 1));
    const Table table = piecesTable(info, graph, question);
    progress.advance(1);
    if (path.empty()) {
        say("%s\n%s", piecesNote(info, graph, question).c_str(), textOf(table).c_str());
        return;
    }
    const auto drawn = [&] {
        const Plot plot = piecesPlot(info, graph, question, {}, layOutPieces(info, graph));
        return fileOf(plotPage({plot}, 0, {}), path.substr(path.size() - 3));
    };
    writeAtomically(path, figure ? drawn() : csvOf(table));
    say("%s: %s\n", path.c_str(), piecesNote(info, graph, question).c_str());
}

} // namespace

void addPiecesCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "pieces", "Connected pieces of what reaches a value, at every time: how they are born, merge, split and die");
    const auto request = std::make_shared<PiecesRequest>();
    command->add_option("IN", request->inputs, "Archive, data files that belong together, or a built-in model")
        ->required();
    command->add_option("-o,--output", request->output, "File to write: .csv, .svg or .pdf");
    addDescribed(*command, request->pieces);
    addDeriveOption(*command, request->derived);
    addImportOptions(*command, request->import);
    command->callback([request] { runPieces(*request); });
}

} // namespace tessera::app
