#include "app/views/data/new_entry.h"

#include <algorithm>

namespace tessera::app {

SceneLists listsOf(const Session& session) {
    return {session.lenses, session.selection.brushes, session.clips, session.lighting.lights};
}

std::optional<SceneTask> grownList(const SceneLists& before, const SceneLists& now) {
    std::optional<SceneTask> grown;
    int changes = 0;
    const auto compare = [&](const auto& then, const auto& list, SceneTask task) {
        if (then == list) return;
        ++changes;
        if (list.size() == then.size() + 1 && std::equal(then.begin(), then.end(), list.begin())) grown = task;
    };
    compare(before.lenses, now.lenses, SceneTask::Lenses);
    compare(before.brushes, now.brushes, SceneTask::Brushes);
    compare(before.clips, now.clips, SceneTask::Clips);
    compare(before.lights, now.lights, SceneTask::Light);
    return changes == 1 ? grown : std::nullopt;
}

} // namespace tessera::app
