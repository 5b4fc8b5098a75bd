#include "tests/resident_memory.h"
#include "volume/system/free_memory.h"

#include <barrier>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <gtest/gtest.h>
#include <malloc.h>
#include <memory>
#include <sys/resource.h>
#include <thread>
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

/// Page faults so far.
long faults() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt;
}

/// Those of ten times using and freeing 16 MB in blocks of 4 MB.
long faultsOfBlocks() {
    const long before = faults();
    for (int i = 0; i < 10; ++i) {
        std::vector<std::unique_ptr<std::vector<char>>> blocks;
        for (int k = 0; k < 4; ++k) blocks.push_back(std::make_unique<std::vector<char>>(4'000'000, 'x'));
    }
    return faults() - before;
}

TEST(FreeMemory, IsKeptForTheNextBlocksUnlessLittleIsToBe) {
    constexpr long kPages = 10 * 16'000'000 / 4096;
    keepFreeMemory(1 << 17, 1 << 20);
    EXPECT_GT(faultsOfBlocks(), kPages / 5); // the system gives some pages at once
    keepFreeMemory();
    (void)faultsOfBlocks();
    EXPECT_LT(faultsOfBlocks(), kPages / 20);
}

/// Heaps of the C library by its own report.
int heaps() {
    char* text = nullptr;
    std::size_t size = 0;
    std::FILE* const out = ::open_memstream(&text, &size);
    ::malloc_info(0, out);
    std::fclose(out);
    int count = 0;
    for (const char* at = text; (at = std::strstr(at, "<heap nr=")) != nullptr; ++at) ++count;
    std::free(text);
    return count;
}

TEST(FreeMemory, ManyThreadsShareAFewHeaps) {
    const int count = 4 * memoryHeaps();
    std::barrier together(count);
    std::vector<std::jthread> threads;
    for (int i = 0; i < count; ++i)
        threads.emplace_back([&] {
            const std::vector<char> own(5000);
            together.arrive_and_wait(); // all have theirs at a time
        });
    threads.clear();
    EXPECT_LE(heaps(), memoryHeaps());
    EXPECT_GE(heaps(), 1);
}

} // namespace
} // namespace tessera::volume

#endif
