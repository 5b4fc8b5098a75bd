#pragma once

#include "volume/base/error.h"

namespace tessera::codec::testing {

/// The smallest limit of memory, in MB and to 0.05 MB, with which `pack(limit)` throws no Error: it depends on the
/// number of processors.
template <class Pack> double leastMemory(Pack&& pack) {
    double fails = 1, works = 4000;
    while (works - fails > 0.05) {
        const double middle = (fails + works) / 2;
        try {
            pack(middle);
            works = middle;
        } catch (const Error&) {
            fails = middle;
        }
    }
    return works;
}

} // namespace tessera::codec::testing
