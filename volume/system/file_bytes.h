#pragma once

#include "volume/base/error.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace tessera {

/// A file cannot be read now, which says nothing of its contents: a network fails, or the file has been replaced.
class ReadError : public Error {
public:
    using Error::Error;
};

/// A range of a file.
struct FileRange {
    std::uint64_t offset = 0, length = 0;
    bool operator==(const FileRange&) const = default;
};

/// Bytes of a file: a view of a mapping, or a copy of its own. The view lasts as long as this value and the file.
class FilePart {
public:
    FilePart() = default;
    explicit FilePart(std::span<const std::byte> mapped) : bytes_(mapped) {}
    explicit FilePart(std::vector<std::byte> read)
        : own_(std::make_shared<const std::vector<std::byte>>(std::move(read))), bytes_(*own_) {}
    std::span<const std::byte> bytes() const { return bytes_; }

private:
    std::shared_ptr<const std::vector<std::byte>> own_;
    std::span<const std::byte> bytes_;
};

/// The bytes of a file that is read in parts, on this machine or on another one. Thread-safe.
class FileBytes {
public:
    virtual ~FileBytes() = default;
    virtual std::uint64_t size() const = 0;
    /// The bytes of a range that lies inside the file. Throws ReadError.
    virtual FilePart part(FileRange range) const = 0;
    /// The same, not from a cache: for bytes that turned out to be damaged. Nothing if there is no cache.
    virtual std::optional<FilePart> freshPart(FileRange) const { return std::nullopt; }
    /// Reads ranges ahead, together, for calls of part() that follow. Throws ReadError.
    virtual void readAhead(std::span<const FileRange>) const {}
    /// States that the file goes on from an earlier state of `end` bytes that is known by `checksum`: what is kept of
    /// that serves for this one, too.
    virtual void goesOn(std::uint64_t, std::uint64_t) const {}
    /// True if the file is known to have been replaced or appended to since it was opened, without asking again.
    virtual bool hasChanged() const { return false; }
};

/// A range of another file as a file of its own: positions count from its begin.
class FileWindow final : public FileBytes {
public:
    FileWindow(std::shared_ptr<const FileBytes> file, FileRange range) : file_(std::move(file)), range_(range) {}
    std::uint64_t size() const override { return range_.length; }
    FilePart part(FileRange range) const override { return file_->part(outside(range)); }
    std::optional<FilePart> freshPart(FileRange range) const override { return file_->freshPart(outside(range)); }
    void readAhead(std::span<const FileRange> ranges) const override {
        std::vector<FileRange> all;
        for (const FileRange& range : ranges) all.push_back(outside(range));
        file_->readAhead(all);
    }
    bool hasChanged() const override { return file_->hasChanged(); }

private:
    FileRange outside(FileRange range) const { return {range_.offset + range.offset, range.length}; }
    std::shared_ptr<const FileBytes> file_;
    FileRange range_;
};

} // namespace tessera
