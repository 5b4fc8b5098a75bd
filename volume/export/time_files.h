#pragma once

#include <string>
#include <vector>

/// A series as one file for each time.
namespace tessera::volume {

/// The file of the time with that number: "out.vtp" gives "out_0007.vtp".
std::string fileOfTime(const std::string& path, std::size_t number);

/// Writes the ParaView collection OUT.pvd beside OUT.vtp or what the path is named, of files beside it, one for each
/// time; returns its path. Throws MachineError.
std::string writeCollection(const std::string& path, const std::vector<double>& times,
                            const std::vector<std::string>& files);

} // namespace tessera::volume
