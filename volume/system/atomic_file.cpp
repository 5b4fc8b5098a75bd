#include "volume/system/atomic_file.h"

#include "volume/base/error.h"
#include "volume/system/part_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace tessera {

AtomicFile::AtomicFile(const std::string& path)
    : path_(path), temporary_(partFileOf(path)), out_(temporary_, std::ios::binary | std::ios::trunc) {
    if (!out_) throw MachineError(std::string("cannot be written: ") + std::strerror(errno), path_);
    removeLeftParts(path);
}

AtomicFile::~AtomicFile() {
    if (done_) return;
    out_.close();
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::write(const void* bytes, std::size_t size) {
    out_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
    if (!out_) throw MachineError("cannot be written (is the disk full?)", path_);
}

void AtomicFile::commit() {
    out_.close();
    if (!out_) throw MachineError("cannot be written (is the disk full?)", path_);
    std::error_code failed;
    std::filesystem::rename(temporary_, path_, failed);
    if (failed) throw MachineError("cannot be written: " + failed.message(), path_);
    done_ = true;
}

} // namespace tessera
