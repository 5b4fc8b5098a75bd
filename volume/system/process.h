#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <sys/types.h>
#include <vector>

namespace tessera::volume {

/// A child process spoken to by pipes. Its stderr is read along and its last line kept. Ended with it: the destructor
/// closes the pipes, kills the child if it still runs, and reaps it.
class ChildProcess {
public:
    /// Starts `arguments[0]`, a path or a program on PATH. Throws Error if it cannot be started.
    explicit ChildProcess(const std::vector<std::string>& arguments);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Writes to its stdin; a child that is gone is noticed by the next read.
    void write(const std::string& text);
    /// Fills `bytes` from its stdout; false when it ended before. `waiting` is called several times a second meanwhile
    /// and may throw.
    bool read(std::span<std::byte> bytes, const std::function<void()>& waiting);
    /// Waits for the end of a child whose output has ended (kills it if it does not end within a second) and says how
    /// it ended: "" for exit status 0, else e.g. "ended with status 1: LAST LINE" or "crashed (signal 11)".
    std::string ending();
    /// The end was by SIGINT or SIGTERM, as when the user presses Ctrl-C. Known after ending().
    bool interrupted() const { return interrupted_; }

private:
    void readErrors();
    pid_t pid_ = -1;
    int input_ = -1, output_ = -1, errors_ = -1;
    bool interrupted_ = false;
    std::string tail_; ///< of stderr
    std::string ended_;
};

} // namespace tessera::volume
