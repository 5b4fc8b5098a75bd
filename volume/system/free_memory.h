#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tessera::volume {

/// How much of what is freed the C library keeps for later allocations, in bytes: at most `most` together, and no block
/// above `largest` (at most 32 MiB is possible). By default it keeps little, and every page that comes anew from the
/// system costs a page fault: up to half the time of packing, a third of that of a picture. Does nothing where the C
/// library cannot.
void keepFreeMemory(std::size_t most, std::size_t largest);
/// The same with what suits a program that works on large data and may use the machine's memory. Threads share
/// memoryHeaps() heaps: by default there are up to eight for each processor, each with gaps of its own, which took 100
/// of 500 MB of the window; packing is as fast with one.
void keepFreeMemory();
/// One for every four processors, at least 2.
int memoryHeaps();

/// Gives pages of the heap that hold nothing back to the system, on all threads' behalf; takes some 10 ms a GB. What
/// threads allocate and free for a moment, such as the compilers of drivers, is else kept by the C library for ever.
/// Does nothing where the C library cannot.
void giveBackFreeMemory();

/// Makes room for so many bytes. More than the C library keeps for later allocations come from the system in large
/// pages where it has such, since each page costs a fault. Throws MachineError as requireMemory().
void reserveLarge(std::vector<std::byte>& bytes, std::size_t size);

/// Where the system tells of itself.
struct SystemFiles {
    std::string processes = "/proc", groups = "/sys/fs/cgroup";
};

/// Memory of this machine, or what the control groups of this process allow of it, bytes; the largest number if
/// unknown.
std::uint64_t machineMemory(const SystemFiles& files = {});

/// Bytes that the system, and the control groups of this process, can give to programs, without swapping or with it;
/// infinity where they do not say.
double availableMemory(const SystemFiles& files = {}, bool withSwap = false);

/// Throws MachineError if so many bytes are not available: a system that promises more than it has would end the
/// program later.
void requireMemory(double bytes);

} // namespace tessera::volume
