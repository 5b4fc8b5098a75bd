#include "vis/gl/job_queue.h"

#include "volume/base/background.h"

#include <algorithm>

namespace tessera::vis {

namespace {

/// Heap order: the smallest priority on top; equal priorities in the order of insertion.
constexpr auto later = [](const auto& a, const auto& b) {
    return a.priority != b.priority ? a.priority > b.priority : a.number > b.number;
};

} // namespace

JobQueue::JobQueue(int count, JobThreads threads) : priority_(threads) {
    grow(std::max(count, 1));
}

void JobQueue::grow(int count) {
    while (int(threads_.size()) < count)
        threads_.emplace_back([this](std::stop_token ending) {
            if (priority_ == JobThreads::Background) workInBackground();
            run(ending);
        });
}

JobQueue::~JobQueue() {
    cancel();
    for (std::jthread& thread : threads_) thread.request_stop();
    wake_.notify_all();
    threads_.clear(); // joins
}

void JobQueue::add(double priority, Work work) {
    {
        const std::lock_guard lock(mutex_);
        jobs_.push_back({priority, added_++, std::move(work)});
        std::push_heap(jobs_.begin(), jobs_.end(), later);
    }
    wake_.notify_one();
}

void JobQueue::cancel() {
    const std::lock_guard lock(mutex_);
    jobs_.clear();
    stop_.request_stop();
    stop_ = std::stop_source();
}

void JobQueue::waitForOne() {
    std::unique_lock lock(mutex_);
    const std::size_t before = finished_;
    ended_.wait(lock, [&] { return finished_ != before || (jobs_.empty() && running_ == 0); });
}

int JobQueue::unfinished() const {
    const std::lock_guard lock(mutex_);
    return int(jobs_.size()) + running_;
}

void JobQueue::run(std::stop_token ending) {
    std::unique_lock lock(mutex_);
    while (wake_.wait(lock, ending, [&] { return !jobs_.empty(); }) && !ending.stop_requested()) {
        std::pop_heap(jobs_.begin(), jobs_.end(), later);
        const Work work = std::move(jobs_.back().work);
        jobs_.pop_back();
        ++running_;
        const std::stop_token stop = stop_.get_token();
        lock.unlock();
        work(stop);
        lock.lock();
        --running_;
        ++finished_;
        ended_.notify_all();
    }
}

} // namespace tessera::vis
