#pragma once

#include <string>
#include <vector>

namespace tessera::volume {

/// The files of a folder that are opened when the folder is: a case of OpenFOAM, its single list of files (.pvd,
/// .series), or the files of the commonest format, of which pictures count only where there is nothing else. Throws
/// Error where there is none, or several lists.
std::vector<std::string> filesOfFolder(const std::string& folder);

} // namespace tessera::volume
