#include "app/user_files/state_dir.h"

#include "app/history/session_file.h"
#include "codec/remote/address.h"
#include "volume/base/error.h"
#include "volume/system/atomic_file.h"
#include "volume/system/user_folder.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fcntl.h>
#include <filesystem>
#include <map>
#include <sys/file.h>
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

/// An exclusive lock on a file, or -1.
int lockFile(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (file >= 0 && ::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
    if (file >= 0) ::close(file);
    return -1;
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
    if (folder_.empty()) return;
    path_ = folder_ + "/" + kPrefix + std::to_string(getpid()) + kSuffix;
    lock_ = lockFile(lockPath(path_));
}

Autosave::~Autosave() {
    remove();
    if (lock_ < 0) return;
    ::unlink(lockPath(path_).c_str());
    ::close(lock_);
}

std::vector<Recovery> Autosave::abandoned() const {
    std::vector<std::pair<std::time_t, std::string>> found;
    std::error_code problem;
    if (folder_.empty()) return {};
    for (const auto& entry : fs::directory_iterator(folder_, problem)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(kPrefix) || !name.ends_with(kSuffix) || entry.path() == path_) continue;
        const int lock = lockFile(lockPath(entry.path().string()));
        if (lock < 0) continue; // its run is still active
        ::close(lock);
        struct stat status {};
        if (::stat(entry.path().c_str(), &status) == 0) found.emplace_back(status.st_mtime, entry.path().string());
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
    ::unlink(recovery.path.c_str());
    ::unlink(lockPath(recovery.path).c_str());
}

std::string Autosave::save(const std::string& text) {
    if (path_.empty() || lock_ < 0) return {};
    try {
        writeAtomically(path_, text);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

void Autosave::remove() {
    if (!path_.empty()) ::unlink(path_.c_str());
}

} // namespace tessera::app
