#include "vis/gl/job_queue.h"

#include <atomic>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace tessera::vis {
namespace {

TEST(JobQueue, TheMostUrgentRunsFirst) {
    std::vector<int> order;
    {
        JobQueue queue(1, JobThreads::Equal);
        std::atomic<bool> held = true;
        queue.add(0, [&](std::stop_token) {
            while (held) std::this_thread::yield();
        });
        for (const int number : {3, 1, 4, 2})
            queue.add(number, [&, number](std::stop_token) { order.push_back(number); });
        held = false;
        while (queue.unfinished() > 0) queue.waitForOne();
    }
    EXPECT_EQ(order, (std::vector<int>{1, 2, 3, 4}));
}

// Threads that load bricks go behind those of the window; those that compile what it waits for do not.
TEST(JobQueue, GrowsToMoreThreads) {
    std::atomic<int> together = 0;
    JobQueue queue(1, JobThreads::Equal);
    queue.grow(3);
    queue.grow(2);
    for (int i = 0; i < 3; ++i)
        queue.add(0, [&](std::stop_token) {
            ++together;
            for (int wait = 0; wait < 2000 && together < 3; ++wait)
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
        });
    for (int wait = 0; wait < 2000 && together < 3; ++wait) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(together, 3);
}

TEST(JobQueue, ThreadsInTheBackgroundGoBehind) {
    const int own = getpriority(PRIO_PROCESS, id_t(gettid()));
    if (own >= 10) GTEST_SKIP() << "all of it runs in the background already";
    const auto nicenessIn = [](JobThreads threads) {
        std::atomic<int> niceness = 0;
        JobQueue queue(1, threads);
        queue.add(0, [&](std::stop_token) { niceness = getpriority(PRIO_PROCESS, id_t(gettid())); });
        while (queue.unfinished() > 0) queue.waitForOne();
        return niceness.load();
    };
    EXPECT_EQ(nicenessIn(JobThreads::Equal), own);
    EXPECT_GT(nicenessIn(JobThreads::Background), own);
}

} // namespace
} // namespace tessera::vis
