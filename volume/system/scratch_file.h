#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace tessera::volume {

/// A temporary file that lives as long as the object, for data larger than memory. Thread-safe if threads write to
/// different ranges.
class ScratchFile {
public:
    /// An empty file, without a name, in a folder. Throws MachineError.
    explicit ScratchFile(const std::string& folder);
    ~ScratchFile();
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;

    /// Throws MachineError when the disk is full.
    void write(std::uint64_t at, std::span<const std::byte> bytes);
    /// What was written before; throws MachineError when the disk fails.
    void read(std::uint64_t at, std::span<std::byte> bytes) const;

private:
    int file_ = -1;
};

} // namespace tessera::volume
