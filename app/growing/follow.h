#pragma once

#include "app/growing/arriving_files.h"
#include "app/growing/growing_output.h"

#include <optional>
#include <string>

namespace tessera::app {

/// `tessera pack --follow`.
struct FollowRequest {
    std::string pattern; ///< of the files of one series, with * or ?
    GrowingRequest archive;
    ArrivalTimes arrival;
    std::optional<double> untilIdle; ///< end after so many seconds without a new file
};

/// Appends files to an archive as they arrive, a line on stdout for each time, until SIGINT, SIGTERM or `untilIdle`; a
/// file that is being appended is finished. Throws Error for options that need the whole series, if the archive is of
/// another series or other options, and in the end if files were left out; MachineError if the archive cannot be
/// written.
void follow(const FollowRequest& request);

} // namespace tessera::app
