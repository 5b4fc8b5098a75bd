#include "app/edits/compare.h"
#include "app/command/command.h"
#include "app/command/picture_options.h"
#include "app/data/sources.h"
#include "app/edits/compare_files.h"
#include "app/views/compare/compare_offers.h"
#include "app/views/compare/compare_panes.h"
#include "app/views/compare/compare_table.h"
#include "app/views/compare/compare_view.h"
#include "codec/blocks/share_results.h"
#include "volume/base/error.h"
#include "volume/base/terminal.h"
#include "volume/export/time_files.h"
#include "volume/system/atomic_file.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace tessera::app {

namespace {

/// Parses "NAME: /path=value; /path=value". The name is optional; at least one change is required.
CompareVariant parseVariant(const std::string& text) {
    CompareVariant variant;
    std::string rest = text;
    const auto colon = rest.find(':');
    const bool named = colon != std::string::npos || rest.find('=') == std::string::npos;
    if (named && !rest.starts_with('/')) {
        variant.name = rest.substr(0, colon);
        rest = colon == std::string::npos ? std::string() : rest.substr(colon + 1);
    }
    while (!rest.empty()) {
        const auto end = std::min(rest.find(';'), rest.size());
        std::string change = rest.substr(0, end);
        rest = rest.substr(std::min(end + 1, rest.size()));
        change.erase(0, change.find_first_not_of(' '));
        if (change.empty()) continue;
        const auto equals = change.find('=');
        if (equals == std::string::npos || !change.starts_with('/'))
            throw CLI::ValidationError("--variant", "needs NAME: /json/pointer=value; ..., not \"" + text + "\"");
        variant.changes[change.substr(0, equals)] = change.substr(equals + 1);
    }
    return variant;
}

/// The pane to draw: a comparison that `wanted` names, else the first one, made to show the view `wanted`. Opens one if
/// there is none.
std::string comparePane(Session& session, const std::string& wanted) {
    std::string named = wanted.empty() ? std::string() : paneOf(session, wanted);
    if (!wanted.empty() && named.empty()) throw Error("one view is compared, not several", "--view", wanted);
    const auto isComparison = [&](const std::string& pane) {
        return std::holds_alternative<CompareView>(session.views.at(pane));
    };
    if (!named.empty() && isComparison(named)) return named;
    std::string pane;
    for (const auto& [each, view] : session.views)
        if (pane.empty() && isComparison(each)) pane = each;
    if (pane.empty()) pane = addView(session, CompareView{});
    if (named.empty()) return pane;
    const ViewState& shown = session.views.at(named);
    const bool scene = std::holds_alternative<VolumeView>(shown);
    if (!scene && !canBeCompared(shown)) throw Error("this view cannot be compared", {}, wanted);
    std::get<CompareView>(session.views.at(pane)).shows = scene ? std::string() : named;
    return pane;
}

/// Opens other data beside those of a document; the document's session shows both with one function.
void openBeside(Opened& opened, const std::string& path, const Progress& progress) {
    Session& session = opened.document.session;
    DataRef data = session.data;
    const DataRef other = dataNamed({path}, {});
    data.other =
        OtherData{.files = other.files, .model = other.model, .settings = other.settings, .import = other.import};
    std::vector<std::string> messages;
    ComparedData compared = openCompared(data, session, messages, progress);
    for (const std::string& text : messages) warn("tessera: %s\n", text.c_str());
    if (compared.channel.empty()) throw Error("the two data sets have no parameter in common", path);
    opened.take(std::move(compared.sources));
    session.data = data;
    showOtherDifference(session, opened.source->info(), compared.channel);
}

struct CompareOptions {
    PictureOptions picture;
    std::string output, csv, with;
    std::vector<std::string> variants;
    int reference = -1;
    std::optional<double> time;
    bool allTimes = false, alone = false;
};

void check(const CompareOptions& options) {
    pictureRequest(options.picture, Session{});
    if (options.allTimes && options.time) throw Error("with --all-times there is no single time", {}, "--time");
    requirePictureEnding(options.output);
    for (const std::string& path : {options.output, options.csv}) {
        if (!path.empty()) requireFolderOf(path);
    }
}

/// Opens the data and sets the comparison as the options say; returns its pane.
std::string prepare(const CompareOptions& options, Opened& opened, const Progress& progress) {
    opened = openForPicture(options.picture, progress.part(0, options.with.empty() ? 1 : 0.6));
    Session& session = opened.document.session;
    if (!options.with.empty()) openBeside(opened, options.with, progress.part(0.6, 1));
    requireViews(session, options.picture);
    const std::string pane = comparePane(session, options.picture.view);
    auto& view = std::get<CompareView>(session.views[pane]);
    if (!options.with.empty()) view.variants = fileVariants(session, opened.source->info());
    if (!options.variants.empty()) {
        view.variants.clear();
        for (const std::string& text : options.variants) view.variants.push_back(parseVariant(text));
    }
    if (options.reference >= 0) view.reference = options.reference;
    const std::vector<CompareVariant> variants = shownVariants(view, session, opened.source->info());
    const auto count = static_cast<int>(variants.size());
    if (view.reference >= count)
        throw Error("there are " + std::to_string(count) + " variants, counted from 0", "--reference",
                    std::to_string(view.reference));
    for (const CompareVariant& variant : variants) variantSession(session, variant); // fail early
    if (options.allTimes) view.variants = variants; // those that are offered depend on the time shown
    return pane;
}

/// Draws the figure of a document and returns the rows of its table.
std::vector<CompareRow> draw(PictureMaker& maker, const CompareOptions& options, const Opened& opened,
                             SessionDocument document, const std::string& pane, const std::string& path) {
    document.history.reset(document.session);
    PictureRequest request = pictureRequest(options.picture, document.session);
    request.pane = pane;
    request.panels.clear();
    std::vector<CompareRow> rows;
    maker.write(document, opened.sources(), request, path, [&](const Workbench& workbench) {
        rows = drawnComparison(workbench.cache(pane));
        for (const CompareRow& row : rows)
            if (!row.failure.empty()) throw Error(row.failure, {}, row.name);
    });
    return rows;
}

void run(const CompareOptions& options) {
    const Progress progress = terminalProgress("compare");
    check(options);
    Opened opened;
    const std::string pane = prepare(options, opened, progress.part(0, 0.5));
    const volume::DatasetInfo& info = opened.source->info();
    const auto atTime = [&](double time) {
        SessionDocument document = opened.document;
        showTime(document.session, info, time, viewsOf(options.picture));
        return document;
    };
    std::unique_ptr<PictureMaker> maker; // made by a process that has something to draw
    const auto drawOne = [&](const SessionDocument& document, const std::string& path) {
        if (!maker) maker = std::make_unique<PictureMaker>();
        return draw(*maker, options, opened, document, pane, path);
    };
    if (!options.allTimes) {
        const auto rows = drawOne(options.time ? atTime(*options.time) : opened.document, options.output);
        if (!options.csv.empty()) writeAtomically(options.csv, csvOf(compareTable(rows)));
        return progress.advance(1);
    }
    const auto figure = [&](std::size_t t, const Progress& part) {
        part.advance(0, std::to_string(t + 1));
        const double time = info.times[t];
        Table table = compareTable(drawOne(atTime(time), volume::fileOfTime(options.output, t)));
        addTime(table, info.timeName, info.timeUnit, time);
        return csvOf(table, t == 0);
    };
    const auto finish = [&](const std::vector<std::string>& tables, const Progress&) {
        std::string csv;
        for (const std::string& table : tables) csv += table;
        if (!options.csv.empty()) writeAtomically(options.csv, csv);
    };
    const std::optional<Launched> started = sharing(options.alone);
    Json about = aboutPicture(options.picture, opened);
    about["csv"] = options.csv;
    const auto isMade = [&](std::size_t t, const std::string&) {
        return std::filesystem::exists(volume::fileOfTime(options.output, t));
    };
    const codec::SharedResults done =
        codec::shareResults({options.output, aboutText(about, opened.document.session.data), started, isMade},
                            info.times.size(), figure, finish, progress.part(0.5, 1));
    sayShare(done.own, info.times.size(), "figures drawn", started);
}

} // namespace

