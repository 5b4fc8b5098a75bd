#include "volume/system/shader_cache.h"

#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

namespace tessera {

namespace {

namespace fs = std::filesystem;

/// Bytes that must be free where the list has not been made: its own 1.3 MB and the first shaders.
constexpr off_t kRoom = off_t(4) << 20;

/// The folder of Mesa's cache; "" where there is none.
fs::path cacheFolder() {
    constexpr const char* kName = "mesa_shader_cache";
    const auto stated = [](const char* variable) {
        const char* const value = std::getenv(variable);
        return fs::path(value ? value : "");
    };
    for (const char* const variable : {"MESA_SHADER_CACHE_DIR", "MESA_GLSL_CACHE_DIR", "XDG_CACHE_HOME"})
        if (const fs::path folder = stated(variable); !folder.empty()) return folder / kName;
    const fs::path home = stated("HOME");
    return home.empty() ? fs::path() : home / ".cache" / kName;
}

/// Reserves the first bytes of an open file. File systems that cannot are asked for the room they have.
bool reserve(int file, off_t bytes) {
    int failed = 0;
    while ((failed = ::fallocate(file, 0, 0, bytes) == 0 ? 0 : errno) == EINTR) {
    }
    if (failed == 0) return true;
    if (failed != EOPNOTSUPP && failed != ENOSYS) return false;
    struct statvfs room {};
    return ::fstatvfs(file, &room) != 0 || off_t(room.f_bavail) * off_t(room.f_frsize) >= kRoom;
}

bool hasRoom(const fs::path& folder) {
    if (const int index = ::open((folder / "index").c_str(), O_RDWR | O_CLOEXEC); index >= 0) {
        struct stat state {};
        const bool reserved = ::fstat(index, &state) != 0 || state.st_size == 0 || reserve(index, state.st_size);
        ::close(index);
        return reserved;
    }
    fs::path made = folder; // the part of the path that there is
    std::error_code problem;
    while (!fs::is_directory(made, problem) && made.has_parent_path() && made != made.parent_path())
        made = made.parent_path();
    const int probe = ::open(made.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (probe < 0) {
        struct statvfs room {};
        return ::statvfs(made.c_str(), &room) != 0 || off_t(room.f_bavail) * off_t(room.f_frsize) >= kRoom;
    }
    const bool reserved = reserve(probe, kRoom);
    ::close(probe);
    return reserved;
}

} // namespace

void guardShaderCache() {
    const fs::path folder = cacheFolder();
    if (folder.empty() || hasRoom(folder)) return;
    for (const char* const variable : {"MESA_SHADER_CACHE_DISABLE", "MESA_GLSL_CACHE_DISABLE"}) // newer, older
        ::setenv(variable, "true", 1);
}

} // namespace tessera
