#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace tessera::vis {

/// Priority of the threads of a queue (volume/base/background.h).
enum class JobThreads { Equal, Background };

/// A thread pool that runs the most urgent job first. Jobs must not throw and should check the stop token regularly.
class JobQueue {
public:
    using Work = std::function<void(std::stop_token)>;

    JobQueue(int count, JobThreads threads);
    /// Makes it at least so many threads; for work that waits more than it computes.
    void grow(int count);
    ~JobQueue(); ///< requests running jobs to stop, drops queued ones and waits

    /// Smaller priorities run first, equal ones in the order of insertion.
    void add(double priority, Work work);
    /// Removes queued jobs and requests running ones to stop, without waiting.
    void cancel();
    /// Waits until a job ends, or until nothing is queued or running.
    void waitForOne();
    int unfinished() const;

private:
    struct Job {
        double priority;
        std::size_t number;
        Work work;
    };
    void run(std::stop_token ending);

    mutable std::mutex mutex_;
    std::condition_variable_any wake_, ended_;
    std::vector<Job> jobs_; ///< a heap, the most urgent on top
    std::size_t added_ = 0, finished_ = 0;
    int running_ = 0;
    std::stop_source stop_;
    JobThreads priority_;
    std::vector<std::jthread> threads_;
};

} // namespace tessera::vis
