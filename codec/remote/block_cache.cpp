#include "codec/remote/block_cache.h"

#include "volume/base/error.h"
#include "volume/system/user_folder.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>

namespace tessera::codec {

namespace fs = std::filesystem;

namespace {

/// Share of the limit that is written before files are counted again; up to that much is removed beyond need.
constexpr std::uint64_t kTrimShare = 16;

std::string temporaryFolder() {
    std::string name = (fs::temp_directory_path() / "tessera-remote-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw MachineError(std::string("cannot be made: ") + std::strerror(errno), name);
    return name;
}

} // namespace

std::string remoteCacheFolder() {
    const std::string own = userFolder("XDG_CACHE_HOME", ".cache");
    if (own.empty()) return {};
    const std::string folder = own + "/remote";
    ::mkdir(folder.c_str(), 0700); // samples of private files
    return ::access(folder.c_str(), W_OK | X_OK) == 0 ? folder : std::string();
}

BlockCache::BlockCache(const std::string& folder, const std::string& name, std::uint64_t limit)
    : folder_(folder.empty() ? temporaryFolder() : folder), files_(folder_ + "/" + name), temporary_(folder.empty()),
      limit_(limit) {
    trimCache(folder_, limit_ - limit_ / kTrimShare); // the limit may be smaller than before
}

BlockCache::~BlockCache() {
    std::error_code ignored;
    if (temporary_) fs::remove_all(folder_, ignored);
}

std::string BlockCache::pathOf(std::uint64_t block) const {
    return files_ + "/" + std::to_string(block);
}

void BlockCache::clear() {
    std::error_code ignored;
    fs::remove_all(files_, ignored);
}

void BlockCache::takeOver(const std::string& name) {
    const std::string from = folder_ + "/" + name;
    std::error_code problem;
    if (from == files_ || !fs::is_directory(from, problem)) return;
    ::mkdir(files_.c_str(), 0700);
    std::vector<std::string> blocks;
    for (fs::directory_iterator at(from, problem), end; !problem && at != end; at.increment(problem))
        if (const std::string block = at->path().filename().string(); block.find('.') == std::string::npos)
            blocks.push_back(block); // no part that is being written
    for (const std::string& block : blocks)
        if (const fs::path own = fs::path(files_) / block, old = fs::path(from) / block;
            ::access(own.c_str(), F_OK) != 0)
            (void)::rename(old.c_str(), own.c_str());
    ::rmdir(from.c_str()); // succeeds only when it is empty
}

bool BlockCache::has(std::uint64_t block, std::size_t bytes) const {
    struct stat state {};
    return ::stat(pathOf(block).c_str(), &state) == 0 && state.st_size == static_cast<off_t>(bytes);
}

bool BlockCache::read(std::uint64_t block, std::span<std::byte> bytes) const {
    const int file = ::open(pathOf(block).c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return false;
    struct stat state {};
    const bool whole = ::fstat(file, &state) == 0 && state.st_size == static_cast<off_t>(bytes.size()) &&
                       ::pread(file, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size());
    if (whole) ::futimens(file, nullptr);
    ::close(file);
    return whole;
}

void BlockCache::write(std::uint64_t block, std::span<const std::byte> bytes) {
    const std::string path = pathOf(block);
    const std::string part = path + ".part-" + std::to_string(::getpid()) + "-" + std::to_string(parts_++);
    ::mkdir(files_.c_str(), 0700);
    const int file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (file < 0) return;
    const bool written = ::write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
    if (::close(file) != 0 || !written || ::rename(part.c_str(), path.c_str()) != 0) {
        ::unlink(part.c_str());
        return;
    }
    if ((written_ += bytes.size()) < limit_ / kTrimShare) return;
    const std::unique_lock lock(trimming_, std::try_to_lock);
    if (!lock) return; // another thread does it
    written_ = 0;
    trimCache(folder_, limit_ - 2 * (limit_ / kTrimShare));
}

void trimCache(const std::string& folder, std::uint64_t limit) {
    struct Kept {
        timespec used;
        std::uint64_t bytes;
        std::string path;
    };
    std::vector<Kept> kept;
    std::uint64_t sum = 0;
    std::error_code problem;
    for (fs::recursive_directory_iterator at(folder, problem), end; !problem && at != end; at.increment(problem)) {
        struct stat state {};
        const std::string path = at->path().string();
        if (::lstat(path.c_str(), &state) != 0 || !S_ISREG(state.st_mode)) continue;
        kept.push_back({state.st_mtim, static_cast<std::uint64_t>(state.st_size), path});
        sum += kept.back().bytes;
    }
    if (sum <= limit) return;
    std::sort(kept.begin(), kept.end(), [](const Kept& a, const Kept& b) {
        return a.used.tv_sec != b.used.tv_sec ? a.used.tv_sec < b.used.tv_sec : a.used.tv_nsec < b.used.tv_nsec;
    });
    for (const Kept& oldest : kept) {
        if (sum <= limit) break;
        ::unlink(oldest.path.c_str());
        sum -= oldest.bytes;
        ::rmdir(fs::path(oldest.path).parent_path().c_str()); // succeeds only when it is empty
    }
}

} // namespace tessera::codec
