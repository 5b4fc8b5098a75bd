#include "app/data/first_curve.h"
#include "app/edits/multiples.h"
#include "app/pane/view_parts.h"
#include "app/session/shown_scene.h"
#include "app/ui/dock_layout.h"
#include "app/ui/time_text.h"
#include "app/workbench/fit_box.h"
#include "app/workbench/workbench.h"
#include "app/workbench/workbench_commands.h"

#include <algorithm>
#include <cmath>
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

constexpr std::size_t kMostMultiples = 9;
constexpr float kLeastCell = 66000; ///< square design pixels of a view among many

/// Shows the views in place of the volume view clicked last, as one step; what was wholly visible before stays so.
void showMultiples(Workbench& workbench, std::vector<VolumeView> views, Session session, const std::string& step) {
    const float scale = workbench.look().scale();
    const std::string from = volumePane(session);
    const vis::WorldFrame world = vis::worldFrame(workbench.document().info(), session.stretch);
    if (const VolumeView* view = volumeView(session, from); view && view->camera) session.camera = *view->camera;
    const glm::dvec2 extent = boxExtent(session.camera, world);
    const DockNode* const place = placeOfMultiples(session, from);
    const ImVec2 size = place ? sizeOf(session, *place, scale) : ImGui::GetMainViewport()->Size;
    const double aspect = double(size.x / size.y), object = std::clamp(extent.x / extent.y, 0.5, 3.0);
    const bool wasWhole = seesWholeBox(session, from, world, scale);
    const int count = static_cast<int>(views.size());
    makeMultiples(session, from, std::move(views), aspect, object);
    const double columns = gridColumns(count, aspect, object), rows = std::ceil(count / columns);
    const double cell = double(size.x) / columns / std::max(1.0, double(size.y) / rows - kTabStrip * double(scale));
    if (wasWhole) vis::fit(session.camera, world, cell);
    workbench.document().replace(std::move(session), step);
}

void showByParameter(Workbench& workbench) {
    const volume::DatasetInfo& info = workbench.document().info();
    Session session = workbench.session();
    std::vector<std::string> names;
    for (const int channel : comparedChannels(info)) names.push_back(info.channel(channel).name);
    const std::size_t all = names.size();
    names.resize(std::min(all, kMostMultiples));
    std::string text;
    for (const std::string& name : names) {
        aimFunction(session, *workbench.source(), name);
        text += (text.empty() ? ": " : ", ") + name;
    }
    text = std::to_string(names.size()) + (names.size() < all ? " of " + std::to_string(all) : "") +
           " parameters side by side" + text;
    std::vector<VolumeView> views = viewsByParameter(session, volumePane(session), names);
    showMultiples(workbench, std::move(views), std::move(session), "One view per parameter");
    workbench.message(text);
}

void showByTime(Workbench& workbench) {
    const volume::DatasetInfo& info = workbench.document().info();
    Session session = workbench.session();
    const std::string from = volumePane(session);
    const DockNode* const place = placeOfMultiples(session, from);
    const float scale = workbench.look().scale();
    const ImVec2 size = place ? sizeOf(session, *place, scale) : ImGui::GetMainViewport()->Size;
    std::size_t most = kMostMultiples;
    while (most > 4 && size.x * size.y / (scale * scale) / float(most) < kLeastCell) most = most > 6 ? 6 : 4;
    std::vector<double> times;
    for (const std::size_t index : spreadTimes(info.times.size(), most)) times.push_back(info.times[index]);
    const std::string text = std::to_string(times.size()) +
                             (times.size() < info.times.size() ? " of " + std::to_string(info.times.size()) : "") +
                             " times side by side, " + timeText(info, times.front()) + " to " +
                             timeText(info, times.back()) + "; the legend in the last is of all";
    std::vector<VolumeView> views = viewsByTime(session, from, times);
    showMultiples(workbench, std::move(views), std::move(session), "One view per time");
    workbench.message(text);
}

std::vector<Command> multipleCommands(Workbench& workbench) {
    const auto loaded = [&workbench] { return workbench.document().loaded(); };
    return {{.menu = "View",
             .name = "-One view per parameter",
             .help = "Show every parameter in a volume view of its own, all from one camera, in place of the one "
                     "clicked last",
             .words = "small multiples grid side by side trellis facets several all compare volumes",
             .run = [&workbench] { showByParameter(workbench); },
             .enabled = [&workbench,
                         loaded] { return loaded() && comparedChannels(workbench.document().info()).size() > 1; },
             .needs = "several parameters"},
            {.menu = "View",
             .name = "One view per time",
             .help = "Show times from the first to the last in a volume view each, all from one camera and with one "
                     "legend, in place of the one clicked last",
             .words = "small multiples grid side by side trellis facets several all compare volumes steps",
             .run = [&workbench] { showByTime(workbench); },
             .enabled = [&workbench, loaded] { return loaded() && workbench.document().info().times.size() > 1; },
             .needs = "data with several times"}};
}

} // namespace

std::vector<Command> volumeViewCommands(Workbench& workbench) {
    std::vector<Command> commands = linkCommands(workbench);
    std::ranges::move(multipleCommands(workbench), std::back_inserter(commands));
    return commands;
}

} // namespace tessera::app
