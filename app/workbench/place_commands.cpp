#include "app/pane/view_parts.h"
#include "app/queries/probe_values.h"
#include "app/session/shown_scene.h"
#include "app/values/selection_text.h"
#include "app/workbench/workbench.h"
#include "app/workbench/workbench_commands.h"

#include <memory>

/// The cross-hair goes to places that are named by what is there, and places are kept.
namespace tessera::app {

namespace {

constexpr const char* kExtremeWords =
    "extreme peak hottest coldest highest lowest largest smallest find place jump cross-hair";

ExtremeOf ofSelection(const Session& session) {
    return selectionName(session).empty() ? ExtremeOf::All : ExtremeOf::Selected;
}

void goToShown(Workbench& workbench, bool greatest) {
    Session& session = workbench.session();
    const ShownScene scene(session, volumePane(session)); // has the first layer
    const volume::DatasetInfo& info = workbench.document().info();
    if (const auto channel = resolveChannel(info, session, ""))
        goTo(workbench, {.channel = info.channel(*channel).name, .greatest = greatest, .of = ofSelection(session)});
}

/// Adds a probe, and shows the list.
void keepHere(Workbench& workbench) {
    Session& session = workbench.session();
    if (const std::size_t here = probeHere(session, workbench.document().info()); here < session.probes.size())
        return workbench.message(session.probes[here].name + " is here already");
    workbench.message(session.probes[addProbe(session, workbench.document().info())].name + " is kept");
    for (const auto& [pane, view] : session.views)
        if (std::holds_alternative<ProbesView>(view)) return workbench.panes().show(session, pane);
    workbench.panes().open(session, ProbesView{}, workbench.look().scale());
}

} // namespace

void goTo(Workbench& workbench, const ExtremeQuestion& question) {
    const auto source = workbench.numbers();
    const auto asked = std::make_shared<const Session>(workbench.session());
    workbench.jobs().start("go to extreme", "Looking for the " + textOf(question, *asked, source->info()),
                           [&workbench, source, asked, question](const Progress& progress) -> Jobs::Finish {
                               const auto place = findExtreme(source, *asked, question, progress);
                               return [&workbench, source, asked, question, place] {
                                   if (workbench.numbers() != source) return; // other data since
                                   const std::string what = textOf(question, *asked, source->info());
                                   if (!place) return workbench.message("no sample: " + what, true);
                                   Session& session = workbench.session();
                                   session.cursor = place->position;
                                   if (question.everyTime) session.time = place->time;
                                   workbench.message(what + ": " + textOf(*place, question, source->info()));
                               };
                           });
}

std::vector<Command> placeCommands(Workbench& workbench) {
    const auto loaded = [&workbench] { return workbench.document().loaded(); };
    std::vector<Command> commands;
    for (const bool greatest : {true, false})
        commands.push_back({.menu = "Edit",
                            .name = greatest ? "-Go to the maximum" : "Go to the minimum",
                            .help = "Move the cross-hair to the " + std::string(greatest ? "greatest" : "least") +
                                    " value of the parameter shown, in the selection where there is one",
                            .words = kExtremeWords,
                            .shortcut = {.key = 'G', .shift = !greatest},
                            .run = [&workbench, greatest] { goToShown(workbench, greatest); },
                            .enabled = loaded});
    commands.push_back({.menu = "Edit",
                        .name = "Keep the values here",
                        .help = "Add the place of the cross-hair, at the time shown, to the list of probes",
                        .words = "probe point bookmark pick remember add",
                        .shortcut = {.key = 'P'},
                        .run = [&workbench] { keepHere(workbench); },
                        .enabled = loaded});
    return commands;
}

std::vector<Command> extremesOfParameters(Workbench& workbench) {
    std::vector<Command> commands;
    if (!workbench.document().loaded()) return commands;
    const Session& session = workbench.session();
    const volume::DatasetInfo& info = workbench.document().info();
    const bool selected = ofSelection(session) == ExtremeOf::Selected, several = info.times.size() > 1;
    const auto add = [&](const ExtremeQuestion& question, const std::string& suffix) {
        commands.push_back(
            {.menu = "",
             .name = "Go to the " + textOf(question, session, info) + suffix,
             .help = "Move the cross-hair there" + std::string(question.everyTime ? ", and the time" : ""),
             .words = kExtremeWords,
             .run = [&workbench, question] { goTo(workbench, question); }});
    };
    for (const int channel : comparedChannels(info))
        for (const bool greatest : {true, false}) {
            ExtremeQuestion question{.channel = info.channel(channel).name, .greatest = greatest};
            for (const bool everyTime : {false, true}) {
                if (everyTime && !several) continue;
                question.everyTime = everyTime;
                question.of = ExtremeOf::Selected;
                if (selected) add(question, "");
                question.of = ExtremeOf::All;
                add(question, selected ? " everywhere" : "");
            }
        }
    return commands;
}

} // namespace tessera::app
