#include "app/history/session_file.h"

#include "app/history/animated_session.h"

#include "app/described/within_ranges.h"
#include "codec/remote/address.h"
#include "volume/base/error.h"
#include "volume/system/atomic_file.h"
#include "volume/system/input_file.h"

#include <algorithm>
#include <filesystem>

namespace tessera::app {

namespace fs = std::filesystem;

namespace {

/// Puts unknown keys back where they were, as far as their parents still exist.
void restoreUnknown(Json& document, const std::vector<JsonIssue>& unknown) {
    for (const JsonIssue& issue : unknown) {
        const Json::json_pointer at(issue.path);
        const Json::json_pointer parent = at.parent_pointer();
        if (!document.contains(parent) || !document.at(parent).is_object()) continue;
        Json& object = document.at(parent);
        if (!object.contains(at.back())) object[at.back()] = issue.value;
    }
}

} // namespace

std::string readText(const std::string& path) {
    constexpr std::uintmax_t kMost = 256'000'000; // a session with a long history, or a picture, has a few millions
    return readInput(path, kMost);
}

bool looksLikeSession(std::string_view text) {
    try {
        const Json document = parseJson(text, {});
        return document.is_object() && document.contains("schema") &&
               (document.contains("views") || document.contains("layers") || document.contains("dock"));
    } catch (const Error&) {
        // One that was damaged: it is read as a session, to say where.
        const auto names = [&](std::string_view key) { return text.find(key) != std::string_view::npos; };
        return names("\"app\": \"tessera\"") ||
               (names("\"schema\"") && (names("\"views\"") || names("\"layers\"") || names("\"dock\"")));
    }
}

namespace {

/// Up to schema 2 the lattice of pictures was "bcc": true or false, in the data and in changes of variants.
void renameLattice(Json& json) {
    static const auto named = [](bool bcc) { return std::string(kPictureLatticeNames[bcc ? 1 : 0]); };
    if (json.is_object()) {
        if (const auto change = json.find("/data/bcc"); change != json.end()) {
            json["/data/lattice"] = named(*change == "true");
            json.erase("/data/bcc");
        }
        if (const auto path = json.find("path"); path != json.end() && path->is_string()) {
            auto& text = path->get_ref<std::string&>();
            constexpr std::string_view kWas = "~1data~1bcc";
            if (text.ends_with(kWas)) {
                text.replace(text.size() - kWas.size(), kWas.size(), "~1data~1lattice");
                if (const auto value = json.find("value"); value != json.end()) *value = named(*value == "true");
            }
        }
    }
    if (json.is_structured())
        for (Json& part : json) renameLattice(part);
}

void migrateLattice(Json& document) {
    renameLattice(document);
    const auto data = document.find("data");
    if (data == document.end() || !data->is_object()) return;
    if (const auto bcc = data->find("bcc"); bcc != data->end() && bcc->is_boolean()) {
        (*data)["lattice"] = kPictureLatticeNames[bcc->get<bool>() ? 1 : 0];
        data->erase("bcc");
    }
}

/// Up to schema 3 meshes and uneven grids were sampled on even grids: the samples of such sessions stay where they
/// were.
void keepEvenGrid(Json& data) {
    const auto files = data.find("files");
    if (files == data.end() || !files->is_array() || files->empty()) return;
    Json& import = data["import"];
    if (import.is_null()) import = Json::object();
    if (import.is_object() && !import.contains("grid"))
        import["grid"] = volume::kGridChoiceNames[std::size_t(volume::GridChoice::Even)];
}

/// Up to schema 4 the cells of the built-in fuel cell were all of one height.
void keepEvenCell(Json& data) {
    const auto model = data.find("model");
    if (model == data.end() || *model != "fuel-cell") return;
    Json& settings = data["settings"];
    if (settings.is_null()) settings = Json::object();
    if (settings.is_object() && !settings.contains("even")) settings["even"] = 1;
}

/// Changes the data of a document, and the other data beside them.
void forEachData(Json& document, void (*change)(Json& data)) {
    const auto data = document.find("data");
    if (data == document.end() || !data->is_object()) return;
    change(*data);
    if (const auto other = data->find("other"); other != data->end() && other->is_object()) change(*other);
}

/// Up to schema 4 brushed samples that a transfer function hides stayed hidden.
void keepHiddenFocus(Json& document) {
    const auto selection = document.find("selection");
    if (selection != document.end() && selection->is_object() && !selection->contains("focusOpacity"))
        (*selection)["focusOpacity"] = 0;
}

constexpr std::string_view kKindOfFlow = "/technique/kind"; ///< ends the path of that setting

/// Whether something other than a layer itself makes it one of paths: keyframes of the kind, a variant of a comparison,
/// a step of the history.
bool becomesPaths(const Json& json) {
    if (!json.is_structured()) return false;
    if (json.is_object()) {
        const auto path = json.find("path");
        const bool kind =
            path != json.end() && path->is_string() && path->get_ref<const std::string&>().ends_with(kKindOfFlow);
        if (kind && (json.contains("keys") || json.value("value", Json()) == "pathlines")) return true;
        for (const auto& [key, value] : json.items())
            if (key.ends_with(kKindOfFlow) && (value == "pathlines" || value == "\"pathlines\"")) return true;
    }
    return std::ranges::any_of(json, becomesPaths);
}

/// Up to schema 5 paths took a vector of 1 as 1 length per time, whatever the units of the data: in every list of
/// layers and in the steps of the history; `all`: of every layer of flow, since it may become one of paths.
void keepSpeedOfPaths(Json& json, bool all) {
    if (!json.is_structured()) return;
    const bool flow = json.is_object() && json.value("type", Json()) == "flow";
    if (flow && (all || json.value("kind", Json()) == "pathlines")) json["ignoreUnits"] = true;
    for (Json& part : json) keepSpeedOfPaths(part, all);
}

} // namespace

void migrate(Json& document, const std::string& file) {
    if (!document.is_object()) throw Error("not a session: needs an object", file, "/");
    const auto found = document.find("schema");
    if (found == document.end()) throw Error("not a session: no \"schema\"", file, "/schema");
    if (!found->is_number_integer()) throw Error("needs a whole number", file, "/schema");
    const auto schema = found->get<std::int64_t>();
    if (schema > kSessionSchema)
        throw Error("written by a newer version of Tessera (schema " + std::to_string(schema) +
                        ", this one reads up to " + std::to_string(kSessionSchema) + ")",
                    file, "/schema");
    if (schema < kOldestSchema)
        throw Error("written by an early version of Tessera (schema " + std::to_string(schema) +
                        "), which is no longer read",
                    file, "/schema");
    if (schema < 3) migrateLattice(document);
    if (schema < 4) forEachData(document, keepEvenGrid);
    if (schema < 5) {
        forEachData(document, keepEvenCell);
        keepHiddenFocus(document);
    }
    if (schema < 6) keepSpeedOfPaths(document, becomesPaths(document));
    document["schema"] = kSessionSchema;
}

namespace {

/// Makes the path of the environment picture, relative to the document's folder, absolute.
void findPicture(Json& document, const std::string& file) {
    const Json::json_pointer place("/lighting/environment/picture");
    if (!document.contains(place) || !document[place].is_string()) return;
    const std::string path = document[place].get<std::string>();
    if (!path.empty())
        document[place] = absolutePath((absolutePath(file).parent_path() / path).string()).generic_string();
}

} // namespace

SessionDocument parseSession(std::string_view text, const std::string& file) {
    SessionDocument document;
    document.raw = parseJson(text, file);
    migrate(document.raw, file);
    findPicture(document.raw, file);
    Json known = document.raw;
    known.erase("app");
    known.erase("history");
    document.session = sessionFromJson(known, file, &document.unknown);
    for (const JsonIssue& issue : document.unknown)
        document.messages.push_back((file.empty() ? "" : file + ": ") + issue.path + ": unknown key, kept");
    for (const std::string& problem : trackProblems(document.session))
        document.messages.push_back((file.empty() ? "" : file + ": ") + problem);
    document.history.reset(document.session);
    if (const auto history = document.raw.find("history"); history != document.raw.end()) {
        try {
            document.history = History::fromJson(*history, document.session);
        } catch (const Error& error) {
            document.messages.push_back((file.empty() ? "" : file + ": ") + "/history: removed: " + error.what());
        }
    }
    document.raw.erase("history");
    return document;
}

SessionDocument loadSession(const std::string& path) {
    return parseSession(readText(path), path);
}

std::string printSession(const SessionDocument& document, const std::string& path) {
    Session session = document.session;
    const fs::path folder = absolutePath(path).parent_path();
    noteTables(session.data);
    std::vector<DataFile*> files;
    for (DataFile& file : session.data.files) files.push_back(&file);
    if (session.data.table) files.push_back(&*session.data.table);
    if (session.data.other) {
        for (DataFile& file : session.data.other->files) files.push_back(&file);
        if (session.data.other->table) files.push_back(&*session.data.other->table);
    }
    for (DataFile* each : files) {
        DataFile& file = *each;
        const std::string& named = file.absolutePath.empty() ? file.path : file.absolutePath;
        if (codec::isRemote(named)) {
            file = describeFile(named);
            continue;
        }
        const fs::path where = absolutePath(named);
        file.absolutePath = where.generic_string();
        const fs::path relative = where.lexically_relative(folder);
        file.path = relative.empty() ? where.generic_string() : relative.generic_string();
    }
    std::string& picture = session.lighting.environment.picture;
    if (!picture.empty()) {
        const fs::path relative = absolutePath(picture).lexically_relative(folder);
        picture = relative.empty() ? absolutePath(picture).generic_string() : relative.generic_string();
    }
    session.animation.playing = false;
    keepWithinRanges(session); // else it could not be read back
    Json json = toJson(session);
    restoreUnknown(json, document.unknown);
    json["app"] = "tessera";
    if (!document.history.steps().empty()) json["history"] = document.history.toJson();
    return printJson(json);
}

void saveSession(const SessionDocument& document, const std::string& path) {
    writeAtomically(path, printSession(document, path));
}

} // namespace tessera::app
