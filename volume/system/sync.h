#pragma once

#include <string>

/// What a disk holds after a crash of the machine.
namespace tessera {

/// Waits until the bytes of a file are on disk. Throws MachineError when they cannot be.
void syncFile(const std::string& path);

/// Waits until the names in the folder of a file are on disk. Best effort: not every file system supports it.
void syncFolderOf(const std::string& path);

} // namespace tessera
