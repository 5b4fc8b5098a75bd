#pragma once

#include "app/data/sources.h"
#include "app/history/session_file.h"

#include <string>
#include <vector>

/// A layout of the errors of packing, shown with other data than it was made with.
namespace tessera::app {

/// Whether a layout shows packed data beside their originals and `data`, which are not so, could be shown that way:
/// they are packed when they are opened. Archives could not; their originals are elsewhere.
bool packsForErrors(const Session& layout, const DataRef& data);

/// Makes a layout of errors of packing one for these data, which were opened packed beside their originals: of the
/// layout's parameters where they have them, else of others, and adds the errors as derived parameters.
void showErrors(SessionDocument& layout, DataRef& data, Sources& sources, std::vector<std::string>& messages);

inline constexpr const char* kNoOriginals =
    "The layout shows errors of packing, and an archive has no originals to compare with: open the data that it was "
    "packed from in this layout, and they are packed to show them.";

} // namespace tessera::app
