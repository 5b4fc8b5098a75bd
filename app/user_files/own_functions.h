#pragma once

#include "app/described/describe_json.h"
#include "vis/transfer/transfer_recipe.h"

#include <string>
#include <string_view>
#include <vector>

/// Transfer functions that the user saved by name, in transfer-functions.json of the state folder:
///     {"functions": [{"name": "...", ...}, ...]}
namespace tessera::app {

struct OwnFunctions {
    std::vector<vis::TransferRecipe> list;
    std::vector<Json> unread;          ///< entries that are no function, written again as they are
    std::vector<std::string> messages; ///< why they are not, with their place
    bool operator==(const OwnFunctions&) const = default;
};

/// Reads the text of the file. Entries without a name, with a name that is taken, or with a wrong member are unread.
/// Throws Error with `file` when the text is no list of functions at all.
OwnFunctions parseOwnFunctions(std::string_view text, const std::string& file);
std::string printOwnFunctions(const OwnFunctions& functions);

/// Those of a state folder; none without a folder or a file. Throws Error when the file cannot be read.
OwnFunctions loadOwnFunctions(const std::string& folder);

/// Adds one, in place of the one with the same name; its name must not be blank. A file that cannot be read is kept
/// beside the new one as transfer-functions.json.broken (.broken-2, ...). Returns the path of that, else "". Throws
/// Error, MachineError.
std::string saveOwnFunction(const std::string& folder, const vis::TransferRecipe& recipe);

/// Removes the function of that name. Throws Error, MachineError; the file stays as it was then.
void deleteOwnFunction(const std::string& folder, const std::string& name);

} // namespace tessera::app
