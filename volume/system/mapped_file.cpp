#include "volume/system/mapped_file.h"

#include "volume/base/error.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tessera {

MappedFile::MappedFile(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) throw Error(std::strerror(errno), path);
    struct stat state {};
    void* mapping = nullptr;
    const bool regular = ::fstat(file, &state) == 0 && S_ISREG(state.st_mode);
    if (regular && state.st_size > 0) {
        size_ = static_cast<std::size_t>(state.st_size);
        mapping = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file, 0);
    }
    const int problem = errno;
    ::close(file);
    if (!regular) throw Error("not a regular file", path);
    if (mapping == MAP_FAILED) throw Error(std::strerror(problem), path);
    data_ = static_cast<const std::byte*>(mapping);
}

MappedFile::~MappedFile() {
    if (data_) ::munmap(const_cast<std::byte*>(data_), size_);
}

} // namespace tessera
