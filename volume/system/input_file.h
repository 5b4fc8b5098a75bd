#pragma once

#include <cstdint>
#include <fstream>
#include <string>

/// Files that a user, a session or another file names, opened for reading. A pipe, a socket or a device is refused at
/// once: opening one may wait, and reading one need not end. Everything throws Error.
namespace tessera {

inline constexpr const char *kNoSuchFile = "no such file", *kPipeOrDevice = "is a pipe or a device, not a file";

/// What keeps a path from being read as a file: "" for a regular file, else kNoSuchFile, kPipeOrDevice, "is a folder"
/// or the reason of the system.
std::string whyNoFile(const std::string& path);

/// Throws for a path that leads to anything but a regular file.
void requireFile(const std::string& path);

/// A regular file at its begin.
std::ifstream openInput(const std::string& path);

/// The same as a descriptor, which the caller closes.
int openInputDescriptor(const std::string& path);

/// All bytes of a regular file, which may have `most` of them at most.
std::string readInput(const std::string& path, std::uintmax_t most);

} // namespace tessera
