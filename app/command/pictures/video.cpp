#include "app/command/pictures/video.h"

#include "volume/base/error.h"
#include "volume/system/process.h"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <unistd.h>

namespace tessera::app {

namespace {

bool installed(const std::string& program) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (::access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0) return true;
    return false;
}

} // namespace

void requireFfmpeg() {
    if (!installed("ffmpeg")) throw MachineError("ffmpeg, which makes the video, is not installed");
}

void writeVideo(const std::string& pattern, std::size_t count, double framesPerSecond, const std::string& path,
                const Progress& progress) {
    requireFfmpeg();
    std::ostringstream rate;
    rate << framesPerSecond;
    try {
        volume::ChildProcess ffmpeg({"ffmpeg", "-nostdin", "-loglevel", "error", "-y", "-framerate", rate.str(), "-i",
                                     pattern, "-frames:v", std::to_string(count), "-vf",
                                     "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", path});
        std::array<std::byte, 256> text;
        while (ffmpeg.read(text, [&] { progress.advance(0.5, path); })) {
        }
        if (const std::string ending = ffmpeg.ending(); !ending.empty()) throw MachineError("ffmpeg " + ending, path);
    } catch (const MachineError&) {
        throw;
    } catch (const Error& error) {
        throw MachineError(error.what(), path);
    }
    progress.advance(1);
}

} // namespace tessera::app
