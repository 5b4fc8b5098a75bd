#include "volume/base/background.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <thread>
#include <unistd.h>

namespace tessera {
namespace {

int niceness() {
    return getpriority(PRIO_PROCESS, id_t(gettid()));
}

// A thread that works in the background goes behind the one that began it, which stays as it was; twice is as once.
TEST(Background, AThreadGoesBehindTheOthers) {
    const int own = niceness();
    int once = 0, twice = 0, started = 0;
    std::thread([&] {
        workInBackground();
        once = niceness();
        workInBackground();
        twice = niceness();
        std::thread([&] { started = niceness(); }).join();
    }).join();
    EXPECT_EQ(once, std::max(own, 10)) << "where all of it is in the background already, it stays there";
    EXPECT_EQ(twice, once);
    EXPECT_EQ(started, once) << "what it starts goes with it";
    EXPECT_EQ(niceness(), own);
}

} // namespace
} // namespace tessera
