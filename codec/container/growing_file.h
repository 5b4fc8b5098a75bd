#pragma once

#include "codec/container/container.h"

#include <cstdio>
#include <string>

namespace tessera::codec {

/// The file of an archive that is being written: bytes are appended; a commit makes them part of the archive.
///
/// A new file is written under a temporary name beside its path. If no file of that name exists, the first commit
/// renames it, so that readers see it grow, and the destructor removes it if finish() was not called. An existing file
/// is only replaced by finish(). Appending keeps every commit. Where the file system has locks, nobody else can write
/// the archive meanwhile, nor replace it.
class GrowingFile {
public:
    /// Creates a file with space for the headers. Throws MachineError when it cannot be created, Error when another
    /// program is writing an archive there.
    explicit GrowingFile(const std::string& path);
    /// Continues an archive with this header; bytes beyond it are truncated. Throws Error when the file contains
    /// another archive or another program is writing it.
    GrowingFile(const std::string& path, const Header& header);
    ~GrowingFile();
    GrowingFile(const GrowingFile&) = delete;
    GrowingFile& operator=(const GrowingFile&) = delete;

    std::uint64_t position() const { return position_; }
    /// Where the bytes appended so far can be read now. Throws MachineError.
    const std::string& readablePath() const;
    /// Throws MachineError, as all functions below, when the disk is full or unavailable.
    void append(std::span<const std::byte> bytes);
    /// Flushes everything to disk, then writes a header whose fileSize is the current position.
    void commit(const Header& header);
    /// Renames the file if necessary and closes it. Throws Error when the archive is no longer where it was.
    void finish();

private:
    enum class Kind { Fresh, Replacing, Appending };
    [[noreturn]] void fail() const;
    void lock(int descriptor) const;
    void lockReplaced();
    void giveUp();
    void sync();
    void writeHeaders(const Header& header);

    std::string path_, temporary_;
    Kind kind_ = Kind::Fresh;
    std::FILE* file_ = nullptr;
    int replaced_ = -1; ///< the archive that is replaced, locked
    std::uint64_t position_ = 0, committed_ = 0;
    Header header_;
};

} // namespace tessera::codec
