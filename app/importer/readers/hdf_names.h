#pragma once

#include <string>

namespace tessera::importer {

/// Throws std::runtime_error where an HDF5 file names others outside of its folder (external links, samples in external
/// files, virtual data sets) and that is refused (letNameOutside), also in the files that it links to, and where groups
/// are nested deeper than any program writes them, which the library walks by calling itself. Nothing for other files,
/// and for damaged ones, of which their readers tell.
void checkHdfNames(const std::string& path);

} // namespace tessera::importer
