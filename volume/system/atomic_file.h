#pragma once

#include <fstream>
#include <string>

namespace tessera {

/// A file that gets its name only when complete: written to a temporary file beside it, renamed by `commit`, removed by
/// the destructor otherwise. Throws MachineError when writing fails.
class AtomicFile {
public:
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(const void* bytes, std::size_t size);
    void write(const std::string& text) { write(text.data(), text.size()); }
    /// Closes and renames.
    void commit();
    const std::string& path() const { return path_; }

private:
    std::string path_, temporary_;
    std::ofstream out_;
    bool done_ = false;
};

} // namespace tessera
