#include "codec/blocks/share_results.h"

#include "tests/codec/child_process.h"
#include "tests/codec/make_dataset.h"
#include "volume/base/error.h"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tessera::codec {
namespace {

using namespace testing;
namespace fs = std::filesystem;

/// A process of a job; the exit status is 0 if it returns.
template <class Work> pid_t beginProcess(Work&& work) {
    return started([&] {
        work();
        return true;
    });
}

/// Squares, each of which leaves a line in a file named by its number, so that it is seen how often it was computed.
struct Squares {
    const TemporaryFolder& folder;
    std::size_t deadly = 99; ///< the process that computes this one dies
    SharedResults run(const std::optional<Launched>& launched, const std::string& about = "squares") const {
        return shareResults(
            {folder / "out", about, launched}, 9, [&](std::size_t i, const Progress&) { return square(i); },
            [&](const std::vector<std::string>& results, const Progress&) { write(results); });
    }
    std::string square(std::size_t i) const {
        if (i == deadly) ::raise(SIGKILL);
        std::ofstream(folder / ("computed-" + std::to_string(i)), std::ios::app) << "x";
        ::usleep(2000);
        return std::to_string(i * i);
    }
    void write(const std::vector<std::string>& results) const {
        std::ofstream out(folder / "out", std::ios::app);
        for (const std::string& each : results) out << each << " ";
    }
    std::string written() const {
        std::ifstream in(folder / "out");
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::string counts() const {
        std::string text;
        for (std::size_t i = 0; i < 9; ++i) {
            std::error_code missing;
            const auto size = fs::file_size(folder / ("computed-" + std::to_string(i)), missing);
            text += missing ? "0" : std::to_string(size);
        }
        return text;
    }
};

const std::string kSquares = "0 1 4 9 16 25 36 49 64 ";

TEST(ShareResults, AProcessAloneMakesNoFolder) {
    const TemporaryFolder folder;
    const Squares squares{folder};
    for (const std::optional<Launched>& launched : {std::optional<Launched>(), std::optional(Launched{})}) {
        const SharedResults summary = squares.run(launched);
        EXPECT_EQ(summary.own, 9u);
        EXPECT_TRUE(summary.last);
        EXPECT_EQ(squares.written(), kSquares);
        fs::remove(folder / "out");
    }
    EXPECT_EQ(folder.files(), 9u);
}

TEST(ShareResults, EveryPieceIsDoneOnceAndOneProcessFinishes) {
    const TemporaryFolder folder;
    const Squares squares{folder};
    std::vector<pid_t> children;
    for (int rank = 0; rank < 3; ++rank)
        children.push_back(beginProcess([&] { squares.run(Launched{rank, 3, 3, "job"}); }));
    for (const pid_t child : children) EXPECT_EQ(statusOf(child), 0);
    EXPECT_EQ(squares.written(), kSquares);
    EXPECT_EQ(squares.counts(), "111111111");
    EXPECT_FALSE(fs::exists(folder / "out.blocks"));
}

TEST(ShareResults, OneThatIsToldToDoesEverythingBesideOthers) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "out.blocks"); // of others
    const Squares squares{folder};
    EXPECT_EQ(squares.run(std::nullopt).own, 9u);
    EXPECT_TRUE(fs::is_empty(folder / "out.blocks"));
}

TEST(ShareResults, TheOthersDoWhatAKilledProcessLeaves) {
    const TemporaryFolder folder;
    const Squares squares{folder}, deadly{folder, 1};
    const pid_t first = beginProcess([&] { deadly.run(Launched{0, 2, 2, "job"}); });
    ASSERT_EQ(statusOf(first), -SIGKILL);
    EXPECT_EQ(squares.counts(), "100000000");
    const pid_t second = beginProcess([&] { squares.run(Launched{1, 2, 2, "job"}); });
    EXPECT_EQ(statusOf(second), 0);
    EXPECT_EQ(squares.written(), kSquares);
    EXPECT_EQ(squares.counts(), "111111111");
}

