#include "volume/system/atomic_file.h"

#include "volume/base/error.h"
#include "volume/system/part_file.h"
#include "volume/system/sync.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace tessera {

AtomicFile::AtomicFile(const std::string& path)
    : path_(replacedFile(path)), temporary_(partFileOf(path_)), out_(temporary_, std::ios::binary | std::ios::trunc) {
    if (!out_) throw MachineError(std::string("cannot be written: ") + std::strerror(errno), path_);
    removeLeftParts(path_);
}

AtomicFile::~AtomicFile() {
    if (done_) return;
    out_.close();
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::fail() const {
    throw MachineError(std::string("cannot be written: ") + std::strerror(errno != 0 ? errno : EIO), path_);
}

void AtomicFile::write(const void* bytes, std::size_t size) {
    errno = 0;
    if (!out_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size))) fail();
}

void AtomicFile::commit() {
    errno = 0;
    out_.close();
    if (!out_) fail();
    syncFile(temporary_); // before the name: else it might stand for an empty file after a crash
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail();
    done_ = true;
    syncFolderOf(path_);
}

void writeAtomically(const std::string& path, std::string_view text) {
    AtomicFile file(path);
    file.write(text);
    file.commit();
}

} // namespace tessera
