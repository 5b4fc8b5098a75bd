#pragma once

#include "app/data/arriving_files.h"
#include "codec/container/pack_options.h"
#include "volume/import/import_options.h"

#include <optional>
#include <string>

namespace tessera::app {

/// `tessera pack --follow`.
struct FollowRequest {
    std::string pattern; ///< of the files of one series, with * or ?
    std::string output;  ///< archive; one that exists is continued
    volume::ImportOptions import;
    codec::PackOptions options;
    ArrivalTimes arrival;
    std::optional<double> untilIdle; ///< end after so many seconds without a new file
    bool json = false;               ///< one JSON object for each time
};

/// Appends files to an archive as they arrive, a line on stdout for each time, until SIGINT, SIGTERM or `untilIdle`; a
/// file that is being appended is finished. Throws Error for options that need the whole series, if the archive is of
/// another series or other options, and in the end if files were left out; MachineError if the archive cannot be
/// written.
void follow(const FollowRequest& request);

/// Says on stderr which rules for absent samples and names are used because they were stated before.
void sayRemembered(const volume::ImportOptions& stated, const volume::ImportOptions& used);

} // namespace tessera::app
