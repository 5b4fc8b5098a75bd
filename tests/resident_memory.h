#pragma once

#include <fstream>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace tessera::test {

/// Resident memory of the process, MB.
inline double residentMemory() {
    std::ifstream statistics("/proc/self/statm");
    double pages = 0;
    statistics >> pages >> pages;
    return pages * double(::sysconf(_SC_PAGESIZE)) / 1e6;
}

/// Memory that is allocated from the C library, MB; 0 where it does not say. What is resident beyond it are gaps, code
/// and the memory of drivers.
inline double allocatedMemory() {
#ifdef __GLIBC__
    const struct mallinfo2 info = ::mallinfo2();
    return double(info.uordblks + info.hblkhd) / 1e6;
#else
    return 0;
#endif
}

} // namespace tessera::test
