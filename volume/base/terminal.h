#pragma once

#include <string>

/// The only way by which commands print to a terminal: names of files and of what is in them may hold escapes that
/// command a terminal, which printable.h replaces.
namespace tessera {

/// Prints to standard output as printf does.
[[gnu::format(printf, 1, 2)]] void say(const char* format, ...);
/// Prints to standard error as printf does.
[[gnu::format(printf, 1, 2)]] void warn(const char* format, ...);
/// Prints JSON and the end of a line to standard output; unchanged, but for a terminal.
void sayJson(const std::string& json);
/// Throws MachineError where standard output has not taken all that was printed.
void finishOutput();

} // namespace tessera
