#include "volume/system/free_memory.h"

#include <fstream>
#include <gtest/gtest.h>
#include <memory>
#include <unistd.h>
#include <vector>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)

namespace tessera::volume {
namespace {

/// Resident memory of the process, MB.
double residentMemory() {
    std::ifstream statistics("/proc/self/statm");
    double pages = 0;
    statistics >> pages >> pages;
    return pages * double(::sysconf(_SC_PAGESIZE)) / 1e6;
}

// The last block stays in use, so that the C library by itself cannot shorten the heap.
TEST(FreeMemory, ComesBackFromBelowBlocksInUse) {
    constexpr std::size_t kBlock = 32'000, kCount = 4'000; // bytes; 128 MB
    std::vector<std::unique_ptr<std::vector<char>>> blocks;
    for (std::size_t i = 0; i < kCount; ++i) blocks.push_back(std::make_unique<std::vector<char>>(kBlock, 'x'));
    for (std::size_t i = 0; i + 1 < kCount; ++i) blocks[i].reset();
    const double before = residentMemory();
    giveBackFreeMemory();
    EXPECT_LT(residentMemory(), before - 100);
}

} // namespace
} // namespace tessera::volume

#endif
