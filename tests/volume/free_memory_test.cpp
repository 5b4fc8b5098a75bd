#include "tests/resident_memory.h"
#include "volume/system/free_memory.h"

#include <gtest/gtest.h>
#include <memory>
#include <vector>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)

namespace tessera::volume {
namespace {

// The last block stays in use, so that the C library by itself cannot shorten the heap.
TEST(FreeMemory, ComesBackFromBelowBlocksInUse) {
    constexpr std::size_t kBlock = 32'000, kCount = 4'000; // bytes; 128 MB
    std::vector<std::unique_ptr<std::vector<char>>> blocks;
    for (std::size_t i = 0; i < kCount; ++i) blocks.push_back(std::make_unique<std::vector<char>>(kBlock, 'x'));
    for (std::size_t i = 0; i + 1 < kCount; ++i) blocks[i].reset();
    const double before = tessera::test::residentMemory();
    giveBackFreeMemory();
    EXPECT_LT(tessera::test::residentMemory(), before - 100);
}

} // namespace
} // namespace tessera::volume

#endif