TEST(ShareResults, ASecondRunGoesOn) {
    const TemporaryFolder folder;
    const Squares squares{folder}, deadly{folder, 4};
    ASSERT_EQ(statusOf(beginProcess([&] { deadly.run(Launched{0, 2, 2, "job"}); })), -SIGKILL);
    EXPECT_EQ(squares.counts(), "111100000");
    EXPECT_THROW(squares.run(Launched{}, "other squares"), Error) << "the folder is of other work";
    EXPECT_EQ(squares.run(Launched{}).own, 5u) << "also alone";
    EXPECT_EQ(squares.counts(), "111111111");
    EXPECT_EQ(squares.written(), kSquares);
    EXPECT_FALSE(fs::exists(folder / "out.blocks"));
}

TEST(ShareResults, APieceWhoseFileIsGoneIsDoneAgain) {
    const TemporaryFolder folder;
    const Squares squares{folder}, deadly{folder, 4};
    ASSERT_EQ(statusOf(beginProcess([&] { deadly.run(Launched{0, 2, 2, "job"}); })), -SIGKILL);
    fs::remove(folder / "computed-2");
    SharedWork work{folder / "out", "squares", Launched{}};
    work.isMade = [&](std::size_t i, const std::string& result) {
        EXPECT_EQ(result, std::to_string(i * i));
        return fs::exists(folder / ("computed-" + std::to_string(i)));
    };
    const SharedResults shared = shareResults(
        work, 9, [&](std::size_t i, const Progress&) { return squares.square(i); },
        [&](const std::vector<std::string>& results, const Progress&) { squares.write(results); });
    EXPECT_EQ(shared.own, 6u);
    EXPECT_EQ(shared.results[8], "64");
    EXPECT_EQ(squares.counts(), "111111111");
}

TEST(ShareResults, EveryProcessKnowsAllResults) {
    const TemporaryFolder folder;
    const Squares squares{folder};
    std::vector<pid_t> children;
    for (int rank = 0; rank < 3; ++rank)
        children.push_back(beginProcess([&] {
            const SharedResults shared = squares.run(Launched{rank, 3, 3, "job"});
            if (shared.results.size() != 9 || shared.results[7] != "49") throw Error("not all of them");
        }));
    for (const pid_t child : children) EXPECT_EQ(statusOf(child), 0);
}

TEST(ShareResults, WorkOfWhichNothingIsDoneLeavesNoFolder) {
    const TemporaryFolder folder;
    const auto fails = [](std::size_t, const Progress&) -> std::string { throw Error("no such parameter"); };
    const auto nothing = [](const std::vector<std::string>&, const Progress&) {};
    for (const int rank : {0, 1}) {
        EXPECT_THROW(shareResults({folder / "out", "wrong", Launched{rank, 2, 2, "job"}}, 9, fails, nothing), Error);
        EXPECT_EQ(fs::exists(folder / "out.blocks"), rank == 0) << "until the last has come and gone";
    }
    EXPECT_EQ(Squares{folder}.run(Launched{}).own, 9u) << "other work can begin";
}

TEST(ShareResults, WhatFailsAtTheEndIsOnlyEndedAgain) {
    const TemporaryFolder folder;
    const Squares squares{folder};
    const auto fails = [](const std::vector<std::string>&, const Progress&) { throw MachineError("the disk is full"); };
    const auto square = [&](std::size_t i, const Progress&) { return squares.square(i); };
    fs::create_directory(folder / "out.blocks");
    EXPECT_THROW(shareResults({folder / "out", "squares", Launched{}}, 9, square, fails), MachineError);
    EXPECT_EQ(squares.run(Launched{}).own, 0u);
    EXPECT_EQ(squares.written(), kSquares);
    EXPECT_EQ(squares.counts(), "111111111");
}

} // namespace
} // namespace tessera::codec
