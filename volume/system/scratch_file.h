#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace tessera::volume {

/// A temporary file for data larger than memory. Thread-safe if threads write to different ranges.
class ScratchFile {
public:
    /// An empty file, without a name, in a folder: it lives as long as the object. Throws MachineError.
    explicit ScratchFile(const std::string& folder);
    /// A file of another process, for reading. Throws MachineError when it cannot be opened.
    static std::unique_ptr<const ScratchFile> of(const std::string& path);
    ~ScratchFile();
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;

    /// Throws MachineError when the disk is full.
    void write(std::uint64_t at, std::span<const std::byte> bytes);
    /// What was written before; throws MachineError when the disk fails.
    void read(std::uint64_t at, std::span<std::byte> bytes) const;

    std::uint64_t size() const;

private:
    explicit ScratchFile(int file) : file_(file) {}

    int file_ = -1;
};

} // namespace tessera::volume
