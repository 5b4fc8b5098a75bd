#pragma once

#include "codec/remote/connection.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

namespace tessera::codec {

/// Ends the requests to all other machines for good, so that a program that quits does not wait for them: fetch()
/// throws Cancelled from now on.
void endRequests();
/// Stops when endRequests() is called.
std::stop_token endOfRequests();

/// Requests to one remote file over a few connections, each with a thread that is started when it is first needed.
/// A request that fails for the moment is sent again after a pause, which doubles each time, for `patience`; with a
/// connection of its own each time.
class FetchQueue {
public:
    using Connect = std::function<std::unique_ptr<Connection>()>;
    /// When `ending` stops, requests that are underway end, and fetch() throws Cancelled.
    FetchQueue(Connect connect, int connections, std::chrono::duration<double> patience,
               const std::stop_token& ending = endOfRequests());
    ~FetchQueue();
    FetchQueue(const FetchQueue&) = delete;
    FetchQueue& operator=(const FetchQueue&) = delete;

    /// The bytes of ranges, requested at the same time as far as connections suffice. Throws the first ReadError of
    /// any when all have ended. Thread-safe.
    std::vector<Reply> fetch(std::span<const FileRange> ranges);

private:
    /// Ranges of one call of fetch().
    struct Call {
        std::vector<Reply> replies;
        std::size_t left = 0;
        std::exception_ptr failure;
    };
    struct Job {
        FileRange range;
        Call* call;
        std::size_t number; ///< of its reply
    };
    void startThreads(std::size_t jobs);
    void work(const std::stop_token& stop);
    void end();
    Reply readPatiently(FileRange range, std::unique_ptr<Connection>& connection, const std::stop_token& stop);

    Connect connect_;
    std::size_t connections_;
    std::chrono::duration<double> patience_;
    std::mutex mutex_;
    std::condition_variable_any wanted_;
    std::condition_variable done_;
    std::deque<Job> jobs_;
    bool ended_ = false;
    std::size_t idle_ = 0;                             ///< threads that wait for a job
    std::vector<std::jthread> threads_;                ///< they end before what they use
    std::stop_callback<std::function<void()>> ending_; ///< last: it uses all the rest
};

} // namespace tessera::codec
