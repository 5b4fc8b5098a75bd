#pragma once

#include "app/document/document.h"
#include "app/ui/jobs.h"
#include "app/ui/messages.h"

#include <string>

/// An iso-layer of the session as a mesh file.
namespace tessera::app {

/// The iso-layer selected in a layers view, else the first visible one; -1 where there is none.
int chosenSurface(const Session& session);
/// Writes its surface at full resolution in the background; the ending of `path` says how, none means PLY.
void exportSurface(const Document& document, std::string path, Jobs& jobs, Messages& messages);

} // namespace tessera::app
