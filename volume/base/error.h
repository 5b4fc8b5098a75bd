#pragma once

#include <stdexcept>
#include <string>

namespace tessera {

/// A failure that the user can act on: bad input, a missing file, a machine without OpenGL. Thrown anywhere, caught
/// once per command or job. `what()` is one line "file: place: reason" without the empty parts.
class Error : public std::runtime_error {
public:
    explicit Error(const std::string& reason, const std::string& file = {}, const std::string& place = {})
        : std::runtime_error(join(file, place, reason)), reason_(reason), file_(file), place_(place) {}

    const std::string& reason() const { return reason_; }
    const std::string& file() const { return file_; }
    /// Where in the file: a byte offset, a JSON path, an array name.
    const std::string& place() const { return place_; }

private:
    static std::string join(const std::string& file, const std::string& place, const std::string& reason) {
        std::string line;
        for (const std::string* part : {&file, &place})
            if (!part->empty()) line += *part + ": ";
        return line + reason;
    }
    std::string reason_, file_, place_;
};

/// The machine cannot do it (no OpenGL, disk full): exit status 3 instead of 2.
class MachineError : public Error {
public:
    using Error::Error;
};

/// Thrown by Progress::advance when the user cancelled; not a failure, so not an Error.
class Cancelled : public std::runtime_error {
public:
    Cancelled() : std::runtime_error("cancelled") {}
};

} // namespace tessera
