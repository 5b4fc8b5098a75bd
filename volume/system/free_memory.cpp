#include "volume/system/free_memory.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <sys/mman.h>
#include <thread>
#include <vector>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace tessera::volume {

namespace {

constexpr std::size_t kMebi = 1 << 20, kLargestKept = 32 * kMebi;

} // namespace

void keepFreeMemory([[maybe_unused]] std::size_t most, [[maybe_unused]] std::size_t largest) {
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, int(largest));
    mallopt(M_TRIM_THRESHOLD, int(most));
#endif
}

int memoryHeaps() {
    return std::max(2, int(std::thread::hardware_concurrency()) / 4);
}

void keepFreeMemory() {
    keepFreeMemory(256 * kMebi, kLargestKept);
#ifdef __GLIBC__
    mallopt(M_ARENA_MAX, memoryHeaps());
#endif
}

void reserveLarge(std::vector<std::byte>& bytes, std::size_t size) {
    if (size <= bytes.capacity()) return;
    requireMemory(double(size));
    bytes.reserve(size);
    if (size <= kLargestKept) return;
    constexpr std::uintptr_t kPage = 4096;
    const auto begin = reinterpret_cast<std::uintptr_t>(bytes.data()), first = (begin + kPage - 1) / kPage * kPage;
    ::madvise(reinterpret_cast<void*>(first), begin + size - first, MADV_HUGEPAGE); // if it is possible
}

void giveBackFreeMemory() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// The number in a file of the system; no limit if there is none.
double numberIn(const std::string& path) {
    double number = kNoLimit;
    std::ifstream(path) >> number;
    return number > 0 ? number : kNoLimit;
}

/// The number behind a word that begins a line; no limit if there is none.
double numberAfter(const std::string& path, const std::string& word) {
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);)
        if (line.starts_with(word)) return std::strtod(line.c_str() + word.size(), nullptr);
    return kNoLimit;
}

/// A control group (cgroups(7)) of this process.
struct Group {
    double limit = kNoLimit, used = 0; ///< of memory, in bytes
    double files = 0;                  ///< part of `used`: files that are only kept in memory
};

Group groupIn(const std::string& folder, bool isFirstVersion) {
    Group group{numberIn(folder + (isFirstVersion ? "/memory.limit_in_bytes" : "/memory.max"))};
    if (!(group.limit < 1e18)) return {}; // the first version states no limit as a large number
    const double used = numberIn(folder + (isFirstVersion ? "/memory.usage_in_bytes" : "/memory.current"));
    group.used = used < kNoLimit ? used : 0; // not told
    const std::string statistics = folder + "/memory.stat", whole = isFirstVersion ? "total_" : "";
    for (const char* kind : {"inactive_file ", "active_file "}) {
        const double bytes = numberAfter(statistics, whole + kind);
        if (bytes < kNoLimit) group.files += bytes;
    }
    return group;
}

/// Its own and those around it that have a limit.
std::vector<Group> limitingGroups(const SystemFiles& files) {
    std::vector<Group> groups;
    std::ifstream in(files.processes + "/self/cgroup"); // number:controllers:path
    for (std::string line; std::getline(in, line);) {
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
        const bool isFirstVersion = controllers.find(",memory,") != std::string::npos;
        if (!isFirstVersion && controllers != ",,") continue;
        const std::string all = files.groups + (isFirstVersion ? "/memory" : "");
        for (std::string path = line.substr(second + 1);; path.resize(path.rfind('/'))) {
            const Group group = groupIn(all + path, isFirstVersion);
            if (group.limit < kNoLimit) groups.push_back(group);
            if (path.find('/') == std::string::npos) break;
        }
    }
    return groups;
}

} // namespace

std::uint64_t machineMemory(const SystemFiles& files) {
    double least = numberAfter(files.processes + "/meminfo", "MemTotal:") * 1024; // kB
    for (const Group& group : limitingGroups(files)) least = std::min(least, group.limit);
    return least < 1e18 ? std::uint64_t(least) : ~std::uint64_t(0);
}

double availableMemory(const SystemFiles& files, bool withSwap) {
    const std::string about = files.processes + "/meminfo"; // kB
    double least = (numberAfter(about, "MemAvailable:") + (withSwap ? numberAfter(about, "SwapFree:") : 0)) * 1024;
    for (const Group& group : limitingGroups(files))
        least = std::min(least, std::max(0.0, group.limit - group.used + group.files));
    return least;
}

void requireMemory(double bytes) {
    constexpr double kFew = 256.0 * kMebi, kGiga = 1e9; // few are not worth the question
    if (bytes <= kFew) return;
    const double available = availableMemory({}, true);
    if (bytes <= available) return;
    char text[120];
    std::snprintf(text, sizeof text, "not enough memory: %.3g GB are needed at once, and %.3g GB are free",
                  bytes / kGiga, available / kGiga);
    throw MachineError(text);
}

} // namespace tessera::volume
