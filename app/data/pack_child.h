#pragma once

#include "volume/base/progress.h"
#include "volume/import/import.h"

#include <string>
#include <vector>

namespace tessera::app {

/// Summary of an archive made by `tessera pack`.
struct PackedArchive {
    double sourceBytes = 0, archiveBytes = 0, seconds = 0;
};

/// Runs `program pack files... -o output` as a child process, so that a long or crashing import never touches the
/// window; its progress lines become `progress`, whose stop ends the child. Throws Error with the child's last line of
/// stderr when it fails (nothing is left at `output` then) and Cancelled.
PackedArchive packInChild(const std::string& program, const std::vector<std::string>& files,
                          const volume::ImportOptions& import, const std::string& output, const Progress& progress);

} // namespace tessera::app
