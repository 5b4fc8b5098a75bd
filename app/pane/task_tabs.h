#pragma once

#include "app/pane/controls.h"

#include <optional>
#include <span>

/// The tabs within a pane, one for each thing that it is used for.
namespace tessera::app {

struct TaskTab {
    const char* name;
    Icon icon;
    const char* help;
    bool marked = false; ///< a dot says that there is something in it
};

/// A row of tabs over the width of the pane. Where their names have no room the others have icons, and where there are
/// no icons, or no room for them either, there are several rows. Returns the tab that was pressed in this frame.
std::optional<std::size_t> drawTaskTabs(const ViewContext& context, std::span<const TaskTab> tabs, std::size_t front);

} // namespace tessera::app
