#include "app/command/command.h"
#include "app/command/picture_options.h"
#include "volume/base/error.h"
#include "volume/system/atomic_file.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

namespace tessera::app {

namespace {

/// The suffix "svg", "pdf" or "csv" of a path, else "".
std::string textEnding(const std::string& path) {
    for (const char* ending : {"svg", "pdf", "csv"})
        if (path.ends_with(std::string(".") + ending)) return ending;
    return "";
}

} // namespace

void addRenderCommand(CLI::App& app) {
    struct Options {
        PictureOptions picture;
        std::string output;
        std::optional<double> time;
    };
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "render",
        "Draw the window or views to a PNG, SVG or PDF, or write the table of a view, without opening a window");
    addPictureOptions(*command, options->picture);
    addTimeOption(*command, options->time);
    command
        ->add_option("-o,--output", options->output,
                     "File to write: a picture (.png) or a figure (.svg, .pdf), which contain the session, or with "
                     "--view a table (.csv)")
        ->required();
    command->callback([options] {
        const Progress progress = terminalProgress("render");
        const std::string ending = textEnding(options->output);
        if (ending == "svg") options->picture.form.format = PictureFormat::Svg;
        if (ending == "pdf") options->picture.form.format = PictureFormat::Pdf;
        // Report a wrong size or a missing folder before the work starts.
        pictureRequest(options->picture, Session{});
        if (ending == "csv" && viewsOf(options->picture).size() != 1)
            throw Error("a table is of one view: name it with --view", options->output);
        if (ending != "csv") requirePictureEnding(options->output);
        requireFolderOf(options->output);
        Opened opened = openForPicture(options->picture, progress);
        Session& session = opened.document.session;
        requireViews(session, options->picture);
        if (options->time) showTime(session, opened.source->info(), *options->time, viewsOf(options->picture));
        opened.document.history.reset(session);
        PictureMaker maker;
        const PictureRequest request = pictureRequest(options->picture, session);
        if (ending != "csv") return maker.write(opened.document, opened.sources(), request, options->output);
        AtomicFile file(options->output);
        file.write(maker.table(opened.document, opened.sources(), request, progress));
        file.commit();
    });
}

} // namespace tessera::app
