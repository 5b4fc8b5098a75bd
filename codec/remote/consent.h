#pragma once

#include "codec/remote/address.h"
#include "volume/base/error.h"

#include <functional>
#include <string>

/// Which machines this process may ask. A file that somebody sent may name any machine: a request to it would tell
/// where the file was opened, and log in there. All connections are made by one function, which asks here first.
namespace tessera::codec {

/// A machine that nobody has allowed to be asked.
class NotAllowed : public Error {
public:
    explicit NotAllowed(const Address& address);
    /// As machineOf() names it.
    const std::string& machine() const { return machine_; }

private:
    std::string machine_;
};

/// What is allowed or not, in small letters: "https://data.example.org:8443". Users and paths do not count.
std::string machineOf(const Address& address);

/// From now on only machines that were allowed are asked, and those that are `known`, which is called with machineOf()
/// from any thread; until then all are. For programs that open files which others made.
void requireConsent(std::function<bool(const std::string& machine)> known);
/// Allows a machine, as machineOf() names it, while the process lasts.
void allowMachine(const std::string& machine);
/// Allows all machines again.
void allowAllMachines();
/// Throws NotAllowed.
void requireAllowed(const Address& address);

} // namespace tessera::codec
