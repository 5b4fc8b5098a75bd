#pragma once

#include "app/session/session.h"
#include "app/ui/widgets.h"

namespace tessera::app {

/// The widget of one parameter of a session, named by its JSON pointer; true when it changed. Draws nothing where there
/// is no such parameter or it is edited in a view alone.
bool drawParameter(Session& session, const std::string& path, const WidgetContext& context);

/// A list of the settings `paths` with a field to search it; true when one was chosen.
bool chooseParameter(const char* id, const Session& session, const std::vector<std::string>& paths, std::string& search,
                     std::string& path);

} // namespace tessera::app
