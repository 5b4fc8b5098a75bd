#include "volume/system/free_memory.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace tessera::volume {

void keepFreeMemory([[maybe_unused]] std::size_t most, [[maybe_unused]] std::size_t largest) {
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, int(largest));
    mallopt(M_TRIM_THRESHOLD, int(most));
#endif
}

void keepFreeMemory() {
    constexpr std::size_t kMebi = 1 << 20;
    keepFreeMemory(256 * kMebi, 32 * kMebi);
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
