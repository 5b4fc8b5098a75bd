#pragma once

#include <optional>
#include <string>
#include <vector>

/// What names of files say, and which files a folder stands for.
namespace tessera::volume {

/// The last number in a file name without ending: "small_0010.vti" -> {"small_#.vti", 10}, "run_0.05.vtu" ->
/// {"run_#.vtu", 0.05}. Decimals, an exponent and a sign belong to it where it stands by itself.
struct NumberedName {
    std::string pattern;
    std::optional<double> number;
};
NumberedName numberedName(const std::string& path);

/// The files of a folder that are opened when the folder is: a case of OpenFOAM, its single list of files (.pvd,
/// .series), or the files of the commonest format, of which pictures count only where there is nothing else. Throws
/// Error where there is none, or several lists.
std::vector<std::string> filesOfFolder(const std::string& folder);

} // namespace tessera::volume
