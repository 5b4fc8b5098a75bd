#pragma once

#include "volume/system/file_bytes.h"

#include <string>

namespace tessera {

/// A file mapped for reading. The file must not shrink while it is mapped.
class MappedFile final : public FileBytes {
public:
    /// Throws Error when the file cannot be opened or is no regular file (volume/system/input_file.h).
    explicit MappedFile(const std::string& path);
    ~MappedFile() override;
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    std::uint64_t size() const override { return size_; }
    FilePart part(FileRange range) const override { return FilePart({data_ + range.offset, range.length}); }

private:
    const std::byte* data_ = nullptr;
    std::size_t size_ = 0;
};

} // namespace tessera
