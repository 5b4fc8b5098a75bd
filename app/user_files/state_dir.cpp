#include "app/user_files/state_dir.h"

#include "app/history/session_file.h"
#include "codec/remote/address.h"
#include "volume/base/error.h"
#include "volume/system/atomic_file.h"
#include "volume/system/user_folder.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <sys/stat.h>
#include <unistd.h>

namespace tessera::app {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kRecent = 12;
constexpr const char* kPrefix = "autosave-";
constexpr const char* kSuffix = ".tessera.json";

std::string lockPath(const std::string& session) {
    return session + ".lock";
}

/// An exclusive lock on the name of a session; nothing while another process has it. Throws MachineError where there
/// are no locks.
std::optional<LockedFile> claim(const std::string& session) {
    const std::string path = lockPath(session);
    for (;;) {
        std::optional<LockedFile> lock = LockedFile::tryLock(path, LockedFile::Kind::Exclusive);
        if (!lock || lock->isAt(path)) return lock;
        // Another process has removed the file before it was locked here: it keeps nobody out.
    }
}

/// Gives up a claimed name.
void release(const std::string& session, std::optional<LockedFile>& lock) {
    if (lock && lock->isAt(lockPath(session))) ::unlink(lockPath(session).c_str());
    lock.reset();
}

} // namespace

std::string stateFolder() {
    return userFolder("XDG_STATE_HOME", ".local/state");
}

std::vector<std::string> recentFiles(const std::string& folder) {
    std::vector<std::string> files;
    if (folder.empty()) return files;
    try {
        const Json list = parseJson(readText(folder + "/recent.json"), {});
        if (list.is_array())
            for (const Json& entry : list)
                if (entry.is_string() && files.size() < kRecent) files.push_back(entry.get<std::string>());
    } catch (const Error&) {
        // No list yet, or a broken one: it is only a convenience.
    }
    return files;
}

void addRecentFile(const std::string& folder, const std::string& path) {
    if (folder.empty()) return;
    std::error_code problem;
    const std::string absolute = codec::isRemote(path) ? path : fs::absolute(path, problem).lexically_normal().string();
    std::vector<std::string> files = recentFiles(folder);
    std::erase(files, absolute);
    files.insert(files.begin(), absolute);
    if (files.size() > kRecent) files.resize(kRecent);
    try {
        writeAtomically(folder + "/recent.json", printJson(Json(files)));
    } catch (const Error&) {
        // Only a convenience.
    }
}

namespace {

std::map<std::string, std::string> choices(const std::string& folder) {
    std::map<std::string, std::string> made;
    try {
        const Json list = parseJson(readText(folder + "/choices.json"), {});
        if (list.is_object())
            for (const auto& [name, value] : list.items())
                if (value.is_string()) made[name] = value.get<std::string>();
    } catch (const Error&) {
        // None yet, or a broken list: it is only a convenience.
    }
    return made;
}

} // namespace

std::string rememberedChoice(const std::string& folder, const std::string& name) {
    if (folder.empty()) return {};
    const auto made = choices(folder);
    const auto found = made.find(name);
    return found == made.end() ? std::string() : found->second;
}

void rememberChoice(const std::string& folder, const std::string& name, const std::string& value) {
    if (folder.empty()) return;
    auto made = choices(folder);
    made[name] = value;
    try {
        writeAtomically(folder + "/choices.json", printJson(Json(made)));
    } catch (const Error&) {
        // Only a convenience.
    }
}

Autosave::Autosave(std::string folder) : folder_(std::move(folder)) {
    if (!folder_.empty()) takeName();
}

/// Takes the first name whose lock is free and that no session has: one that has was left by a crashed run.
void Autosave::takeName() {
    constexpr int kMostNames = 1000;
    problem_ = folder_ + ": no name is free";
    try {
        for (int n = 0; n < kMostNames; ++n) {
            const std::string path = folder_ + "/" + kPrefix + std::to_string(getpid()) +
                                     (n == 0 ? std::string() : "-" + std::to_string(n)) + kSuffix;
            std::optional<LockedFile> lock = claim(path);
            if (!lock) continue;
            if (::access(path.c_str(), F_OK) == 0) {
                release(path, lock);
                continue;
            }
            path_ = path;
            lock_ = std::move(lock);
            problem_.clear();
            return;
        }
    } catch (const Error& error) {
        problem_ = error.what();
    }
}

Autosave::~Autosave() {
    remove();
    release(path_, lock_);
}

std::vector<Recovery> Autosave::abandoned() const {
    std::vector<std::pair<std::time_t, std::string>> found;
    std::error_code problem;
    if (folder_.empty() || !lock_) return {}; // without locks it is not known who is alive
    const std::string locked = std::string(kSuffix) + ".lock";
    std::set<std::string> sessions;
    for (const auto& entry : fs::directory_iterator(folder_, problem)) {
        std::string name = entry.path().filename().string();
        if (name.ends_with(locked)) name.resize(name.size() - 5);
        if (name.starts_with(kPrefix) && name.ends_with(kSuffix)) sessions.insert(folder_ + "/" + name);
    }
    sessions.erase(path_);
    for (const std::string& session : sessions) try {
            std::optional<LockedFile> lock = claim(session);
            if (!lock) continue; // its run is still active
            struct stat status {};
            if (::stat(session.c_str(), &status) == 0) found.emplace_back(status.st_mtime, session);
            release(session, lock);
        } catch (const Error&) {
            // Somebody else's: it stays.
        }
    std::sort(found.rbegin(), found.rend());
    std::vector<Recovery> all;
    for (const auto& [time, path] : found) {
        char text[64] = "";
        std::tm local{};
        if (localtime_r(&time, &local)) std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &local);
        all.push_back({path, text});
    }
    return all;
}

void Autosave::discard(const Recovery& recovery) {
    try {
        std::optional<LockedFile> lock = claim(recovery.path);
        if (!lock) return;
        ::unlink(recovery.path.c_str());
        release(recovery.path, lock);
    } catch (const Error&) {
        // It stays, and is offered again.
    }
}

std::string Autosave::save(const std::string& text) {
    if (!lock_) takeName(); // why there is none has been said
    if (!lock_) return {};
    if (!lock_->isAt(lockPath(path_))) { // somebody tidied up: what was kept counts as left by a crashed run
        lock_.reset();
        takeName();
        if (!lock_) return problem_;
    }
    try {
        writeAtomically(path_, text);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

void Autosave::remove() {
    if (lock_ && lock_->isAt(lockPath(path_))) ::unlink(path_.c_str());
}

} // namespace tessera::app
