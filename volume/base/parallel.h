#pragma once

#include <cstddef>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace tessera {

/// Calls `body(begin, end)` for disjoint ranges that cover [0, count), on all cores. The result must not depend on how
/// the range is cut: same input, same output, on any number of threads.
template <class Body> void parallelRanges(std::size_t count, Body&& body, std::size_t grain = 1) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); });
}

/// On how many threads the functions here run a body at once, at most.
inline int mostThreads() {
    return tbb::this_task_arena::max_concurrency();
}

/// Calls `body(i)` for every i in [0, count), on all cores.
template <class Body> void parallelFor(std::size_t count, Body&& body, std::size_t grain = 1) {
    parallelRanges(
        count,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) body(i);
        },
        grain);
}

} // namespace tessera
