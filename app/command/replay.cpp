#include "app/command/command.h"
#include "app/command/picture_options.h"
#include "volume/error.h"

#include <cstdio>
#include <filesystem>
#include <memory>

namespace tessera::app {

void addReplayCommand(CLI::App& app) {
    struct Options {
        PictureOptions picture;
        std::string output;
        bool animation = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("replay", "Draw each step of a session's history, or its animation, into numbered PNGs");
    addPictureOptions(*command, options->picture);
    command->add_flag("--animation", options->animation, "Every stored time instead of the recorded steps");
    command->add_option("-o,--output", options->output, "Folder of the pictures; made if need be")->required();
    command->callback([options] {
        const Progress progress = terminalProgress("replay");
        pictureRequest(options->picture, Session{});
        Opened opened = openForPicture(options->picture, progress.part(0, 0.1));
        std::error_code problem;
        std::filesystem::create_directories(options->output, problem);
        if (problem) throw MachineError(problem.message(), options->output);

        SessionDocument document = opened.document;
        const std::vector<double>& times = opened.source->info().times;
        const std::size_t count = options->animation ? times.size() : document.history.steps().size() + 1;
        PictureMaker maker;
        for (std::size_t i = 0; i < count; ++i) {
            progress.part(0.1, 1).advance(double(i) / double(count), std::to_string(i + 1));
            if (options->animation) {
                document.session.time = times[i];
            } else {
                document.session = opened.document.history.seek(i);
                std::vector<std::string> messages;
                fitSession(document.session, opened.source->info(), messages);
            }
            document.history.reset(document.session);
            PictureRequest request = pictureRequest(options->picture, document.session);
            char name[32];
            std::snprintf(name, sizeof name, options->animation ? "frame-%04zu.png" : "step-%04zu.png", i);
            const std::string path = (std::filesystem::path(options->output) / name).string();
            if (!request.pane.empty() && !document.session.views.contains(request.pane)) continue; // not open yet
            const vis::Image image = maker.render(document, opened.source, request);
            vis::writePng(path, image, {{vis::kSessionTextKey, printSession(document, path)}});
        }
        progress.advance(1);
    });
}

} // namespace tessera::app
