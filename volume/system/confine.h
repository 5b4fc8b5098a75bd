#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

/// Rights that a process gives up before it reads bytes of unknown origin, so that an error in a parser harms nothing.
namespace tessera::volume {

/// What a confined process may still do. It may read every file that its user may read.
struct Confinement {
    std::vector<std::string>
        writable;             ///< folders and files that it may write, create and remove; absent ones do not count
    std::uint64_t memory = 0; ///< bytes that it may allocate beyond what it has; more fails. 0: no limit
};

/// Confines the calling thread and every thread and process that it starts later, for good: no file beyond those of
/// `allowed` can be written, no program be started, and no TCP port be connected to or opened. Call it before other
/// threads start. Files and programs need the kernel's Landlock (Linux 5.13), ports Linux 6.7. False where the kernel
/// cannot confine files; the limit of memory holds anyway.
bool confine(const Confinement& allowed);

/// From now on the process may use so much processor time, of all its threads; it ends by SIGXCPU after that. A later
/// call starts anew.
void limitProcessorTime(std::chrono::seconds most);

} // namespace tessera::volume