void addCompareCommand(CLI::App& app) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* command = app.add_subcommand("compare", "Draw the 3D scene, or the view named by --view, with several "
                                                      "settings side by side, as one figure with a table");
    addPictureOptions(*command, options->picture);
    command
        ->add_option("--variant", options->variants,
                     "A variant to compare, instead of those in the session, e.g. \"box: /render/filter=tetrahedral\"; "
                     "may be repeated")
        ->type_name("[NAME:] /POINTER=VALUE; ...")
        ->expected(1)
        ->take_all();
    command
        ->add_option("--with", options->with,
                     "Another file to compare with: both in one colour bar, and the difference; the other data are "
                     "interpolated onto the grid of the first where theirs is another")
        ->type_name("DATA");
    addTimeOption(*command, options->time);
    command->add_flag("--all-times", options->allTimes,
                      "A figure of every stored time, OUT_0000.png and so on; processes of mpirun or srun share them");
    addAloneOption(*command, options->alone);
    command->add_option("--reference", options->reference, "Variant that the others are compared with, counted from 0")
        ->check(CLI::Range(0, 15));
    command
        ->add_option("-o,--output", options->output,
                     "Picture to write: a PNG or a figure (.svg, .pdf), which contain the session")
        ->required();
    command->add_option("--csv", options->csv, "CSV file to write the table to");
    command->callback([options] { run(*options); });
}

} // namespace tessera::app
