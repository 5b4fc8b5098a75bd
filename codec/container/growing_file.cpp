#include "codec/container/growing_file.h"

#include "volume/base/error.h"
#include "volume/system/input_file.h"
#include "volume/system/locked_file.h"
#include "volume/system/part_file.h"
#include "volume/system/sync.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <unistd.h>
#include <utility>

namespace tessera::codec {

GrowingFile::GrowingFile(const std::string& path)
    : path_(replacedFile(path)), kind_(std::filesystem::exists(path_) ? Kind::Replacing : Kind::Fresh) {
    lockReplaced();
    removeLeftParts(path_);
    const std::string temporary = partFileOf(path_);
    constexpr mode_t kMode = 0666; // less the umask
    const int opened = ::open(temporary.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kMode);
    file_ = opened < 0 ? nullptr : ::fdopen(opened, "r+b");
    if (!file_) fail();
    try {
        lock(::fileno(file_)); // before anything is cut: another thread may be writing it
        temporary_ = temporary;
        if (::ftruncate(::fileno(file_), 0) != 0) fail();
        append(Bytes(kFirstChunk));
    } catch (...) {
        giveUp();
        throw;
    }
}

GrowingFile::GrowingFile(const std::string& path, const Header& header)
    : path_(path), kind_(Kind::Appending), position_(header.fileSize), committed_(header.fileSize), header_(header) {
    requireFile(path);
    file_ = std::fopen(path.c_str(), "r+be");
    if (!file_) fail();
    try {
        lock(::fileno(file_));
        Bytes head(kFirstChunk);
        const bool read = std::fread(head.data(), 1, head.size(), file_) == head.size();
        const std::uint64_t size = std::filesystem::file_size(path);
        if (!read || parseHeaders(head, size, path).header != header)
            throw Error("the archive has changed since it was opened", path);
        if (::ftruncate(::fileno(file_), static_cast<off_t>(header.fileSize)) != 0 ||
            std::fseek(file_, 0, SEEK_END) != 0)
            fail();
        // A crash may have damaged one copy; writing both again with the same bytes is safe.
        const Bytes bytes = serialise(header);
        for (int copy = 0; copy < 2; ++copy) {
            if (::pwrite(::fileno(file_), bytes.data(), bytes.size(), copy * off_t(kHeaderBytes)) !=
                static_cast<ssize_t>(bytes.size()))
                fail();
            sync();
        }
    } catch (...) {
        std::fclose(file_);
        throw;
    }
}

GrowingFile::~GrowingFile() {
    giveUp();
}

void GrowingFile::giveUp() {
    if (replaced_ >= 0) ::close(std::exchange(replaced_, -1));
    if (!file_) return;
    if (kind_ == Kind::Appending && std::fflush(file_) == 0)
        (void)!::ftruncate(::fileno(file_), static_cast<off_t>(committed_));
    const bool own = kind_ == Kind::Fresh && temporary_.empty() && committed_ > 0 && leadsTo(path_, ::fileno(file_));
    std::fclose(std::exchange(file_, nullptr));
    if (!temporary_.empty())
        std::remove(temporary_.c_str());
    else if (own)
        std::remove(path_.c_str());
}

void GrowingFile::fail() const {
    throw MachineError(std::string("cannot write: ") + std::strerror(errno), path_);
}

void GrowingFile::lock(int descriptor) const {
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return;
    if (errno == EWOULDBLOCK) throw Error("another program is writing this archive", path_);
    // the file system does not support locks
}

/// Keeps others from writing to what lies at the path until it is replaced; throws if one does.
void GrowingFile::lockReplaced() {
    if (replaced_ >= 0) ::close(std::exchange(replaced_, -1)); // another file may lie there by now
    const int replaced = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (replaced < 0) return; // there is nothing, or it cannot be read
    try {
        lock(replaced);
    } catch (...) {
        ::close(replaced);
        throw;
    }
    replaced_ = replaced;
}

void GrowingFile::sync() {
    if (std::fflush(file_) != 0 || ::fsync(::fileno(file_)) != 0) fail();
}

void GrowingFile::append(std::span<const std::byte> bytes) {
    if (!bytes.empty() && std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail();
    position_ += bytes.size();
}

const std::string& GrowingFile::readablePath() const {
    if (std::fflush(file_) != 0) fail();
    return temporary_.empty() ? path_ : temporary_;
}

/// Writes the second copy first, since readers prefer the first: at any time one of the two is complete.
void GrowingFile::writeHeaders(const Header& header) {
    sync();
    const Bytes bytes = serialise(header);
    for (const int copy : {1, 0}) {
        if (::pwrite(::fileno(file_), bytes.data(), bytes.size(), copy * off_t(kHeaderBytes)) !=
            static_cast<ssize_t>(bytes.size()))
            fail();
        sync();
    }
    committed_ = header.fileSize;
}

void GrowingFile::commit(const Header& header) {
    header_ = header;
    if (kind_ == Kind::Replacing) return; // readers cannot see it under its temporary name
    writeHeaders(header);
    if (temporary_.empty()) return;
    lockReplaced(); // of another program, since this one began
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail();
    temporary_.clear();
    syncFolderOf(path_);
}

void GrowingFile::finish() {
    if (kind_ == Kind::Replacing) {
        writeHeaders(header_);
        if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail();
        temporary_.clear();
        kind_ = Kind::Appending; // it has its final name and is kept
        syncFolderOf(path_);
    } else if (!leadsTo(path_, ::fileno(file_))) {
        throw Error("has been moved, removed or replaced by another program while it was written", path_);
    }
    std::FILE* const file = std::exchange(file_, nullptr);
    if (std::fclose(file) != 0) fail();
}

} // namespace tessera::codec
