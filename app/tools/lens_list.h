#pragma once

#include "app/pane/view_context.h"
#include "app/queries/statistics_query.h"
#include "app/ui/fitted_text.h"

#include <map>

/// The list of lenses with all their settings, and statistics of what is inside them.
namespace tessera::app {

/// Statistics of the lenses that are unfolded.
struct LensStatistics {
    std::map<std::string, AsyncStatistics> byLens;
};

/// Every lens with its switches, settings, layers and numbers, and a button that adds one at the cursor. The list goes
/// to `next` and unfolds it.
void drawLensList(ViewContext& context, const std::string& pane, LensStatistics& statistics, NextEntry next = {});

/// A lens of an effect around the cursor, with a name and colour of its own, that fits the shown box.
vis::Lens newLens(const Session& session, const volume::DatasetInfo& info, vis::LensEffect effect);

/// Adds one of these.
void addLens(Session& session, const volume::DatasetInfo& info, vis::LensEffect effect);

/// Adds a lens at the cross-hair in which a technique replaces the other layers.
void addLensWith(Session& session, const volume::DatasetInfo& info, vis::Technique technique);

/// Adds a lens in which a parameter is drawn instead, as a volume or as an iso-surface that shows something.
void addLensOf(Session& session, const volume::BrickSource& source, const std::string& channel, bool surface);

/// Renames a lens; references to it follow.
void renameLens(Session& session, std::size_t index, const std::string& name);

/// Moves a lens in the order in which lenses lie over each other.
void moveLens(Session& session, std::size_t from, std::size_t to);

/// Removes a lens; its layers are no longer drawn.
void removeLens(Session& session, std::size_t index);

/// Items of a menu that add a lens.
void drawLensMenu(ViewContext& context);

/// A choice of lens; "" reads as `none`.
bool chooseLens(const char* id, const Session& session, std::string& value, const char* none);

} // namespace tessera::app
