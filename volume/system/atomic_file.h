#pragma once

#include <fstream>
#include <string>
#include <string_view>

namespace tessera {

/// A file that gets its name only when complete: written to a temporary file beside it, renamed by `commit`, removed by
/// the destructor otherwise. After a crash of the program or of the machine the name stands for what it stood for
/// before or for the whole new file. Throws MachineError when writing fails.
class AtomicFile {
public:
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(const void* bytes, std::size_t size);
    void write(std::string_view text) { write(text.data(), text.size()); }
    /// Waits until the disk has all of it, closes and renames. Once this returns, a crash does not undo it.
    void commit();
    const std::string& path() const { return path_; }

private:
    [[noreturn]] void fail() const;

    std::string path_, temporary_;
    std::ofstream out_;
    bool done_ = false;
};

/// Writes a whole file that way.
void writeAtomically(const std::string& path, std::string_view text);

} // namespace tessera
