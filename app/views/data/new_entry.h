#pragma once

#include "app/edits/scene_task.h"

#include <optional>

namespace tessera::app {

/// The lists in which things are made elsewhere: by drags in plots, commands and menus.
struct SceneLists {
    std::vector<vis::Lens> lenses;
    std::vector<vis::Brush> brushes;
    std::vector<vis::Clip> clips;
    std::vector<vis::Light> lights;
};
SceneLists listsOf(const Session& session);

/// The list that has one entry more at its end than it had, while nothing else differs. A session that was replaced (a
/// layout, say) mostly differs by more.
std::optional<SceneTask> grownList(const SceneLists& before, const SceneLists& now);

} // namespace tessera::app
