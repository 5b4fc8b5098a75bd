#pragma once

#include "app/pane/view_context.h"

#include <string>

/// Entries of menus that add callouts, and those of a callout.
namespace tessera::app {

/// "Callout of lens": adds one of a lens, by its name; "": of the newest, or where there is none of a new one at the
/// cross-hair that only marks its place.
void calloutOfLens(Session& session, const volume::DatasetInfo& info, std::string lens = {});
/// "Callout of brush": adds one of the newest brush; there must be one.
void calloutOfBrush(Session& session, const volume::DatasetInfo& info);

/// The entries that add one in the menu of a volume view. `lens`: under the mouse, "" = none.
void drawCalloutEntries(ViewContext& context, const std::string& lens);
/// The entry for a plane: x, y, z or the pane of an oblique slice; of a parameter, "" = that of the first layer.
void drawPlaneCalloutEntry(ViewContext& context, const std::string& plane, const std::string& channel);

/// The menu of a callout in the window being made: what it shows, of which parameter, time and turn; others to compare
/// with. Returns true when it is to be removed.
bool drawCalloutMenu(ViewContext& context, std::size_t callout);

} // namespace tessera::app
