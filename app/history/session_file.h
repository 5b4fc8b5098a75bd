#pragma once

#include "app/history/history.h"
#include "app/session/session.h"

#include <filesystem>
#include <string>
#include <vector>

/// Session files (*.tessera.json): reading, checking, migrating, writing, and finding the data they name.
namespace tessera::app {

/// What a session file holds.
struct SessionDocument {
    Session session;
    History history;
    std::vector<JsonIssue> unknown;    ///< keys this version does not know; written again when saved
    std::vector<std::string> messages; ///< for the log: unknown keys, idle keyframes, a history that was dropped
    Json raw;                          ///< as read, migrated: tells which keys a layout leaves out
};

/// Reads session text. Throws Error with `file` and the JSON path or line. The path of the environment picture,
/// relative to the file's folder, becomes absolute.
SessionDocument parseSession(std::string_view text, const std::string& file);

/// Reads a session file. Throws Error.
SessionDocument loadSession(const std::string& path);

/// True when a JSON text is a session, also a damaged one, not e.g. the sidecar of a raw file. Never throws.
bool looksLikeSession(std::string_view text);

/// Session text as it is saved at `path` (files that it names relative to its folder): sorted keys, one item per line.
std::string printSession(const SessionDocument& document, const std::string& path);

/// Writes a session atomically (temporary file, then rename). Throws MachineError when it cannot.
void saveSession(const SessionDocument& document, const std::string& path);

/// Brings a document of an older schema up to date. Throws Error for a newer one and for those before kOldestSchema.
void migrate(Json& document, const std::string& file);

/// A path from the root, without "." and "..".
std::filesystem::path absolutePath(const std::string& path);

/// Path, size and hashes of a data file or folder and its companion files. Absolute paths; no hash if unreadable.
DataFile describeFile(const std::string& path);

/// A data file that is not where the session says.
struct MissingData {
    std::size_t index = 0; ///< into DataRef::files
    DataFile wanted;
    bool other = false; ///< into those of DataRef::other instead
    bool table = false; ///< the missing file is the table over time
};
struct ResolvedData {
    DataRef data; ///< `path` and `absolutePath` both absolute where found
    std::vector<MissingData> missing;
    std::vector<std::string> warnings; ///< e.g. a file that has changed since
};
/// Finds data files and tables over time, including those of DataRef::other: relative to the session's folder, then at
/// the absolute path, then by name in the folder.
ResolvedData resolveData(const DataRef& data, const std::string& folder);

/// Sets the new path of a missing file.
void locate(DataRef& data, const MissingData& missing, const std::string& path);

/// Records size and hash of the tables over time if missing.
void noteTables(DataRef& data);

/// A whole file as text. Throws Error.
std::string readText(const std::string& path);

} // namespace tessera::app
