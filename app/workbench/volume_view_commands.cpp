#include "app/session/shown_scene.h"
#include "app/workbench/workbench.h"
#include "app/workbench/workbench_commands.h"

#include <tuple>

namespace tessera::app {

namespace {

/// What the volume view clicked last shares with the others; checked while it does.
std::vector<Command> linkCommands(Workbench& workbench) {
    const auto view = [&workbench] { return volumeView(workbench.session(), volumePane(workbench.session())); };
    std::vector<Command> commands;
    for (const auto& [name, what, help, words] :
         {std::tuple{"-Link camera", Owned::Camera, "The volume view clicked last turns with the others, or by itself",
                     "chain unlink own lock share separate camera sync"},
          {"Link layers", Owned::Layers, "The volume view clicked last shows the layers of the others, or its own",
           "chain unlink own lock share separate parameter"},
          {"Link time", Owned::Time, "The volume view clicked last follows the timeline, or has a time of its own",
           "chain unlink own lock share separate step"}})
        commands.push_back({.menu = "View",
                            .name = name,
                            .help = help,
                            .words = words,
                            .run =
                                [&workbench, view, what = what] {
                                    VolumeView& of = *view();
                                    setOwned(workbench.session(), of, what, !owns(of, what));
                                },
                            .enabled =
                                [&workbench, view, what = what] {
                                    return workbench.document().loaded() && view() &&
                                           (what != Owned::Time || view()->time ||
                                            workbench.document().info().times.size() > 1);
                                },
                            .checked = [view, what = what] { return view() && !owns(*view(), what); }});
    return commands;
}

} // namespace

std::vector<Command> volumeViewCommands(Workbench& workbench) {
    return linkCommands(workbench);
}

} // namespace tessera::app
