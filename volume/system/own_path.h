#pragma once

#include <filesystem>
#include <string>

/// Where the running program lies, and with it what was installed or built together.
namespace tessera {

/// The folder of the running program; empty where the system does not say.
std::filesystem::path programFolder();

/// Path of another program in that folder; "" where it is missing or cannot be run.
std::string programBeside(const std::string& name);

} // namespace tessera
