#include "app/user_files/machines.h"

#include "app/history/session_file.h"
#include "codec/remote/consent.h"
#include "volume/base/error.h"
#include "volume/system/atomic_file.h"

#include <algorithm>

namespace tessera::app {

namespace {

std::vector<std::string> knownMachines(const std::string& folder) {
    std::vector<std::string> machines;
    if (folder.empty()) return machines;
    try {
        const Json list = parseJson(readText(folder + "/machines.json"), {});
        if (list.is_array())
            for (const Json& entry : list)
                if (entry.is_string()) machines.push_back(entry.get<std::string>());
    } catch (const Error&) {
        // None yet, or a broken list: then there is a question again.
    }
    return machines;
}

} // namespace

bool isKnownMachine(const std::string& folder, const std::string& machine) {
    return std::ranges::count(knownMachines(folder), machine) > 0;
}

void rememberMachine(const std::string& folder, const std::string& machine) {
    if (folder.empty()) return;
    std::vector<std::string> machines = knownMachines(folder);
    if (std::ranges::count(machines, machine) > 0) return;
    machines.push_back(machine);
    try {
        writeAtomically(folder + "/machines.json", printJson(Json(machines)));
    } catch (const Error&) {
        // Then there is a question again.
    }
}

void allowNamed(const std::vector<std::string>& words, const std::string& folder) {
    for (const std::string& word : words) {
        if (!codec::isRemote(word)) continue;
        try {
            const std::string machine = codec::machineOf(codec::parseAddress(word));
            codec::allowMachine(machine);
            rememberMachine(folder, machine);
        } catch (const Error&) {
            // No valid address: whoever opens it says so.
        }
    }
}

} // namespace tessera::app
