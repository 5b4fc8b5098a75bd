#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The fields of a NRRD header as they are written.
namespace tessera::volume {

struct NrrdHeader {
    std::map<std::string, std::string> fields; ///< by name in small letters without blanks: "spaceorigin"
    std::map<std::string, std::string> pairs;  ///< "key:=value"
    std::vector<std::string> list;             ///< the file names that follow "data file: LIST"
    std::vector<std::string> unknown;          ///< fields that NRRD does not have
    std::size_t end = 0;                       ///< of the header
    bool hasEnd = false;                       ///< an empty line ends it; else the end of the file

    /// The value of a field, "" where it is missing.
    const std::string& field(const char* name) const;
};

/// Throws Error for what is no header.
NrrdHeader readNrrdHeader(std::string_view head);

/// Numbers between blanks or commas; "nan" is one. Throws Error with the field's name.
std::vector<double> nrrdNumbers(std::string_view text, const char* field);

/// "(1,0,0) none (0, 1, 0)": nothing for "none".
std::vector<std::optional<std::vector<double>>> nrrdVectors(std::string_view text, const char* field);

/// "\"mm\" \"\" \"s\"", also without quotes.
std::vector<std::string> nrrdWords(const std::string& text);

/// The names of a data file's field: one name, "slice%03d.raw 1 10 1", or those of the list.
std::vector<std::string> nrrdDataFiles(const NrrdHeader& header);

/// "s%02d.raw" with a number in place of %02d; nothing where a name has no such place. Throws Error where anything like
/// a second place follows.
std::optional<std::string> numberedFile(std::string_view pattern, long number);

} // namespace tessera::volume
