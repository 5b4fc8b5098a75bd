#pragma once

#include <string>
#include <string_view>

/// Texts of files and of the system (names, labels, paths) may hold any bytes: escapes that command a terminal, ends of
/// lines that break a table, bytes that no UTF-8 has and that JSON and XML refuse.
namespace tessera {

/// A text as one line that can be shown and written anywhere: UTF-8 without control characters, marks that turn the
/// direction of a line, and codes that are no characters. Each of these becomes U+FFFD, ends of lines and tabs become
/// blanks. Bytes that are not UTF-8 are read as Latin-1, as in files from before it.
std::string printable(std::string_view text);

/// The same, but ends of lines and tabs stay.
std::string printableLines(std::string_view text);

} // namespace tessera
