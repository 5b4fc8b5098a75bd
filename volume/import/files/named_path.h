#pragma once

#include <cstdint>
#include <string>

/// Files that other files name: the samples of a header, the pieces of a list, the data of a description.
namespace tessera::volume {

/// Whether a file may name others that lie neither beside it nor below its folder. A file of unknown origin must not,
/// since it could show what its reader may read and its author may not.
enum class Outside : std::uint8_t { Refused, Allowed };

/// Whether `path` lies in a folder or below it, by the names: what links in the folder lead to counts as lying where
/// they are, and so does what links to the folder itself lead to.
bool liesWithin(const std::string& folder, const std::string& path);

/// The path of what a file at `file` names: an absolute name as it is, others from the folder of `file`. Throws Error
/// for what lies outside of that folder if that is refused, and says how to allow it; for names with a zero byte.
std::string namedPath(const std::string& file, const std::string& name, Outside outside);

/// The same for a name from a folder, which need not be the one of the file that names it.
std::string namedPathIn(const std::string& folder, const std::string& name, Outside outside);

} // namespace tessera::volume
