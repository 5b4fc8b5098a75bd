#include "volume/system/locked_file.h"

#include "volume/base/error.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace tessera {

bool leadsTo(const std::string& path, int descriptor) {
    struct stat named {};
    struct stat open {};
    return ::stat(path.c_str(), &named) == 0 && ::fstat(descriptor, &open) == 0 && named.st_dev == open.st_dev &&
           named.st_ino == open.st_ino;
}

std::optional<LockedFile> LockedFile::tryLock(const std::string& path, Kind kind) {
    constexpr mode_t kMode = 0666; // less the umask
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kMode);
    // ESTALE: another machine has removed it, or its folder.
    const auto isGone = [] { return errno == ENOENT || errno == ESTALE; };
    if (file < 0 && isGone()) return std::nullopt;
    if (file < 0) throw MachineError(std::string("cannot open: ") + std::strerror(errno), path);
    LockedFile lock(file);
    const int wanted = kind == Kind::Shared ? LOCK_SH : LOCK_EX;
    while (::flock(file, wanted | LOCK_NB) != 0) {
        if (errno == EINTR) continue;
        if (errno == EWOULDBLOCK || isGone()) return std::nullopt;
        throw MachineError(std::string("cannot be locked: ") + std::strerror(errno), path);
    }
    return lock;
}

LockedFile::LockedFile(LockedFile&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

LockedFile& LockedFile::operator=(LockedFile&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
}

LockedFile::~LockedFile() {
    if (file_ >= 0) ::close(file_);
}

bool LockedFile::isAt(const std::string& path) const {
    return leadsTo(path, file_);
}

} // namespace tessera
