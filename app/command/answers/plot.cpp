#include "app/command/command.h"
#include "app/command/picture_options.h"
#include "app/data/format.h"
#include "app/data/import_options.h"
#include "app/data/open.h"
#include "app/platform/headless.h"
#include "app/views/curves/curves_data.h"
#include "vis/image/image_io.h"
#include "volume/base/error.h"
#include "volume/base/terminal.h"
#include "volume/system/atomic_file.h"

#include <CLI/CLI.hpp>
#include <memory>

namespace tessera::app {

namespace {

struct PlotRequest {
    std::vector<std::string> inputs;
    std::string output;
    CurvesView view;
    std::string axis;
    std::optional<double> time;
    PictureOptions picture;
    volume::ImportOptions import;
};

DataRef dataRef(const PlotRequest& request) {
    DataRef data = dataNamed(request.inputs, request.import);
    data.lattice = PictureLattice::Grid;
    data.axis = request.axis;
    return data;
}

/// A session that shows the plot, in the pane `pane`.
SessionDocument plotDocument(const PlotRequest& request, const DataRef& data, const volume::DatasetInfo& info,
                             std::string& pane) {
    SessionDocument document;
    document.session = defaultSession(info, data);
    document.session.appearance.theme = Theme::Light;
    document.session.time = request.time.value_or(info.times.front());
    pane = addView(document.session, request.view);
    document.history.reset(document.session);
    return document;
}

/// Draws the plot as the window does.
void drawPicture(const PlotRequest& request, const DataRef& data, const Sources& sources) {
    PictureRequest picture = pictureRequest(request.picture, Session{});
    picture.decoration.cursor = request.time.has_value();
    const SessionDocument document = plotDocument(request, data, sources.pictures->info(), picture.pane);
    PictureMaker maker;
    vis::writePng(request.output, maker.render(document, sources, picture),
                  {{vis::kSessionTextKey, printSession(document, request.output)}});
}

void run(const PlotRequest& request) {
    const bool csv = hasEnding(request.output, ".csv"), pdf = hasEnding(request.output, ".pdf"),
               figure = pdf || hasEnding(request.output, ".svg");
    if (!csv && !figure && !hasEnding(request.output, ".png"))
        throw Error("plots are written as .csv, .svg, .pdf or .png", request.output);
    pictureRequest(request.picture, Session{}); // reports a wrong size before the work starts
    const Progress progress = terminalProgress("plot");
    std::vector<std::string> messages;
    const DataRef data = dataRef(request);
    const Sources sources = openSources(data, messages, progress.part(0, 0.4));
    for (const std::string& message : messages) warn("tessera: %s\n", message.c_str());
    const volume::DatasetInfo& info = sources.numbers->info();
    if (info.times.size() < 2) throw Error("has only one time: curves need several", request.inputs[0]);
    if (!csv && !figure) return drawPicture(request, data, sources);
    Session session;
    const PlotCurvesQuery query = plotCurvesQuery(request.view, session, info);
    const volume::Curves curves = readCurves(*sources.numbers, sources.origin, query, progress.part(0.4, 1));
    AtomicFile file(request.output);
    if (csv) {
        file.write("# numbers: " + curvesOrigin(info, sources.origin, query) + "\n" + csvOf(curvesTable(curves)));
    } else {
        std::string pane;
        VectorPage page =
            curvesDrawing(curves, request.time, pageForm(pictureRequest(request.picture, Session{}), Theme::Light),
                          request.view.together);
        page.numbers = curvesOrigin(info, sources.origin, query);
        page.session = printSession(plotDocument(request, data, info, pane), request.output);
        file.write(fileOf(page, pdf ? "pdf" : "svg"));
    }
    file.commit();
}

} // namespace

void addPlotCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "plot", "Draw or list quantities and statistics over time, or against each other: .csv, .svg, .pdf or .png");
    const auto request = std::make_shared<PlotRequest>();
    request->picture.form.size = {.width = 1000, .height = 700};
    command->add_option("IN", request->inputs, "Archive, data files that belong together, or a built-in model")
        ->required();
    command->add_option("-o,--output", request->output, "File to write; its ending chooses the format")->required();
    command->add_option(
        "--x", request->view.x,
        "Horizontal axis: time, a quantity over time, or a formula (default: the current, if there is one)");
    command
        ->add_option("--y", request->view.y,
                     "A curve: a quantity over time, mean(T), min(T), max(T), deviation(T), share(T), volume(T), "
                     "integral(T), or a formula such as voltage*current_density; may be repeated (default: the "
                     "polarisation curve, else every quantity)")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command
        ->add_option("--region", request->view.apart,
                     "Compute statistics in this region only: its name, or region=1; may be repeated, a curve for each "
                     "(default: everywhere)")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command->add_flag("--together,!--no-together", request->view.together,
                      "Draw curves of two units in one plot, with an axis on either side (default: yes)");
    command->add_option("--by", request->axis, "Quantity over time to use as the time axis");
    command->add_option("--time", request->time, "Time to mark in a picture");
    addFormOptions(*command, request->picture);
    addImportOptions(*command, request->import);
    command->callback([request] { run(*request); });
}

} // namespace tessera::app
