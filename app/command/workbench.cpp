#include "app/command/command.h"
#include "app/command/import_options.h"
#include "app/platform/window.h"

#include <memory>

namespace tessera::app {

void addWorkbench(CLI::App& app) {
    struct Options {
        OpenRequest request;
        volume::ImportOptions import;
        std::string screenshots;
    };
    auto options = std::make_shared<Options>();
    app.add_option("file", options->request.paths,
                   "Session, archive, picture of ours or data files to open; none: the built-in fuel cell")
        ->type_name("FILE");
    app.add_option("--layout", options->request.layout, "Layout to show the data in, by name or file");
    app.add_option("--screenshots", options->screenshots,
                   "Keep a PNG of the window up to date, written whenever it is complete; for scripts");
    addImportOptions(app, options->import);
    app.callback([options, &app] {
        if (!app.get_subcommands().empty()) return;
        if (!(options->import == volume::ImportOptions{})) options->request.import = options->import;
        runWindow(options->request, options->screenshots);
    });
}

} // namespace tessera::app
