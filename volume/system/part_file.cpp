#include "volume/system/part_file.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <string_view>
#include <sys/file.h>
#include <unistd.h>

namespace tessera {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kPartMark = ".part-";

/// A process with this number exists; one of another user too.
bool processRuns(pid_t pid) {
    return ::kill(pid, 0) == 0 || errno != ESRCH;
}

bool isLocked(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return false;
    const bool locked = ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    ::close(file);
    return locked;
}

} // namespace

std::string replacedFile(const std::string& path) {
    std::error_code unknown;
    const fs::file_type type = fs::status(path, unknown).type();
    if (type == fs::file_type::none) return path; // whoever opens it says why
    if (type != fs::file_type::regular && type != fs::file_type::directory && type != fs::file_type::not_found)
        throw MachineError("is no file, but a device or a pipe", path);
    fs::path file = path;
    while (fs::is_symlink(file, unknown)) { // ends, as the status of links in a circle is an error
        const fs::path target = fs::read_symlink(file, unknown);
        if (unknown) break;
        file = target.is_absolute() ? target : file.parent_path() / target;
    }
    return file.string();
}

std::string partFileOf(const std::string& path) {
    return path + std::string(kPartMark) + std::to_string(::getpid());
}

std::vector<std::string> leftParts(const std::string& path) {
    const fs::path target(path);
    const std::string begin = target.filename().string() + std::string(kPartMark);
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    std::vector<std::string> left;
    std::error_code problem;
    for (fs::directory_iterator at(folder, problem), end; !problem && at != end; at.increment(problem)) {
        const std::string name = at->path().filename().string();
        if (!name.starts_with(begin)) continue;
        pid_t pid = 0;
        const char* const last = name.data() + name.size();
        const auto [read, failed] = std::from_chars(name.data() + begin.size(), last, pid);
        std::error_code unknown;
        if (failed != std::errc() || read != last || pid <= 0) continue;
        if (const fs::file_type type = at->symlink_status(unknown).type();
            type != fs::file_type::regular && type != fs::file_type::directory)
            continue;
        if (!processRuns(pid) && !isLocked(at->path().string())) left.push_back(at->path().string());
    }
    std::sort(left.begin(), left.end());
    return left;
}

void removeLeftParts(const std::string& path) {
    std::error_code ignored;
    for (const std::string& part : leftParts(path)) fs::remove_all(part, ignored);
}

} // namespace tessera
