#include "codec/remote/consent.h"

#include <cctype>
#include <mutex>
#include <set>
#include <string_view>
#include <utility>

namespace tessera::codec {

namespace {

struct Consent {
    std::mutex mutex;
    std::function<bool(const std::string&)> known; ///< null: all machines are allowed
    std::set<std::string> allowed;
};

/// Of the process: what one part of it may ask, every part may.
Consent& consent() {
    static Consent only;
    return only;
}

std::string_view schemeOf(const Address& address) {
    switch (address.scheme) {
    case Address::Scheme::Http:
        return "http://";
    case Address::Scheme::Https:
        return "https://";
    default:
        return "sftp://";
    }
}

} // namespace

std::string machineOf(const Address& address) {
    const bool numbers = address.host.find(':') != std::string::npos;
    std::string machine = std::string(schemeOf(address)) + (numbers ? "[" + address.host + "]" : address.host);
    if (!address.port.empty()) machine += ":" + address.port;
    for (char& c : machine) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return machine;
}

NotAllowed::NotAllowed(const Address& address)
    : Error(machineOf(address) + " is named by a file, and nobody has allowed to ask it; --allow-remote does, and so "
                                 "does opening an address there by hand",
            address.text),
      machine_(machineOf(address)) {}

void requireConsent(std::function<bool(const std::string&)> known) {
    const std::lock_guard lock(consent().mutex);
    consent().known = std::move(known);
}

void allowMachine(const std::string& machine) {
    const std::lock_guard lock(consent().mutex);
    consent().allowed.insert(machine);
}

void allowAllMachines() {
    requireConsent(nullptr);
}

void requireAllowed(const Address& address) {
    const std::lock_guard lock(consent().mutex);
    if (!consent().known) return;
    const std::string machine = machineOf(address);
    if (consent().allowed.contains(machine)) return;
    if (!consent().known(machine)) throw NotAllowed(address);
    consent().allowed.insert(machine);
}

} // namespace tessera::codec
