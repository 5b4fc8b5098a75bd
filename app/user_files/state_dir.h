#pragma once

#include "volume/system/locked_file.h"

#include <optional>
#include <string>
#include <vector>

/// What the program remembers between runs, in $XDG_STATE_HOME/tessera: recent files, choices for data opened later,
/// and the autosaved session of a run that crashed.
namespace tessera::app {

/// The folder, made if need be; "" when there is none (nothing is remembered then).
std::string stateFolder();

/// Files opened lately, newest first. A missing or broken list is an empty one.
std::vector<std::string> recentFiles(const std::string& folder);
void addRecentFile(const std::string& folder, const std::string& path);

/// Choices that hold for data opened later, by name; "" where none was made. A missing or broken list is an empty one.
std::string rememberedChoice(const std::string& folder, const std::string& name);
void rememberChoice(const std::string& folder, const std::string& name, const std::string& value);

/// A session left behind by a run that crashed.
struct Recovery {
    std::string path;
    std::string when; ///< local date and time of the last autosave
};

/// Keeps the autosave of this run. It holds a lock on a file beside it, which the system releases when the process ends
/// in any way: an autosave without a lock was left by a crashed run. Processes of several machines or containers may
/// share the folder and have the same number: a name counts as free only with the lock on it, and nothing is removed
/// without its lock.
class Autosave {
public:
    /// "" for the folder keeps nothing.
    explicit Autosave(std::string folder);
    ~Autosave(); ///< removes the autosave: a clean end
    Autosave(const Autosave&) = delete;
    Autosave& operator=(const Autosave&) = delete;

    /// Why nothing is kept though there is a folder; "" where all is well.
    const std::string& problem() const { return problem_; }
    /// Sessions of dead runs, newest first. Locks that were left without a session are removed.
    std::vector<Recovery> abandoned() const;
    /// Removes a session of a dead run, unless it is in use again.
    static void discard(const Recovery& recovery);
    /// Writes the session text; failures (a full disk) are returned as a message, never thrown.
    std::string save(const std::string& text);
    void remove();

private:
    void takeName();

    std::string folder_, path_, problem_;
    std::optional<LockedFile> lock_;
};

} // namespace tessera::app
