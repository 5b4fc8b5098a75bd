#pragma once

#include "app/history/session_file.h"
#include "app/session/session.h"
#include "volume/bricks/brick_source.h"

#include <string>
#include <string_view>
#include <vector>

/// Layouts that ship with the program or were saved, shown with any data.
namespace tessera::app {

/// Names of the layouts that ship with the program, and the file of a layout given by name or path. Throws Error.
std::vector<std::string> layoutNames();
std::string findLayout(const std::string& nameOrPath);

/// Whether a layout that ships with the program shows a technique or a look rather than helping with a task.
bool isDemonstration(std::string_view layout);

/// Whether both are the same files, or the same model, whatever its settings.
bool sameData(const DataRef& a, const DataRef& b);

/// Applies a layout to a data set: what it omits, or what does not fit these data, comes from the defaults for the
/// data. Variants of a comparison that are other sizes of another model are omitted.
Session applyLayout(const SessionDocument& layout, const volume::DatasetInfo& info, const DataRef& data,
                    std::vector<std::string>& messages);

/// Moves surfaces of a session made from a layout to where these data have one: those of a parameter that the layout
/// did not name, and those whose value does not exist at the session's time (or, with data other than the layout's, is
/// near the ends of the existing range), to surfaceValue(). One message for each parameter that has no surface at all.
/// Reads statistics and coarse bricks of one time; surfaces with a damaged brick are unchanged.
void fitSurfaces(Session& session, const volume::BrickSource& source, const Session& layout,
                 std::vector<std::string>& messages);

/// A layout chosen for data that are already shown: theme, time, cross-hair and the user's brushes (keepOwnBrushes)
/// stay as in `shown`, and where the layout was made with other data the camera sees all of these. Throws Error.
Session changeLayout(const SessionDocument& layout, const volume::BrickSource& source, const Session& shown,
                     std::vector<std::string>& messages);

} // namespace tessera::app
