#include "app/command/command.h"
#include "app/command/picture_options.h"
#include "app/command/pictures/video.h"
#include "app/history/animated_session.h"
#include "codec/blocks/share_results.h"
#include "volume/base/error.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>

namespace tessera::app {

namespace {

struct ReplayOptions {
    PictureOptions picture;
    std::string output, video;
    bool animation = false, alone = false;
    double framesPerSecond = 0;
};

/// The pictures to draw: their number, and the session of each.
struct Reel {
    std::size_t count = 0;
    std::string name = "frame-%04zu.png";
    double framesPerSecond = 1;
    std::function<Session(std::size_t)> at;
};

/// The recorded steps. Pictures of those that do not show the pane are dropped.
Reel stepsReel(const Opened& opened) {
    auto history = std::make_shared<History>(opened.document.history);
    return {.count = history->steps().size() + 1,
            .name = "step-%04zu.png",
            .at = [history, source = opened.source](std::size_t i) {
                Session session = history->seek(i);
                std::vector<std::string> messages;
                fitSession(session, source->info(), messages);
                return session;
            }};
}

/// The keyframes; where there are none, every stored time.
Reel animationReel(const Opened& opened, double wantedRate) {
    const Session& session = opened.document.session;
    const Animation& animation = session.animation;
    Reel reel;
    if (animation.tracks.empty()) {
        const std::vector<double> times = opened.source->info().times;
        reel.count = times.size();
        reel.framesPerSecond = wantedRate > 0 ? wantedRate : double(animation.speed);
        reel.at = [session, times](std::size_t i) {
            Session now = session;
            now.time = times[i];
            return now;
        };
        return reel;
    }
    const double rate = wantedRate > 0 ? wantedRate : double(animation.framesPerSecond);
    // The last picture is always the end of the animation.
    reel.count = std::max<std::size_t>(2, std::size_t(std::lround(animation.duration * rate)) + 1);
    reel.framesPerSecond = rate;
    reel.at = [session, count = reel.count](std::size_t i) {
        Session now = session;
        now.animation.position = now.animation.duration * double(i) / double(count - 1);
        applyTracks(now, now.animation.position);
        return now;
    };
    return reel;
}

void run(const ReplayOptions& options) {
    const Progress progress = terminalProgress("replay");
    pictureRequest(options.picture, Session{});
    if (!options.video.empty()) {
        requireFfmpeg();
        requireFolderOf(options.video);
    }
    const Opened opened = openForPicture(options.picture, progress.part(0, 0.1));
    std::error_code problem;
    std::filesystem::create_directories(options.output, problem);
    if (problem) throw MachineError(problem.message(), options.output);

    const bool animation = options.animation || !options.video.empty();
    const Reel reel = animation ? animationReel(opened, options.framesPerSecond) : stepsReel(opened);
    const std::filesystem::path folder(options.output);
    std::unique_ptr<PictureMaker> maker; // made by a process that has something to draw
    const auto draw = [&](std::size_t i, const Progress& part) -> std::string {
        part.advance(0, std::to_string(i + 1));
        SessionDocument document = opened.document;
        document.session = reel.at(i);
        document.history.reset(document.session);
        const PictureRequest request = pictureRequest(options.picture, document.session);
        const auto isOpen = [&](const std::string& pane) { return document.session.views.contains(pane); };
        if (!std::ranges::all_of(panesOf(request), isOpen)) return {}; // not yet, so nothing is drawn
        char name[32];
        std::snprintf(name, sizeof name, reel.name.c_str(), i);
        if (!maker) maker = std::make_unique<PictureMaker>();
        maker->write(document, opened.sources(), request, (folder / name).string());
        return name;
    };
    const auto finish = [&](const std::vector<std::string>&, const Progress& part) {
        if (!options.video.empty())
            writeVideo((folder / "frame-%04d.png").string(), reel.count, reel.framesPerSecond, options.video, part);
    };
    Json about = aboutPicture(options.picture, opened);
    about.update({{"animation", animation}, {"fps", options.framesPerSecond}, {"video", options.video}});
    const std::optional<Launched> started = sharing(options.alone);
    const auto isMade = [&](std::size_t, const std::string& name) {
        return name.empty() || std::filesystem::exists(folder / name);
    };
    const codec::SharedResults done =
        codec::shareResults({options.output, aboutText(about, opened.document.session.data), started, isMade},
                            reel.count, draw, finish, progress.part(0.1, 1));
    sayShare(done.own, reel.count, "pictures drawn", started);
}

} // namespace

void addReplayCommand(CLI::App& app) {
    auto options = std::make_shared<ReplayOptions>();
    CLI::App* command =
        app.add_subcommand("replay", "Draw each step of the history of a session, or its animation, to numbered PNGs; "
                                     "processes of mpirun or srun share them");
    addPictureOptions(*command, options->picture);
    command->add_flag("--animation", options->animation,
                      "Draw the keyframe animation instead of the history; without keyframes, every stored time");
    command->add_option("--fps", options->framesPerSecond, "Pictures per second (default: as in the session)")
        ->check(CLI::Range(0.1, 240.0));
    command->add_option("--video", options->video, "Also write the animation as a video (needs ffmpeg)")
        ->type_name("FILE.mp4");
    addAloneOption(*command, options->alone);
    command->add_option("-o,--output,--out", options->output, "Folder for the pictures; created if it does not exist")
        ->required();
    command->callback([options] { run(*options); });
}

} // namespace tessera::app
