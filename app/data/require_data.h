#pragma once

#include <string>
#include <vector>

namespace tessera::app {

/// Throws Error for a file among `paths` that is no data file: a session or a picture that contains one, or an archive
/// beside other files. Throws nothing for files that are missing.
void requireData(const std::vector<std::string>& paths);

} // namespace tessera::app
