#include "volume/system/scratch_file.h"

#include "volume/base/error.h"
#include "volume/system/input_file.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sys/stat.h>
#include <unistd.h>

namespace tessera::volume {

ScratchFile::ScratchFile(const std::string& folder) {
    std::string name = (folder.empty() ? std::string(".") : folder) + "/.tessera-scratch-XXXXXX";
    file_ = ::mkstemp(name.data());
    if (file_ < 0)
        throw MachineError(std::string("a temporary file cannot be created: ") + std::strerror(errno), folder);
    ::unlink(name.c_str());
}

std::unique_ptr<const ScratchFile> ScratchFile::of(const std::string& path) {
    try {
        return std::unique_ptr<const ScratchFile>(new ScratchFile(openInputDescriptor(path)));
    } catch (const Error& error) {
        throw MachineError("cannot be read: " + error.reason(), path);
    }
}

ScratchFile::~ScratchFile() {
    ::close(file_);
}

void ScratchFile::write(std::uint64_t at, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t done = ::pwrite(file_, bytes.data(), bytes.size(), off_t(at));
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) throw MachineError(std::string("a temporary file cannot be written: ") + std::strerror(errno));
        bytes = bytes.subspan(std::size_t(done));
        at += std::uint64_t(done);
    }
}

void ScratchFile::read(std::uint64_t at, std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t done = ::pread(file_, bytes.data(), bytes.size(), off_t(at));
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) throw MachineError(std::string("a temporary file cannot be read: ") + std::strerror(errno));
        bytes = bytes.subspan(std::size_t(done));
        at += std::uint64_t(done);
    }
}

std::uint64_t ScratchFile::size() const {
    struct stat about {};
    if (::fstat(file_, &about) != 0)
        throw MachineError(std::string("a temporary file cannot be read: ") + std::strerror(errno));
    return std::uint64_t(about.st_size);
}

} // namespace tessera::volume
