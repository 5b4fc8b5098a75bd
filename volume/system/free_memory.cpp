#include "volume/system/free_memory.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <sys/mman.h>
#include <thread>
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

double availableMemory() {
    std::ifstream in("/proc/meminfo");
    double kibibytes = 0;
    for (std::string line; std::getline(in, line);)
        if (std::sscanf(line.c_str(), "MemAvailable: %lf kB", &kibibytes) == 1) return kibibytes * 1024;
    return std::numeric_limits<double>::infinity();
}

} // namespace tessera::volume
