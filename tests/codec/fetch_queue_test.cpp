#include "codec/remote/fetch_queue.h"

#include <atomic>
#include <chrono>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>
#include <thread>
#include <vector>

namespace tessera::codec {
namespace {

using namespace std::chrono_literals;

/// What connections to a made-up file do, and how often.
struct Server {
    std::atomic<int> failing = 0, refusing = 0, connected = 0, asked = 0, underway = 0, mostUnderway = 0;
    std::chrono::milliseconds delay{0};

    Reply read(FileRange range) {
        ++asked;
        for (int now = ++underway, most = mostUnderway; now > most && !mostUnderway.compare_exchange_weak(most, now);)
            ;
        std::this_thread::sleep_for(delay);
        --underway;
        if (failing > 0 && failing-- > 0) throw PassingError("busy", "http://there/a.tsr");
        if (refusing > 0 && refusing-- > 0) throw Error("no such file", "http://there/a.tsr");
        // The byte at each place is its place.
        Reply reply{std::vector<std::byte>(range.length), 200, "1"};
        for (std::size_t i = 0; i < range.length; ++i) reply.bytes[i] = static_cast<std::byte>(range.offset + i);
        return reply;
    }
    FetchQueue::Connect connect() {
        struct One final : Connection {
            explicit One(Server& to) : server(to) {}
            Reply read(FileRange range, const std::stop_token&) override { return server.read(range); }
            Server& server;
        };
        return [this]() -> std::unique_ptr<Connection> {
            ++connected;
            return std::make_unique<One>(*this);
        };
    }
};

std::string failureOf(FetchQueue& queue, std::vector<FileRange> ranges) {
    try {
        (void)queue.fetch(ranges);
    } catch (const ReadError& error) {
        return error.what();
    }
    return "none";
}

TEST(FetchQueue, GivesEachRangeItsBytesOverSeveralConnections) {
    Server server;
    server.delay = 30ms;
    FetchQueue queue(server.connect(), 3, 1s);
    std::vector<FileRange> ranges;
    for (std::uint64_t i = 0; i < 12; ++i) ranges.push_back({10 * i, i + 1});
    const std::vector<Reply> replies = queue.fetch(ranges);
    ASSERT_EQ(replies.size(), ranges.size());
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        ASSERT_EQ(replies[i].bytes.size(), i + 1);
        EXPECT_EQ(std::size_t(replies[i].bytes.back()), 10 * i + i);
    }
    EXPECT_EQ(server.mostUnderway, 3);
    EXPECT_EQ(server.connected, 3) << "each is used again";
    (void)queue.fetch(ranges);
    EXPECT_EQ(server.connected, 3);
}

TEST(FetchQueue, OneRequestMakesOneConnection) {
    Server server;
    FetchQueue queue(server.connect(), 6, 1s);
    for (std::uint64_t i = 0; i < 5; ++i) {
        const FileRange range{i, 1};
        (void)queue.fetch({&range, 1});
    }
    EXPECT_EQ(server.connected, 1);
}

TEST(FetchQueue, WhatFailsForTheMomentIsTriedAgain) {
    Server server;
    server.failing = 2;
    FetchQueue queue(server.connect(), 1, 5s);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(failureOf(queue, {{5, 1}}), "none");
    EXPECT_GE(std::chrono::steady_clock::now() - begin, 300ms) << "0.1 s, then 0.2 s";
    EXPECT_EQ(server.asked, 3);
    EXPECT_EQ(server.connected, 3) << "with a connection of its own each time";
}

TEST(FetchQueue, WhatKeepsFailingIsAnErrorWithTheAddress) {
    Server server;
    server.failing = 1000;
    FetchQueue queue(server.connect(), 2, 500ms);
    EXPECT_EQ(failureOf(queue, {{5, 1}, {9, 1}}), "http://there/a.tsr: busy; tried 3 times");
    server.failing = 0;
    EXPECT_EQ(failureOf(queue, {{5, 1}}), "none") << "the next request is made anew";
}

TEST(FetchQueue, WhatIsRefusedIsNotTriedAgain) {
    Server server;
    server.refusing = 1;
    FetchQueue queue(server.connect(), 1, 5s);
    EXPECT_EQ(failureOf(queue, {{5, 1}, {9, 1}}), "http://there/a.tsr: no such file");
    EXPECT_EQ(server.asked, 2) << "the other range was read";
}

// A program that quits waits for nobody.
TEST(FetchQueue, EndsWhatIsUnderwayAndWaits) {
    struct Silent final : Connection {
        Reply read(FileRange, const std::stop_token& stop) override {
            while (!stop.stop_requested()) std::this_thread::sleep_for(1ms);
            throw Cancelled();
        }
    };
    std::stop_source ending;
    FetchQueue queue([] { return std::make_unique<Silent>(); }, 2, 60s, ending.get_token());
    std::atomic<int> cancelled = 0;
    {
        std::vector<std::jthread> callers;
        for (int i = 0; i < 4; ++i) // two are asked for, two wait
            callers.emplace_back([&] {
                const FileRange range{0, 1};
                try {
                    (void)queue.fetch({&range, 1});
                } catch (const Cancelled&) {
                    ++cancelled;
                }
            });
        std::this_thread::sleep_for(50ms);
        EXPECT_EQ(cancelled, 0);
        ending.request_stop();
    }
    EXPECT_EQ(cancelled, 4);
    const FileRange range{0, 1};
    EXPECT_THROW((void)queue.fetch({&range, 1}), Cancelled);
}

} // namespace
} // namespace tessera::codec
