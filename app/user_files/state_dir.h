#pragma once

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
/// in any way: an autosave without a lock was left by a crashed run.
class Autosave {
public:
    explicit Autosave(std::string folder);
    ~Autosave(); ///< removes the autosave: a clean end
    Autosave(const Autosave&) = delete;
    Autosave& operator=(const Autosave&) = delete;

    /// Sessions of dead runs, newest first.
    std::vector<Recovery> abandoned() const;
    static void discard(const Recovery& recovery);
    /// Writes the session text; failures (a full disk) are returned as a message, never thrown.
    std::string save(const std::string& text);
    void remove();

private:
    std::string folder_, path_;
    int lock_ = -1;
};

} // namespace tessera::app
