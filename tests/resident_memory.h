#pragma once

#include <fstream>
#include <unistd.h>

namespace tessera::test {

/// Resident memory of the process, MB.
inline double residentMemory() {
    std::ifstream statistics("/proc/self/statm");
    double pages = 0;
    statistics >> pages >> pages;
    return pages * double(::sysconf(_SC_PAGESIZE)) / 1e6;
}

} // namespace tessera::test
