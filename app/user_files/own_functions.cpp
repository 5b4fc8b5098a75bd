#include "app/user_files/own_functions.h"

#include "app/history/session_file.h"
#include "volume/base/error.h"
#include "volume/system/atomic_file.h"

#include <algorithm>
#include <filesystem>

namespace tessera::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* kFunctionsKey = "functions";

std::string functionsPath(const std::string& folder) {
    return folder + "/transfer-functions.json";
}

bool blank(const std::string& name) {
    return std::ranges::all_of(name, [](char c) { return c == ' ' || c == '\t'; });
}

auto named(std::vector<vis::TransferRecipe>& list, const std::string& name) {
    return std::ranges::find_if(list, [&](const vis::TransferRecipe& each) { return each.name == name; });
}

/// Why a recipe that was read could not be drawn, "" if it can.
std::string whyWrong(const vis::TransferRecipe& recipe) {
    if (blank(recipe.name)) return "has no name";
    if (recipe.opacity.size() < 2) return "has fewer than two points of opacity";
    const auto later = [](const auto& a, const auto& b) { return a.at.place > b.at.place; };
    if (std::ranges::adjacent_find(recipe.opacity, later) != recipe.opacity.end() ||
        std::ranges::adjacent_find(recipe.colors, later) != recipe.colors.end())
        return "has points that are not in order";
    return {};
}

/// The new name of a file that is in the way.
std::string setAside(const std::string& path) {
    std::string to = path + ".broken";
    for (int number = 2; fs::exists(to); ++number) to = path + ".broken-" + std::to_string(number);
    std::error_code problem;
    fs::rename(path, to, problem);
    if (problem) throw MachineError("cannot be renamed: " + problem.message(), path);
    return to;
}

} // namespace

OwnFunctions parseOwnFunctions(std::string_view text, const std::string& file) {
    const Json document = parseJson(text, file);
    if (!document.is_object() || !document.contains(kFunctionsKey) || !document[kFunctionsKey].is_array())
        throw Error("has no list \"functions\"", file);
    OwnFunctions out;
    for (const Json& entry : document[kFunctionsKey]) {
        const std::string place = "/functions/" + std::to_string(out.list.size() + out.unread.size());
        std::vector<JsonIssue> issues;
        vis::TransferRecipe recipe;
        fromJson(recipe, entry, issues, place);
        std::string reason = issues.empty() ? whyWrong(recipe) : issues.front().path + ": " + issues.front().reason;
        if (reason.empty() && named(out.list, recipe.name) != out.list.end()) reason = "has a name that is taken";
        if (reason.empty()) {
            out.list.push_back(std::move(recipe));
            continue;
        }
        out.unread.push_back(entry);
        out.messages.push_back(file + ": " + (issues.empty() ? place + ": " : "") + reason);
    }
    return out;
}

std::string printOwnFunctions(const OwnFunctions& functions) {
    Json list = Json::array();
    for (const vis::TransferRecipe& recipe : functions.list) list.push_back(toJson(recipe));
    for (const Json& entry : functions.unread) list.push_back(entry);
    return printJson(Json{{kFunctionsKey, list}});
}

OwnFunctions loadOwnFunctions(const std::string& folder) {
    std::error_code problem;
    if (folder.empty() || !fs::exists(functionsPath(folder), problem)) return {};
    return parseOwnFunctions(readText(functionsPath(folder)), functionsPath(folder));
}

std::string saveOwnFunction(const std::string& folder, const vis::TransferRecipe& recipe) {
    if (folder.empty()) throw Error("there is no folder to keep it in", "transfer function", recipe.name);
    if (const std::string reason = whyWrong(recipe); !reason.empty())
        throw Error(reason, "transfer function", recipe.name);
    OwnFunctions known;
    std::string kept;
    try {
        known = loadOwnFunctions(folder);
    } catch (const MachineError&) {
        throw;
    } catch (const Error&) {
        kept = setAside(functionsPath(folder));
    }
    if (const auto found = named(known.list, recipe.name); found != known.list.end())
        *found = recipe;
    else
        known.list.push_back(recipe);
    writeAtomically(functionsPath(folder), printOwnFunctions(known));
    return kept;
}

void deleteOwnFunction(const std::string& folder, const std::string& name) {
    OwnFunctions known = loadOwnFunctions(folder);
    const auto found = named(known.list, name);
    if (found == known.list.end()) return;
    known.list.erase(found);
    writeAtomically(functionsPath(folder), printOwnFunctions(known));
}

} // namespace tessera::app
