#pragma once

#include "codec/container/container.h"

#include <cstdio>
#include <string>

namespace tessera::codec {

/// The file of an archive that is being written: bytes are appended; a commit makes them part of the archive.
///
/// A new file has a temporary name beside its path. If there is no file of that name yet, it gets its name with the
/// first commit, so that readers see it grow, and the destructor removes it if finish() was not called. An existing
/// file is replaced by finish() only. A file that is appended to keeps every commit.
class GrowingFile {
public:
    /// A new file; its first bytes are reserved for the headers. Throws MachineError when it cannot be created.
    explicit GrowingFile(const std::string& path);
    /// Continues behind the archive with this header; bytes behind it are cut off. Throws Error when the file contains
    /// another archive, or another program is writing it.
    GrowingFile(const std::string& path, const Header& header);
    ~GrowingFile();
    GrowingFile(const GrowingFile&) = delete;
    GrowingFile& operator=(const GrowingFile&) = delete;

    std::uint64_t position() const { return position_; }
    /// Throws MachineError, as all below do, when the disk is full or gone.
    void append(std::span<const std::byte> bytes);
    /// Writes a header whose fileSize is the position, after everything before it has reached the disk.
    void commit(const Header& header);
    /// Gives the file its name and closes it.
    void finish();

private:
    enum class Kind { Fresh, Replacing, Appending };
    [[noreturn]] void fail() const;
    void lock();
    void sync();
    void writeHeaders(const Header& header);

    std::string path_, temporary_;
    Kind kind_ = Kind::Fresh;
    std::FILE* file_ = nullptr;
    std::uint64_t position_ = 0, committed_ = 0;
    Header header_;
};

} // namespace tessera::codec
