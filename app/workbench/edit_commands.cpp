#include "app/data/library.h"
#include "app/pane/view_parts.h"
#include "app/session/own_functions.h"
#include "app/session/shown_scene.h"
#include "app/ui/keys.h"
#include "app/views/data/derived_list.h"
#include "app/workbench/workbench.h"
#include "app/workbench/workbench_commands.h"
#include "volume/base/error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <imgui.h>

/// The menu Edit, and commands that add derived parameters or apply transfer functions.
namespace tessera::app {

namespace {

std::vector<Command> historyCommands(Workbench& workbench) {
    return {{.menu = "Edit",
             .name = "Undo",
             .help = "Undo the last edit",
             .words = "back take back revert",
             .shortcut = {.key = 'Z', .ctrl = true},
             .run = [&workbench] { workbench.document().undo(); },
             .enabled = [&workbench] { return workbench.history().canUndo() && !workbench.history().pending(); },
             .repeats = true},
            {.menu = "Edit",
             .name = "Redo",
             .help = "Redo the last undone edit",
             .words = "forward again repeat",
             .shortcut = {.key = 'Z', .ctrl = true, .shift = true},
             .alternative = {.key = 'Y', .ctrl = true},
             .run = [&workbench] { workbench.document().redo(); },
             .enabled = [&workbench] { return workbench.history().canRedo() && !workbench.history().pending(); },
             .repeats = true}};
}

std::vector<Command> brushCommands(Workbench& workbench) {
    const auto brushes = [&workbench]() -> auto& {
        return workbench.session().selection.brushes;
    };
    return {{.menu = "Edit",
             .name = "-Clear brushes",
             .help = "Remove all brushes, so that nothing is selected",
             .words = "remove delete reset selection deselect",
             .shortcut = {.key = key::kEscape},
             .run =
                 [&workbench, brushes] {
                     const std::size_t count = brushes().size();
                     if (count == 1) return brushes().clear();
                     workbench.ask("Remove all " + std::to_string(count) + " brushes?", "Remove all",
                                   [brushes] { brushes().clear(); });
                 },
             .enabled = [brushes] { return !brushes().empty() && !ImGui::IsAnyItemActive(); }},
            {.menu = "Edit",
             .name = "Invert brushes",
             .help = "Invert every brush",
             .words = "selection opposite not",
             .run =
                 [brushes] {
                     for (vis::Brush& brush : brushes()) brush.inverted = !brush.inverted;
                 },
             .enabled = [brushes] { return !brushes().empty(); }}};
}

std::vector<Command> timeCommands(Workbench& workbench) {
    const auto loaded = [&workbench] { return workbench.document().loaded(); };
    const auto playing = [&workbench]() -> bool& { return workbench.session().animation.playing; };
    const auto several = [&workbench, loaded] { return loaded() && workbench.document().info().times.size() > 1; };
    struct Step {
        const char *name, *help, *words;
        int key, count;
    };
    static constexpr int kAll = 1 << 24; // farther than there are times
    std::vector<Command> commands;
    for (const Step& step :
         {Step{"-Previous time", "Go to the previous stored time", "step back earlier frame", key::kLeft, -1},
          {"Next time", "Go to the next stored time", "step forward later frame", key::kRight, 1},
          {"Ten times back", "Go ten stored times back", "step earlier frames", key::kPageUp, -10},
          {"Ten times on", "Go ten stored times on", "step later frames", key::kPageDown, 10},
          {"First time", "Go to the first stored time", "beginning start step", key::kHome, -kAll},
          {"Last time", "Go to the last stored time", "end step", key::kEnd, kAll}})
        commands.push_back({.menu = "Edit",
                            .name = step.name,
                            .help = step.help,
                            .words = step.words,
                            .shortcut = {.key = step.key},
                            .run = [&workbench, count = step.count] { workbench.document().stepTime(count); },
                            .enabled = several,
                            .repeats = std::abs(step.count) < kAll});
    commands.push_back({.menu = "Edit",
                        .name = "Play",
                        .help = "Play or pause",
                        .words = "animation movie start stop pause",
                        .shortcut = {.key = key::kSpace},
                        .run = [playing] { playing() = !playing(); },
                        .enabled = several,
                        .checked = playing});
    return commands;
}

std::vector<Command> latticeCommands(Workbench& workbench) {
    std::vector<Command> commands;
    struct Lattice {
        PictureLattice lattice;
        const char* name;
    };
    for (const auto& [lattice, name] :
         {Lattice{PictureLattice::Grid, "-Draw on the grid of the file"},
          {PictureLattice::BodyCentred, "Draw on the body-centred lattice (70.7 % of the samples)"},
          {PictureLattice::Even, "Draw grids with uneven spacing to scale"}})
        commands.push_back(
            {.menu = "Edit",
             .name = name,
             .help =
                 "Choose the lattice that pictures are drawn from; numbers always come from the samples of the file",
             .words = "cartesian bcc cc resample cells layers thickness",
             .run = [&workbench, lattice] { workbench.session().data.lattice = lattice; },
             .enabled =
                 [&workbench, lattice] {
                     const Document& document = workbench.document();
                     if (!document.loaded()) return false;
                     const volume::BrickSource& numbers = *document.sources().numbers;
                     return canChooseLattice(document.session().data, numbers, document.sources().origin) &&
                            (lattice != PictureLattice::Even || drawsToScale(lattice, numbers.info()));
                 },
             .checked =
                 [&workbench, lattice] {
                     const Document& document = workbench.document();
                     const PictureLattice chosen = document.session().data.lattice;
                     return lattice ==
                            (document.loaded() ? latticeFor(chosen, document.sources().numbers->info()) : chosen);
                 }});
    struct Grids {
        ShownGrids grids;
        const char* name;
    };
    for (const Grids& one : {Grids{ShownGrids::Both, "-Both grids of D4* or BCC"},
                             {ShownGrids::First, "First grid of D4* or BCC alone, as stored"},
                             {ShownGrids::Second, "Second grid of D4* or BCC alone, as stored"}})
        commands.push_back(
            {.menu = "Edit",
             .name = one.name,
             .help = "Choose what is shown of an archive on the body-centred lattice, or on that in space and time: "
                     "both of "
                     "its grids (of D4* one is computed from other times), or one alone with its samples as stored",
             .words = "lattice bcc frames sublattice space and time four-dimensional",
             .run = [&workbench, grids = one.grids] { workbench.session().data.grids = grids; },
             .enabled =
                 [&workbench] {
                     const Document& document = workbench.document();
                     return document.loaded() && isArchive(document.session().data) &&
                            (document.sources().origin.lattice.ends_with("D4*") ||
                             document.sources().origin.lattice.ends_with("BCC"));
                 },
             .checked = [&workbench, grids = one.grids] { return workbench.session().data.grids == grids; }});
    return commands;
}

/// Adds differences of the parameter shown first to other times; the list of derived parameters offers further ones.
std::vector<Command> differenceCommands(Workbench& workbench) {
    const auto command = [&workbench](const char* name, const char* help, volume::OtherTime which) -> Command {
        return {
            .menu = "",
            .name = name,
            .help = help,
            .words = "difference change subtract delta derived",
            .run =
                [&workbench, which] {
                    const volume::DatasetInfo& info = workbench.document().info();
                    Session& session = workbench.session();
                    const auto channel = resolveChannel(info, session, "");
                    if (!channel) return;
                    const std::string of = info.channel(*channel).name;
                    workbench.message(showDifference(session, info, of, {which, session.time}));
                },
            .enabled =
                [&workbench] { return workbench.document().loaded() && workbench.document().info().times.size() > 1; }};
    };
    return {command("Minus another time: first", "Show the parameter minus its values at the first time",
                    volume::OtherTime::First),
            command("Minus another time: previous", "Show the parameter minus its values at the previous time",
                    volume::OtherTime::Previous),
            command("Minus another time: last", "Show the parameter minus its values at the last time",
                    volume::OtherTime::Last),
            command("Minus another time: the time shown", "Show the parameter minus its values at the time shown now",
                    volume::OtherTime::Time)};
}

/// Brings the panel of derived parameters to the front.
void showData(Workbench& workbench) {
    Session& session = workbench.session();
    for (const auto& [pane, view] : session.views)
        if (std::holds_alternative<DataView>(view)) return workbench.panes().show(session, pane);
    workbench.panes().open(session, DataView{}, workbench.look().scale());
}

/// Adds a derived parameter of each kind, from the parameter shown first. Differences have commands of their own.
std::vector<Command> derivedCommands(Workbench& workbench) {
    std::vector<Command> commands;
    for (std::size_t kind = 0; kind < volume::kDerivedKinds; ++kind) {
        const volume::DerivedRecipe recipe = volume::recipeOfKind(kind);
        const volume::DerivedKind& own = volume::kindOf(recipe);
        if (own.words.empty()) continue;
        bool ofVector = false;
        std::visit(
            [&](const auto& each) {
                volume::forEachInput(each, [&](const std::string&, bool isVector) { ofVector = ofVector || isVector; });
            },
            recipe);
        const auto channel = [&workbench] {
            return resolveChannel(workbench.document().info(), workbench.session(), "");
        };
        std::string name(own.title);
        name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
        commands.push_back(
            {.menu = "",
             .name = "Add derived parameter: " + name,
             .help = "Add a parameter computed from others; Derived parameters in the pane Data has its settings",
             .words = "new compute calculate computed " + std::string(own.words),
             .run =
                 [&workbench, channel, kind] {
                     const volume::DatasetInfo& info = workbench.document().info();
                     const auto of = channel();
                     if (!of) return;
                     workbench.message("New parameter: " +
                                       addDerived(workbench.session(), newDerived(info, kind, info.channel(*of).name)));
                     showData(workbench);
                 },
             .enabled =
                 [&workbench, channel, ofVector] {
                     return workbench.document().loaded() && channel().has_value() &&
                            (!ofVector || !firstVector(workbench.document().info()).empty());
                 }});
    }
    return commands;
}

/// Gives the layer selected a transfer function of the library.
void applyToSelected(Workbench& workbench, const vis::TransferRecipe& recipe) {
    Session changed = workbench.session();
    const Session shown = sessionShownIn(changed, volumePane(changed));
    const auto to = functionOfLayer(shown, workbench.source()->info(), selectedLayer(shown));
    if (!to) return workbench.message("there is no layer to colour", true);
    try {
        applyRecipe(changed, *workbench.source(), *to, recipe);
        workbench.document().replace(std::move(changed), recipe.name + " for " + to->function);
    } catch (const Error& error) {
        workbench.message(error.what(), true);
    }
}

/// Shows the library in the first view of transfer functions, or in a new one.
void showLibrary(Workbench& workbench) {
    for (auto& [pane, view] : workbench.session().views)
        if (auto* transfer = std::get_if<TransferView>(&view)) {
            transfer->library = true;
            return workbench.panes().show(workbench.session(), pane);
        }
    TransferView view;
    view.library = true;
    workbench.panes().open(workbench.session(), view, workbench.look().scale());
}

std::vector<Command> transferCommands(Workbench& workbench) {
    const auto loaded = [&workbench] { return workbench.document().loaded(); };
    std::vector<Command> commands = {
        {.menu = "Edit",
         .name = "-Library of transfer functions",
         .help = "Show transfer functions by name, as pictures of the data (CT bone, gas, temperature, ...)",
         .words = "presets opacity colours CT MR bone skin",
         .run = [&workbench] { showLibrary(workbench); },
         .enabled = loaded}};
    for (const vis::TransferRecipe& recipe : vis::transferLibrary())
        commands.push_back({.menu = "",
                            .name = "Transfer function: " + recipe.name,
                            .help = recipe.help + "; for the layer selected",
                            .words = "library preset opacity colours",
                            .run = [&workbench, &recipe] { applyToSelected(workbench, recipe); },
                            .enabled = loaded});
    return commands;
}

} // namespace

std::vector<Command> editCommands(Workbench& workbench) {
    std::vector<Command> all;
    for (const auto make : {historyCommands, brushCommands, placeCommands, timeCommands, latticeCommands, planeCommands,
                            differenceCommands, derivedCommands, transferCommands}) {
        std::vector<Command> commands = make(workbench);
        std::ranges::move(commands, std::back_inserter(all));
    }
    return all;
}

} // namespace tessera::app
