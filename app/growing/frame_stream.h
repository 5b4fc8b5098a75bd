#pragma once

#include "app/growing/growing_output.h"

namespace tessera::app {

/// `tessera pack -`: frames of raw samples on standard input, as `--raw` states them for a file of one time.
struct StreamRequest {
    GrowingRequest archive;
    bool append = false;     ///< continue the archive, with its options
    double timeStep = 1;     ///< frame n of the archive has the time n * timeStep,
    bool timesGiven = false; ///< unless each frame begins with its time, an f64 in the byte order of the samples
};

/// Appends each frame to the archive as soon as it is whole, a line on stdout for each, until the input ends or SIGINT
/// or SIGTERM arrives. Frames with stated times that the archive has already are left out. Throws Error if nothing or a
/// part of a frame arrived last, and as GrowingOutput does.
void packStream(const StreamRequest& request);

} // namespace tessera::app
