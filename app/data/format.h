#pragma once

#include <cstdint>
#include <string>

/// Numbers as the commands print them.
namespace tessera::app {

/// Shortest of %.6g.
std::string numberText(double value);
/// At the end of a path, without regard to case: hasEnding("a.TSR", ".tsr").
bool hasEnding(const std::string& path, const std::string& ending);

} // namespace tessera::app
