#include "app/edits/scene_task.h"

namespace tessera::app {

namespace {

/// The pane that is to show a task; "" if there is none.
std::string paneFor(const Session& session, SceneTask task) {
    std::string first;
    for (const auto& [pane, view] : session.views)
        if (const auto* const layers = std::get_if<LayersView>(&view)) {
            if (layers->task == task) return pane;
            if (first.empty()) first = pane;
        }
    return first;
}

} // namespace

bool takesTask(const Session& session, const std::string& pane, SceneTask task) {
    const std::string taking = paneFor(session, task);
    return taking.empty() || taking == pane || !session.views.contains(pane);
}

std::string turnToTask(Session& session, SceneTask task, int entry) {
    std::string pane = paneFor(session, task);
    if (pane.empty()) return pane;
    auto& layers = std::get<LayersView>(session.views.at(pane));
    layers.task = task;
    layers.next = task == SceneTask::Layers ? -1 : entry;
    if (task == SceneTask::Layers && entry >= 0) layers.selected = entry;
    return pane;
}

void showTask(Session& session, SceneTask task, int entry) {
    const std::string pane = turnToTask(session, task, entry);
    if (!pane.empty() && session.dock.maximised.empty()) showPane(session.dock, pane);
}

} // namespace tessera::app
