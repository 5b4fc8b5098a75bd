#pragma once

#include "volume/base/progress.h"

#include <string>

namespace tessera::app {

/// Throws MachineError where ffmpeg is not installed.
void requireFfmpeg();

/// Joins numbered pictures (`pattern` as ffmpeg names them, e.g. "out/frame-%04d.png") to a video with ffmpeg; the
/// ending of `path` says which kind. Sizes are padded to even ones. Throws MachineError when ffmpeg fails.
void writeVideo(const std::string& pattern, std::size_t count, double framesPerSecond, const std::string& path,
                const Progress& progress);

} // namespace tessera::app
