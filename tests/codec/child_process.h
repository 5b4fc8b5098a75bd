#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

namespace tessera::codec::testing {

/// Tests whose children compute: threads of the parent are not in them, and one that TBB counts on is waited for
/// without end. So the parent starts none.
class WithChildren : public ::testing::Test {
    tbb::global_control alone_{tbb::global_control::max_allowed_parallelism, 1};
};

/// A process that runs `work`; its exit status is 0 if that returns true.
template <class Work> pid_t started(Work&& work) {
    const pid_t child = ::fork();
    if (child != 0) return child;
    bool good = false;
    try {
        good = work();
    } catch (...) {
    }
    ::_exit(good ? 0 : 1);
}

/// Waits for its end: its exit status, or the negative number of the signal that ended it.
inline int statusOf(pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

} // namespace tessera::codec::testing
