#pragma once

#include "codec/container/container.h"

#include <cstdio>
#include <string>

namespace tessera::codec {

/// The file of an archive under construction: bytes are appended, a commit makes them count.
///
/// A new file is made under a temporary name beside its path. Where nothing is there yet it takes its name with the
/// first commit, so that readers see it grow, and disappears with an object that did not finish. Where a file is there
/// already, that one stays until finish() replaces it. A file that is appended to keeps every commit.
class GrowingFile {
public:
    /// A new file; its first bytes are left for the headers. Throws MachineError when it cannot be made.
    explicit GrowingFile(const std::string& path);
    /// Goes on behind the archive with this header; bytes behind it are cut off. Throws Error when the file holds
    /// another archive, or another program is writing it.
    GrowingFile(const std::string& path, const Header& header);
    ~GrowingFile();
    GrowingFile(const GrowingFile&) = delete;
    GrowingFile& operator=(const GrowingFile&) = delete;

    std::uint64_t position() const { return position_; }
    /// Throws MachineError, as all below do, when the disk is full or gone.
    void append(std::span<const std::byte> bytes);
    /// Makes a header hold whose fileSize is the position, first on disk everything before it.
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
