#pragma once

#include <string>
#include <vector>

namespace tessera {

/// The file that a whole new one at `path` replaces: where that is a link, what it leads to, which need not exist yet.
/// Throws MachineError for what is no file, such as a device or a pipe, which would be replaced by one.
std::string replacedFile(const std::string& path);

/// The name under which this process writes a file, or a folder of them, until it is complete: PATH.part-PID, beside
/// it.
std::string partFileOf(const std::string& path);

/// The parts of `path` that lie in its folder although the processes that wrote them are gone, as after a kill: no
/// process has the number in their name and none holds a lock on them (a writer on another machine of the network
/// does).
std::vector<std::string> leftParts(const std::string& path);

/// Removes these, folders with what they hold. What cannot be removed stays.
void removeLeftParts(const std::string& path);

} // namespace tessera
