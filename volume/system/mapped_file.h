#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace tessera::codec {

/// A file mapped for reading. The file must not shrink while it is mapped.
class MappedFile {
public:
    /// Throws Error when the file cannot be opened or is no regular file.
    explicit MappedFile(const std::string& path);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    std::span<const std::byte> bytes() const { return {data_, size_}; }

private:
    const std::byte* data_ = nullptr;
    std::size_t size_ = 0;
};

} // namespace tessera::codec
