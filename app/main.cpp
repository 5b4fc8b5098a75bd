#include "app/command/command.h"
#include "volume/system/free_memory.h"

#include <cstddef>
#include <cstdlib>
#include <new>

#ifndef TESSERA_SANITIZED // the sanitizers have operators of their own

/// Large blocks are asked for before they are taken: a system that promises more than it has ends the program when it
/// uses them, without a word. So std::bad_alloc, which each command and job reports, is thrown in time. Blocks are used
/// at once nearly always, and what is used counts.
///
/// Replaces the operators of the whole program, so no library does it.
void* operator new(std::size_t bytes) {
    constexpr std::size_t kLarge = std::size_t(32) << 20;
    if (bytes >= kLarge && double(bytes) > tessera::volume::availableMemory({}, true)) throw std::bad_alloc();
    void* const block = std::malloc(bytes > 0 ? bytes : 1);
    if (block == nullptr) throw std::bad_alloc();
    return block;
}

void operator delete(void* block) noexcept {
    std::free(block);
}

void operator delete(void* block, std::size_t) noexcept {
    std::free(block);
}

#endif

int main(int argc, char** argv) {
    tessera::volume::keepFreeMemory();
    return tessera::app::runCommandLine(argc, argv);
}
