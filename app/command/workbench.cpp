#include "app/command/command.h"
#include "app/command/picture_options.h"
#include "app/data/apply_layout.h"
#include "app/data/import_options.h"
#include "app/platform/window.h"

#include "codec/remote/address.h"
#include "volume/base/error.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>

namespace tessera::app {

void requireFile(const std::string& word) {
    std::error_code problem;
    if (codec::isRemote(word) || namesModel(word) || std::filesystem::exists(word, problem)) return;
    if (word.find_first_of("./") != std::string::npos) throw Error("no such file", word);
    const std::vector<std::string> layouts = layoutNames();
    if (std::find(layouts.begin(), layouts.end(), word) != layouts.end())
        throw Error("neither a command nor a file; to open the layout of that name: tessera --layout " + word, word);
    throw Error("neither a command nor a file; tessera --help lists the commands", word);
}

void addWorkbench(CLI::App& app) {
    struct Options {
        OpenRequest request;
        volume::ImportOptions import;
        codec::RemoteOptions remote;
        std::string screenshots;
    };
    auto options = std::make_shared<Options>();
    app.add_option("file", options->request.paths,
                   "Session, archive, picture exported by Tessera, data files or a built-in model to open (default: "
                   "fuel-cell); "
                   "an archive also by its address on another machine: https://host/run.tsr, sftp://host/path/run.tsr")
        ->type_name("FILE");
    addLayoutOption(app, options->request.layout);
    app.add_option("--screenshots", options->screenshots,
                   "Write a PNG of the window whenever its picture is complete; for scripts");
    addImportOptions(app, options->import);
    addRemoteOptions(app, options->remote);
    addAllowRemoteOption(app);
    app.callback([options, &app] {
        if (!app.get_subcommands().empty()) return;
        // Fail here instead of opening a window with nothing to show.
        for (const std::string& path : options->request.paths) requireFile(path);
        if (!options->request.layout.empty()) findLayout(options->request.layout);
        if (!(options->import == volume::ImportOptions{})) options->request.import = options->import;
        if (!(options->remote == codec::RemoteOptions{})) options->request.remote = options->remote;
        runWindow(options->request, options->screenshots);
    });
}

} // namespace tessera::app
