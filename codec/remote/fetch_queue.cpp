#include "codec/remote/fetch_queue.h"

#include "volume/base/error.h"

#include <algorithm>
#include <string>
#include <system_error>

namespace tessera::codec {

namespace {

std::stop_source& ofAllRequests() {
    static std::stop_source source;
    return source;
}

} // namespace

void endRequests() {
    ofAllRequests().request_stop();
}

std::stop_token endOfRequests() {
    return ofAllRequests().get_token();
}

FetchQueue::FetchQueue(Connect connect, int connections, std::chrono::duration<double> patience,
                       const std::stop_token& ending)
    : connect_(std::move(connect)), connections_(static_cast<std::size_t>(std::max(connections, 1))),
      patience_(patience), ending_(ending, [this] { end(); }) {}

FetchQueue::~FetchQueue() {
    end(); // all threads, before the first is waited for
}

void FetchQueue::end() {
    std::vector<std::stop_source> stops;
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
        for (std::jthread& thread : threads_) stops.push_back(thread.get_stop_source());
    }
    for (std::stop_source& stop : stops) stop.request_stop();
}

std::vector<Reply> FetchQueue::fetch(std::span<const FileRange> ranges) {
    Call call;
    call.replies.resize(ranges.size());
    call.left = ranges.size();
    std::unique_lock lock(mutex_);
    if (ended_) throw Cancelled();
    startThreads(jobs_.size() + ranges.size());
    for (std::size_t i = 0; i < ranges.size(); ++i) jobs_.push_back({ranges[i], &call, i});
    wanted_.notify_all();
    done_.wait(lock, [&] { return call.left == 0; });
    if (call.failure) std::rethrow_exception(call.failure);
    return std::move(call.replies);
}

/// Starts threads until there is one for each job, as far as connections suffice. If no more can be started, those that
/// run do the work; throws MachineError if there is none.
void FetchQueue::startThreads(std::size_t jobs) {
    while (idle_ < jobs && threads_.size() < connections_) {
        try {
            threads_.emplace_back([this](const std::stop_token& stop) { work(stop); });
        } catch (const std::system_error& error) {
            if (threads_.empty()) throw MachineError(std::string("no thread can be started: ") + error.what());
            return;
        }
        ++idle_;
    }
}

void FetchQueue::work(const std::stop_token& stop) {
    std::unique_ptr<Connection> connection;
    std::unique_lock lock(mutex_);
    while (wanted_.wait(lock, stop, [&] { return !jobs_.empty(); })) {
        const Job job = jobs_.front();
        jobs_.pop_front();
        --idle_;
        lock.unlock();
        Reply reply;
        std::exception_ptr failure;
        try {
            reply = readPatiently(job.range, connection, stop);
        } catch (...) {
            failure = std::current_exception();
            connection.reset(); // answers may be underway on it
        }
        lock.lock();
        ++idle_;
        job.call->replies[job.number] = std::move(reply);
        if (failure && !job.call->failure) job.call->failure = failure;
        if (--job.call->left == 0) done_.notify_all();
    }
}

Reply FetchQueue::readPatiently(FileRange range, std::unique_ptr<Connection>& connection, const std::stop_token& stop) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    std::chrono::duration<double> pause(0.1);
    for (int tries = 1;; ++tries) {
        if (stop.stop_requested()) throw Cancelled();
        try {
            if (!connection) connection = connect_();
            return connection->read(range, stop);
        } catch (const PassingError& error) {
            connection.reset();
            if (Clock::now() - begin + pause > patience_)
                throw ReadError(error.reason() + (tries > 1 ? "; tried " + std::to_string(tries) + " times" : ""),
                                error.file());
        } catch (const Error& error) {
            throw ReadError(error.reason(), error.file());
        }
        std::mutex own;
        std::unique_lock lock(own);
        std::condition_variable_any pausing;
        pausing.wait_for(lock, stop, pause, [] { return false; });
        pause *= 2;
    }
}

} // namespace tessera::codec
