#pragma once

#include "app/history/parameter_path.h"
#include "app/session/session.h"
#include "app/ui/widgets.h"

#include <imgui.h>
#include <optional>
#include <string>
#include <vector>

namespace tessera::app {

/// The widget of one parameter of a session, named by its JSON pointer; true when it changed. Draws nothing where there
/// is no such parameter or it is edited in a view alone.
bool drawParameter(Session& session, const std::string& path, const WidgetContext& context);

/// The widget of one parameter of any described value; true when it changed.
template <class T> bool drawMember(T& value, const std::string& path, const WidgetContext& context) {
    bool changed = false;
    std::optional<Range> scale;
    std::string unit;
    ImGui::PushID(path.c_str());
    visitParameter(value, path, MemberToWidget{context, changed, scale, unit});
    ImGui::PopID();
    return changed;
}

/// A list of the settings `paths` with a field to search it; true when one was chosen.
bool chooseParameter(const char* id, const Session& session, const std::vector<std::string>& paths, std::string& search,
                     std::string& path);

} // namespace tessera::app
