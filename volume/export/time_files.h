#pragma once

#include <string>
#include <vector>

/// A series as one file for each time.
namespace tessera::volume {

/// The file of the time with that number: "out.vtp" gives "out_0007.vtp".
std::string fileOfTime(const std::string& path, std::size_t number);

/// The ParaView collection of these files: "out.vtp" gives "out.pvd".
std::string collectionOf(const std::string& path);
/// Writes the collection of `files`, which lie beside it, one for each time. Throws MachineError.
void writeCollection(const std::string& path, const std::vector<double>& times, const std::vector<std::string>& files);

} // namespace tessera::volume
