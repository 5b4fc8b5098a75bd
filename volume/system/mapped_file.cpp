#include "volume/system/mapped_file.h"

#include "volume/base/error.h"
#include "volume/system/input_file.h"

#include <cerrno>
#include <cstring>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tessera {

MappedFile::MappedFile(const std::string& path) {
    const int file = openInputDescriptor(path);
    struct stat state {};
    void* mapping = nullptr;
    if (::fstat(file, &state) == 0 && state.st_size > 0) {
        size_ = static_cast<std::size_t>(state.st_size);
        mapping = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file, 0);
    }
    const int problem = errno;
    ::close(file);
    if (mapping == MAP_FAILED) throw Error(std::strerror(problem), path);
    data_ = static_cast<const std::byte*>(mapping);
}

MappedFile::~MappedFile() {
    if (data_) ::munmap(const_cast<std::byte*>(data_), size_);
}

} // namespace tessera
