#pragma once

#include <string>
#include <vector>

/// Other machines that the user has opened archives of. Sessions that others made may name any machine: those that are
/// not known here are asked only after a question ("codec/remote/consent.h").
namespace tessera::app {

/// Whether a machine, as codec::machineOf() names it, is known in a folder of state. A missing or broken list is empty.
bool isKnownMachine(const std::string& folder, const std::string& machine);
/// Adds a machine to those known; "" for the folder remembers nothing.
void rememberMachine(const std::string& folder, const std::string& machine);

/// Allows the machines of those words that are addresses, and remembers them: what the user types or chooses himself
/// needs no question.
void allowNamed(const std::vector<std::string>& words, const std::string& folder);

} // namespace tessera::app
