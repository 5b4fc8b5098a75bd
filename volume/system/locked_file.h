#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tessera {

/// Whether a path leads to an open file: others may have moved, removed or replaced it.
bool leadsTo(const std::string& path, int descriptor);

/// A lock on a file (flock), also between machines where the file system has such locks. It ends with the object or the
/// process, however the process ends.
class LockedFile {
public:
    enum class Kind : std::uint8_t { Shared, Exclusive };

    /// Locks a file, which is made if there is none. Nothing if another process has a lock that does not allow it, or
    /// if the folder is missing or removed meanwhile. Throws MachineError when the file cannot be opened or its file
    /// system has no locks.
    static std::optional<LockedFile> tryLock(const std::string& path, Kind kind);

    LockedFile(LockedFile&& other) noexcept;
    LockedFile& operator=(LockedFile&& other) noexcept;
    ~LockedFile();

    /// Whether this path still leads to the file: a lock on one that has been moved or removed keeps nobody out.
    bool isAt(const std::string& path) const;

private:
    explicit LockedFile(int file) : file_(file) {}
    int file_ = -1;
};

} // namespace tessera
